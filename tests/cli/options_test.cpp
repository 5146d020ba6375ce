// SPDX-License-Identifier: Apache-2.0
#include "cli/options.h"

#include <sstream>

#include <gtest/gtest.h>

#include "base/version.h"

namespace pelage {
namespace {

Options parsed(const std::vector<std::string>& arguments) {
  std::ostringstream out;
  const auto options = parse_options(arguments, out);
  EXPECT_TRUE(options) << out.str();
  return options.value_or(Options{});
}

std::string printed(const std::vector<std::string>& arguments) {
  std::ostringstream out;
  EXPECT_FALSE(parse_options(arguments, out));
  return out.str();
}

std::string problem(const std::vector<std::string>& arguments) {
  std::ostringstream out;
  try {
    parse_options(arguments, out);
    return "";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kArguments);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
}

TEST(Options, OfRender) {
  const Options options = parsed({"render", "rat.yaml", "-o", "rat.%04d.exr", "--frames", "1-48x2", "--set",
                                  "render.samples=8", "--set", "a=b=c", "--stats", "s.json", "--threads", "3",
                                  "--memory", "4G", "--progress", "plain"});
  EXPECT_EQ(options.command, Command::kRender);
  EXPECT_EQ(options.input, "rat.yaml");
  EXPECT_EQ(options.output, "rat.%04d.exr");
  EXPECT_EQ(options.stats, "s.json");
  EXPECT_EQ(options.threads, 3);
  EXPECT_EQ(options.progress, ProgressStyle::kPlain);
  ASSERT_EQ(options.overrides.size(), 4u);
  EXPECT_EQ(options.overrides[0].key, "render.samples");
  EXPECT_EQ(options.overrides[1].value, "b=c");
  EXPECT_EQ(options.overrides[2].key, "render.memory");
  EXPECT_EQ(options.overrides[3].key, "frames");
  EXPECT_EQ(options.overrides[3].value, "'1-48x2'");
}

TEST(Options, OfThePicture) {
  const Options options = parsed({"render", "rat.yaml", "--samples", "12", "--time-limit", "2.5", "--scale",
                                  "0.5", "--region", "1,2,30,40", "--preview", "--skip-existing"});
  ASSERT_EQ(options.overrides.size(), 2u);
  EXPECT_EQ(options.overrides[0].key, "render.samples");
  EXPECT_EQ(options.overrides[0].value, "12");
  EXPECT_EQ(options.overrides[1].key, "render.time_limit");
  EXPECT_EQ(options.overrides[1].value, "2.5");
  EXPECT_EQ(options.picture.scale, 0.5);
  EXPECT_EQ(options.picture.region, (PixelBox{1, 2, 30, 40}));
  EXPECT_TRUE(options.picture.preview);
  EXPECT_TRUE(options.picture.skip_existing);
  EXPECT_FALSE(parsed({"render", "rat.yaml"}).picture.region);

  EXPECT_NE(problem({"render", "s", "--samples", "0"}).find("--samples"), std::string::npos);
  EXPECT_NE(problem({"render", "s", "--scale", "-1"}).find("--scale"), std::string::npos);
  EXPECT_NE(problem({"render", "s", "--region", "1,2,3"}).find("--region"), std::string::npos);
}

TEST(Options, SetTakesOneValueOnly) {
  const Options options = parsed({"render", "--set", "a=1", "rat.yaml", "--set", "b=2"});
  EXPECT_EQ(options.input, "rat.yaml");
  EXPECT_EQ(options.overrides.size(), 2u);
}

TEST(Options, NegativeFrames) {
  EXPECT_EQ(parsed({"render", "s", "--frames=-5--1"}).overrides[0].value, "'-5--1'");
  EXPECT_EQ(parsed({"render", "s", "--frames", "-5--1"}).overrides[0].value, "'-5--1'");
  EXPECT_EQ(parsed({"render", "--frames", "-5", "s"}).overrides[0].value, "'-5'");
}

TEST(Options, HaveDefaults) {
  const Options options = parsed({"render", "s"});
  EXPECT_EQ(options.output, "");
  EXPECT_FALSE(options.stats);
  EXPECT_EQ(options.threads, 0);
  EXPECT_EQ(options.progress, ProgressStyle::kAuto);
  EXPECT_EQ(parsed({"render", "s", "--quiet"}).progress, ProgressStyle::kQuiet);
}

TEST(Options, OfTheOtherCommands) {
  EXPECT_EQ(parsed({"grow", "s", "-o", "a.hair", "--groom", "under"}).groom, "under");
  EXPECT_FALSE(parsed({"grow", "s", "-o", "a.hair"}).lod);
  EXPECT_TRUE(parsed({"grow", "s", "-o", "a.hair", "--lod"}).lod);
  EXPECT_EQ(parsed({"info", "a.tfx", "--basis", "linear"}).basis, CurveBasis::kLinear);
  EXPECT_EQ(parsed({"convert", "a.hair", "b.tfx", "--default-width", "0.01"}).default_width, 0.01f);
  EXPECT_EQ(parsed({"convert", "a.hair", "b.tfx"}).output, "b.tfx");
  EXPECT_EQ(parsed({"convert", "a.hair", "b.abc"}).host, AlembicHost::kAny);
  EXPECT_EQ(parsed({"convert", "a.hair", "b.abc", "--for", "unreal"}).host, AlembicHost::kUnreal);
  EXPECT_EQ(parsed({"manual", "curl"}).section, "curl");
  EXPECT_EQ(parsed({"manual", "map", "field"}).section, "map field");
  EXPECT_TRUE(parsed({"manual", "--markdown"}).markdown);
}

TEST(Options, OfWhy) {
  const Options options = parsed({"why", "s.yaml", "12", "34", "--json", "-o", "a.png", "--set", "a=1"});
  EXPECT_EQ(options.command, Command::kWhy);
  EXPECT_EQ(options.pixel_x, 12);
  EXPECT_EQ(options.pixel_y, 34);
  EXPECT_TRUE(options.json);
  EXPECT_EQ(options.output, "a.png");
  EXPECT_FALSE(parsed({"why", "s.yaml", "1", "2"}).json);
  EXPECT_EQ(problem({"why", "s.yaml", "1"}), "Y is required; see 'pelage why --help'");
  EXPECT_EQ(parsed({"why", "s.yaml", "-1", "2"}).pixel_x, -1) << "run_why() names the size of the picture";
  for (const std::string pixel : {"1.5", "x", "1e1", "0x1", "99999999999"}) {
    EXPECT_EQ(problem({"why", "s.yaml", "1", pixel}),
              "Y: expected a whole number, got '" + pixel + "'; see 'pelage why --help'");
  }
}

TEST(Options, OfCheckpoints) {
  const CheckpointOptions none = parsed({"render", "s"}).checkpoint;
  EXPECT_FALSE(none.folder || none.resume);
  const CheckpointOptions some = parsed({"render", "s", "--checkpoint", "ck", "--resume"}).checkpoint;
  EXPECT_EQ(some.folder, "ck");
  EXPECT_TRUE(some.resume);
  EXPECT_EQ(some.every_s, 60);
  for (const auto& [text, seconds] : {std::pair{"90", 90.0}, {"0.5s", 0.5}, {"5m", 300.0}, {"2h", 7200.0}})
    EXPECT_EQ(parsed({"render", "s", "--checkpoint", "ck", "--every", text}).checkpoint.every_s, seconds);
  for (const char* text : {"0s", "-1", "5 m", "5d", "m", "1e9", "nan", "1m30s"}) {
    EXPECT_EQ(
        problem({"render", "s", "--checkpoint", "ck", std::string("--every=") + text}),
        "--every: expected a time from 0.1s to 168h such as 60s, 5m or 2h, got '" + std::string(text) + "'");
  }
  EXPECT_EQ(problem({"render", "s", "--checkpoint", ""}), "--checkpoint: the name of the folder is empty");
  EXPECT_EQ(problem({"render", "s", "--resume"}),
            "--resume requires --checkpoint; see 'pelage render --help'");
  EXPECT_EQ(problem({"render", "s", "--every", "5s"}),
            "--every requires --checkpoint; see 'pelage render --help'");
}

TEST(Options, MistakesNameWhatWasMeant) {
  EXPECT_NE(problem({"grow", "s", "--lod"}).find("--output"), std::string::npos);
  EXPECT_EQ(problem({}), "expected a command; see 'pelage --help'");
  EXPECT_EQ(problem({"rendr", "s"}), "unknown command 'rendr'; did you mean 'render'?");
  EXPECT_EQ(
      problem({"zebra"}),
      "unknown command 'zebra'; expected one of compare, convert, export, farm, grow, info, manual, "
      "measure, merge, motionblur, new, procedural, render, rib, simulate, stereo, validate, view, why");
  EXPECT_EQ(problem({"render", "s", "--fraems", "1"}), "unknown option '--fraems'; did you mean '--frames'?");
  EXPECT_EQ(problem({"render", "s", "--memroy=4G"}), "unknown option '--memroy'; did you mean '--memory'?");
  EXPECT_EQ(problem({"render", "s", "--zebra"}), "unknown option '--zebra'; see 'pelage render --help'");
  EXPECT_EQ(problem({"render", "s", "t"}), "unexpected argument 't'");
  EXPECT_EQ(problem({"--zebra"}), "unknown option '--zebra'; see 'pelage --help'");
  EXPECT_EQ(problem({"render"}), "SCENE is required; see 'pelage render --help'");
  EXPECT_EQ(problem({"export", "s", "-o", "d", "--format", "pbr"}),
            "--format 'pbr' is not known; did you mean 'pbrt'?");
  EXPECT_EQ(parsed({"export", "s", "-o", "d", "--format", "mitsuba"}).export_format, ExportFormat::kMitsuba);
  EXPECT_EQ(problem({"convert", "a"}), "OUT is required; see 'pelage convert --help'");
  EXPECT_EQ(problem({"render", "s", "--set", "a"}), "--set a: expected a key and a value, a.b.c=value");
  EXPECT_EQ(problem({"render", "s", "--memory", "lots"}),
            "--memory: expected bytes such as 512M or 4G, got 'lots'");
  EXPECT_EQ(problem({"render", "s", "--progress", "bra"}),
            "--progress 'bra' is not known; did you mean 'bar'?");
  EXPECT_EQ(problem({"info", "s", "--basis", "bezier"}),
            "--basis 'bezier' is not known; expected one of linear, pinned-b-spline, b-spline, catmull-rom");
  EXPECT_NE(problem({"render", "s", "--threads", "many"}), "");
  EXPECT_NE(problem({"render", "s", "--threads", "-1"}), "");
  EXPECT_NE(problem({"render", "s", "--frames"}), "");
  EXPECT_NE(problem({"render", "s", "--quiet", "--progress", "bar"}), "");
  EXPECT_NE(problem({"convert", "a", "b", "--default-width", "0"}), "");
}

TEST(Options, NumbersAreFiniteAndInTheirRange) {
  for (const char* number : {"0", "-1", "nan", "inf", "1e999", "1e39", "1e-60", "abc", "2x", "0x10"}) {
    const std::string wanted = "--scale: expected a number greater than 0, got '" + std::string(number) + "'";
    EXPECT_EQ(problem({"render", "a.yaml", "--scale=" + std::string(number)}).substr(0, wanted.size()),
              wanted);
  }
  EXPECT_EQ(parsed({"render", "a.yaml", "--scale", "2.5e-1"}).picture.scale, 0.25);
  for (const char* flag : {"--time-limit", "--scale"})
    EXPECT_NE(problem({"render", "a.yaml", flag, "0"}).find("greater than 0, got '0'"), std::string::npos);
  EXPECT_NE(problem({"convert", "a", "b", "--default-width", "nan"}).find("greater than 0"),
            std::string::npos);
  EXPECT_NE(problem({"stereo", "a", "b", "--focal-pixels", "nan"}).find("greater than 0"), std::string::npos);
  EXPECT_NE(
      problem({"stereo", "a", "b", "--fov", "nan"}).find("expected a number from 0.01 to 170, got 'nan'"),
      std::string::npos);
  EXPECT_NE(problem({"render", "a", "--sample-memory", "nan"}).find("expected a number from 0.001 to 3600"),
            std::string::npos);
}

TEST(Options, HelpEverywhere) {
  for (const char* flag : {"--help", "-h"}) {
    EXPECT_NE(printed({flag}).find("render"), std::string::npos);
    for (const char* command : {"render", "grow", "info", "convert", "manual"}) {
      const std::string help = printed({command, flag});
      EXPECT_NE(help.find(std::string("pelage ") + command), std::string::npos) << help;
    }
  }
  EXPECT_NE(printed({"render", "--help"}).find("--frames"), std::string::npos);
  for (const char* command : {"  measure ", "  compare "})
    EXPECT_NE(printed({"--help"}).find(command), std::string::npos) << command;
  EXPECT_EQ(printed({"--version"}), std::string("pelage ") + version() + "\n");
}

}  // namespace
}  // namespace pelage
