// SPDX-License-Identifier: Apache-2.0
#include "lab/runs/variant.h"

#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "base/file.h"
#include "base/temporary_folder.h"
#include "lab/pictures/picture_difference.h"
#include "lab/report/machine.h"
#include "lab/runs/spread.h"

namespace pelage {
namespace {

class MeasureRuns : public testing::Test {
 protected:
  // A program that behaves as its first argument after "SCENE" says; the scene is a shell script.
  Outcome outcome(const std::string& script, int repeat = 1) {
    std::ofstream(folder_.path() / "program") << "#!/bin/sh\nwhile [ \"$1\" != --stats ]; do shift; done\n"
                                              << "stats=$2\n"
                                              << script << "\n";
    std::filesystem::permissions(folder_.path() / "program", std::filesystem::perms::owner_all);
    MeasureSetup setup;
    setup.program = folder_.path() / "program";
    setup.folder = folder_.path();
    setup.scene = "scene.yaml";
    setup.repeat = repeat;
    NoProgress progress;
    Variant variant;
    variant.id = variant.title = "one";
    return VariantRunner(setup, progress, 1).run(variant);
  }

  TemporaryFolder folder_;
};

TEST_F(MeasureRuns, ARunThatTakesTooLongHasTimedOut) {
  ProcessEnd end;
  end.timed_out = true;
  Outcome outcome{{}, {{{}, end, "", 0, {}}}};
  EXPECT_EQ(outcome.status(), "time-out");
  EXPECT_FALSE(outcome.refused());
}

TEST_F(MeasureRuns, RoundsGoOverAllVariantsBeforeTheSecondRun) {
  const std::filesystem::path order = folder_.path() / "order";
  std::ofstream(folder_.path() / "program")
      << "#!/bin/sh\nname=$(basename $4)\nprintf \"$name \" >> " << order.string()
      << "\n[ $name != b.json ] || exit 1\necho '{\"wall_s\": 1}' > $4\n";
  std::filesystem::permissions(folder_.path() / "program", std::filesystem::perms::owner_all);
  MeasureSetup setup;
  setup.program = folder_.path() / "program";
  setup.folder = folder_.path();
  setup.scene = "scene.yaml";
  setup.repeat = 2;
  NoProgress progress;
  std::vector<Variant> variants(3);
  for (size_t i = 0; i < 3; ++i) {
    variants[i].id = variants[i].title = std::string(1, static_cast<char>('a' + i));
    variants[i].command = "grow";
  }
  const std::vector<Outcome> outcomes = VariantRunner(setup, progress, 3).run_in_rounds(variants);
  EXPECT_EQ(read_file(order), "a.json b.json c.json a.2.json c.2.json ");  // what failed is not run again
  ASSERT_EQ(outcomes.size(), 3u);
  EXPECT_EQ(outcomes[0].runs.size(), 2u);
  EXPECT_EQ(outcomes[1].status(), "exit code 1");
}

TEST_F(MeasureRuns, VariantsReportFailuresAndGoOn) {
  const Outcome failed = outcome("echo 'pelage: error: no' >&2; exit 1");
  EXPECT_EQ(failed.status(), "exit code 1");
  EXPECT_EQ(failed.error(), "pelage: error: no");
  EXPECT_EQ(failed.typical(), nullptr);
  EXPECT_TRUE(std::isnan(failed.number("wall_s")));
  EXPECT_TRUE(outcome("exit 4").refused());
  EXPECT_EQ(outcome("kill -9 $$").status(), "signal 9");
  // Statistics of an earlier run are not taken for those of this one.
  outcome("echo '{\"wall_s\": 1}' > $stats");
  EXPECT_EQ(outcome("true").typical(), nullptr);
  EXPECT_EQ(outcome("echo '{\"wall_s\": ' > $stats").typical(), nullptr);
}

TEST_F(MeasureRuns, TheMedianRunCounts) {
  // Wall times 3, 1, 2 in turn.
  const Outcome three = outcome(
      "case $stats in *.2.json) t=1;; *.3.json) t=2;; *) t=3;; esac\n"
      "echo '{\"wall_s\": '$t', \"rays\": {\"camera\": 4, \"shadow\": 6}, \"timeline_columns\": "
      "[\"seconds\"], \"timeline\": [[0], [1]]}' > $stats",
      3);
  ASSERT_EQ(three.runs.size(), 3u);
  EXPECT_EQ(three.number("wall_s"), 2);
  EXPECT_EQ(three.min("wall_s"), 1);
  EXPECT_EQ(three.max("wall_s"), 3);
  EXPECT_EQ(three.typical()->statistics->sum("rays"), 10);
  EXPECT_EQ(three.typical()->statistics->timeline().size(), 2u);
  EXPECT_EQ(three.typical()->statistics->json().find("timeline"), std::string::npos);
  EXPECT_NE(runs_json({three}).find("\"camera\":4"), std::string::npos);
}

TEST_F(MeasureRuns, RatiosHaveASpread) {
  const auto runs = [&](const char* first, const char* second, const char* third) {
    return outcome(std::string("case $stats in *.2.json) t=") + second + ";; *.3.json) t=" + third +
                       ";; *) t=" + first + ";; esac\necho '{\"wall_s\": '$t', \"cpu_s\": '$t'}' > $stats",
                   3);
  };
  const Outcome slow = runs("6", "9", "8"), fast = runs("2", "1", "4");
  const RatioSpread ratio = ratio_of(slow, fast, "cpu_s");
  EXPECT_EQ(ratio.typical, 4);
  EXPECT_EQ(ratio.min, 1.5);
  EXPECT_EQ(ratio.max, 9);
  EXPECT_EQ(spread_text(ratio), "4.00 (1.50 to 9.00)");
  EXPECT_EQ(spread_text({2, 2, 2}), "2.00");
}

TEST(PictureDifference, CountsPixelsOfWhichAnyBitDiffers) {
  ExrImage a;
  a.width = 2;
  a.height = 1;
  a.channels = {{"R", ChannelType::kHalf, {0.5f, NAN}, {}}, {"id", ChannelType::kUint, {}, {7, 8}}};
  ExrImage b = a;
  EXPECT_EQ(compare_pictures(a, b)->differing, 0);
  b.channels[0].pixels[0] = 0.75f;
  EXPECT_EQ(compare_pictures(a, b)->differing, 1);
  EXPECT_EQ(compare_pictures(a, b)->largest, 0.25);
  b.channels[1].ids[1] = 9;
  EXPECT_EQ(compare_pictures(a, b)->differing, 2);
  b.width = 1;
  EXPECT_FALSE(compare_pictures(a, b));
}

TEST(Machine, NamesTheProcessor) {
  EXPECT_EQ(processor_name("vendor_id\t: X\nmodel name\t: Chip 3000 @ 2 GHz\nmodel name\t: other\n"),
            "Chip 3000 @ 2 GHz");
  EXPECT_EQ(processor_name("model name\n"), "unknown");
  EXPECT_EQ(processor_name(""), "unknown");
}

}  // namespace
}  // namespace pelage
