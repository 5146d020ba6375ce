// SPDX-License-Identifier: Apache-2.0
#include "lab/lab_options.h"

#include <sstream>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/version.h"

namespace pelage {
namespace {

LabOptions parsed(const std::vector<std::string>& arguments) {
  std::ostringstream out;
  const auto options = parse_lab_options(arguments, out);
  EXPECT_TRUE(options) << out.str();
  return options.value_or(LabOptions{});
}

std::string printed(const std::vector<std::string>& arguments) {
  std::ostringstream out;
  EXPECT_FALSE(parse_lab_options(arguments, out));
  return out.str();
}

std::string problem(const std::vector<std::string>& arguments) {
  std::ostringstream out;
  try {
    parse_lab_options(arguments, out);
    return "";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kArguments);
    return error.what();
  }
}

TEST(LabOptionsTest, OfMeasure) {
  const LabOptions options =
      parsed({"measure", "residency", "s.yaml", "-o", "out", "--repeat", "5", "--set", "a=1"});
  EXPECT_EQ(options.task, LabTask::kMeasure);
  EXPECT_EQ(options.experiment, Experiment::kResidency);
  EXPECT_EQ(options.input, "s.yaml");
  EXPECT_EQ(options.output, "out");
  EXPECT_EQ(options.repeat, 5);
  EXPECT_EQ(parsed({"measure", "growth", "s"}).experiment, Experiment::kGrowth);
  EXPECT_FALSE(options.allow_scripts);
  EXPECT_TRUE(parsed({"measure", "shading", "s", "--allow-scripts"}).allow_scripts);
  EXPECT_TRUE(parsed({"compare", "s", "--allow-scripts"}).allow_scripts);
  for (const char* name : {"bounces", "bounds", "growth", "lod", "residency", "samplers", "shading"})
    EXPECT_STREQ(experiment_name(parsed({"measure", name, "s"}).experiment), name);
  EXPECT_EQ(problem({"measure", "growht", "s"}), "unknown experiment 'growht'; did you mean 'growth'?");
  EXPECT_NE(problem({"measure", "zebra", "s"}).find("expected one of bounces, bounds"), std::string::npos);
  EXPECT_NE(problem({"measure", "bounds", "s", "--time-limit", "nan"}).find("greater than 0"),
            std::string::npos);
  const LabOptions lod = parsed({"measure", "lod", "s", "--parts", "crowd,dolly"});
  EXPECT_EQ(lod.parts, (std::vector<std::string>{"crowd", "dolly"}));
  EXPECT_EQ(problem({"measure", "lod", "s", "--parts", "crowds"}),
            "--parts: unknown part 'crowds'; did you mean 'crowd'?");
  const LabOptions shading = parsed({"measure", "shading", "s", "--samples", "64,2,64", "--reference-samples",
                                     "8", "--parts", "gather,reuse"});
  EXPECT_EQ(shading.experiment, Experiment::kShading);
  EXPECT_EQ(shading.samples, (std::vector<int>{2, 64})) << "ascending, each once";
  EXPECT_EQ(shading.reference_samples, 8);
  EXPECT_EQ(shading.parts, (std::vector<std::string>{"gather", "reuse"}));
  EXPECT_EQ(parsed({"measure", "shading", "s"}).samples, (std::vector<int>{4, 16, 64}));
  EXPECT_NE(problem({"measure", "shading", "s", "--samples", "0"}), "");
  EXPECT_EQ(shading.flicker_samples, (std::vector<int>{2})) << "the smallest";
  EXPECT_EQ(parsed({"measure", "shading", "s", "--flicker-samples", "16,4"}).flicker_samples,
            (std::vector<int>{4, 16}));
  EXPECT_TRUE(parsed({"measure", "shading", "s", "--flicker-samples", "0"}).flicker_samples.empty());
  EXPECT_EQ(problem({"measure", "shading", "s", "--flicker-samples", "8"}),
            "--flicker-samples: 8 is not one of --samples 4,16,64");
  EXPECT_EQ(parsed({"measure", "bounces", "s", "--samples", "8"}).experiment, Experiment::kBounces);
  EXPECT_NE(problem({"measure", "shading", "s", "--reference-samples", "0"}), "");
  EXPECT_EQ(problem({"measure", "shading", "s", "--parts", "gatehr"}),
            "--parts: unknown part 'gatehr'; did you mean 'gather'?");
  EXPECT_EQ(problem({"measure", "bounces", "s", "--parts", "gather"}),
            "--parts: only lod and shading have parts");
  EXPECT_NE(problem({"measure", "bounds"}), "");
  EXPECT_NE(problem({"measure", "bounds", "s", "--repeat", "0"}), "");
}

TEST(LabOptionsTest, OfCompare) {
  const LabOptions options =
      parsed({"compare", "a.yaml", "-o", "out", "--models", "chiang,yan", "--set", "render.samples=2"});
  EXPECT_EQ(options.task, LabTask::kCompare);
  EXPECT_EQ(options.output, "out");
  EXPECT_EQ(options.models, (std::vector<std::string>{"chiang", "yan"}));
  EXPECT_TRUE(parsed({"compare", "a.yaml"}).models.empty());
  EXPECT_THROW(parsed({"compare", "a.yaml", "--models", "chang"}), Error);
}

TEST(LabOptionsTest, HelpAndMistakesNameTheProgram) {
  EXPECT_NE(printed({"--help"}).find("measure"), std::string::npos);
  EXPECT_NE(printed({"measure", "--help"}).find("pelage-lab measure"), std::string::npos);
  EXPECT_NE(printed({"measure", "--help"}).find("--repeat"), std::string::npos);
  EXPECT_NE(printed({"compare", "-h"}).find("--models"), std::string::npos);
  EXPECT_EQ(printed({"--version"}), "pelage-lab " + std::string(version()) + "\n");
  EXPECT_EQ(problem({}), "expected a command; see 'pelage-lab --help'");
  EXPECT_EQ(problem({"render"}), "unknown command 'render'; expected one of compare, measure");
  EXPECT_EQ(problem({"compare"}), "SCENE is required; see 'pelage-lab compare --help'");
  EXPECT_NE(problem({"measure", "bounds", "s", "--zebra"}).find("'pelage-lab measure --help'"),
            std::string::npos);
}

}  // namespace
}  // namespace pelage
