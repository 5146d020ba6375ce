// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "lab/lab_options.h"
#include "tests/world/small_scene.h"

namespace pelage {
namespace {

std::string read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

LabOptions compare_options(const SmallScene& scene) {
  LabOptions options;
  options.input = scene.path("scene.yaml");
  options.output = scene.path("out");
  options.progress = ProgressStyle::kQuiet;
  options.threads = 2;
  return options;
}

TEST(CompareCommand, WritesASheetATableAndAReport) {
  const SmallScene scene;
  LabOptions options = compare_options(scene);
  options.models = {"chiang", "cone-shell"};
  ASSERT_EQ(run_compare(options), 0);
  for (const char* file : {"contact_sheet.png", "single_fibres.png"})
    EXPECT_EQ(read(scene.path("out") + "/" + file).substr(1, 3), "PNG") << file;
  EXPECT_NE(read(scene.path("out") + "/report.html").find("contact_sheet.png"), std::string::npos);
  const auto json = nlohmann::json::parse(read(scene.path("out") + "/report.json"));
  ASSERT_EQ(json.at("rows").size(), 6u);
  const std::string csv = read(scene.path("out") + "/report.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 7);
  for (const auto& row : json.at("rows")) {
    EXPECT_GT(row.at("luminance").get<double>(), 0);
    EXPECT_GT(row.at("rays").get<double>(), 24 * 16 * 4);
    EXPECT_GE(row.at("relmse").get<double>(), 0);
  }
  EXPECT_EQ(json.at("runs").size(), 2u);
}

TEST(CompareCommand, SaysWhatItNeeds) {
  const SmallScene scene;
  LabOptions options = compare_options(scene);
  options.overrides = {{"characters.walker.parts.0.grooms", "{}"}};
  EXPECT_THROW(run_compare(options), Error);
  options = compare_options(scene);
  options.output = "/proc/none";
  EXPECT_THROW(run_compare(options), Error);
}

}  // namespace
}  // namespace pelage
