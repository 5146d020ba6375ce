// SPDX-License-Identifier: Apache-2.0
#include "farm/farm_plan.h"

#include <algorithm>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "base/program.h"
#include "world/frames.h"

namespace pelage {
namespace {

FarmRequest request() {
  FarmRequest request;
  request.scene = "rat.yaml";
  request.arguments = {"--set", "render.samples=4"};
  request.frames = {1, 2, 4};
  request.output = "shot.%04d.exr";
  request.folder = "farm";
  request.width = 100;
  request.height = 50;
  return request;
}

TEST(FarmPlan, AFrameIsATaskByItself) {
  const std::vector<FarmTask> tasks = make_farm_plan(request());
  ASSERT_EQ(tasks.size(), 3u);
  EXPECT_EQ(tasks[2].name, "render-0004");
  EXPECT_EQ(tasks[2].frame, 4);
  EXPECT_EQ(tasks[2].output, "shot.0004.exr");
  EXPECT_TRUE(tasks[2].after.empty());
  EXPECT_EQ(shell_line(tasks[2].command),
            "pelage render rat.yaml --set render.samples=4 --frames 4 -o shot.0004.exr --checkpoint "
            "farm/checkpoints --every 60s --resume --stats farm/stats/0004.json");
}

TEST(FarmPlan, MotionComesBeforeCachesAndPictures) {
  FarmRequest moving = request();
  moving.simulates = "1-4x3";
  std::vector<FarmTask> tasks = make_farm_plan(moving);
  EXPECT_EQ(tasks[0].kind(), "simulate");
  EXPECT_EQ(shell_line(tasks[0].command), "pelage simulate rat.yaml --set render.samples=4 --frames 1-4x3");
  EXPECT_EQ(tasks[1].after, std::vector<std::string>{"simulate"});
  moving.grows = true;
  tasks = make_farm_plan(moving);
  EXPECT_EQ(tasks[1].after, std::vector<std::string>{"simulate"});
  EXPECT_EQ(tasks[2].after, std::vector<std::string>{"grow"});
}

TEST(FarmPlan, RegionsAreMergedAndCachesComeFirst) {
  FarmRequest regions = request();
  regions.columns = regions.rows = 2;
  regions.grows = true;
  regions.saves = false;
  regions.flags = {"--threads", "3"};
  regions.memory = 1000;
  const std::vector<FarmTask> tasks = make_farm_plan(regions);
  ASSERT_EQ(tasks.size(), 3u * 6);
  EXPECT_EQ(shell_line(tasks[0].command),
            "pelage grow rat.yaml --set render.samples=4 --frames 1 --threads 3");
  EXPECT_EQ(tasks[1].name, "render-0001-r0c0");
  EXPECT_EQ(tasks[1].after, std::vector<std::string>{"grow"});
  EXPECT_EQ(shell_line(tasks[4].command),
            "pelage render rat.yaml --set render.samples=4 --frames 1 -o farm/pieces/0001-r1c1.exr --region "
            "48,32,100,50 --skip-existing --stats farm/stats/0001-r1c1.json --threads 3");
  EXPECT_EQ(tasks[5].name, "merge-0001");
  EXPECT_EQ(tasks[5].after.size(), 4u);
  EXPECT_EQ(shell_line(tasks[5].command),
            "pelage merge farm/pieces/0001-r0c0.exr farm/pieces/0001-r0c1.exr farm/pieces/0001-r1c0.exr "
            "farm/pieces/0001-r1c1.exr -o shot.0001.exr --threads 3");
  EXPECT_EQ(tasks[6].name, "grow-0002");
  EXPECT_EQ(shell_line(tasks[6].command),
            "pelage grow rat.yaml --set render.samples=4 --frames 2 --threads 3");
  EXPECT_EQ(tasks[6].after, std::vector<std::string>{"grow"});
  EXPECT_EQ(tasks[7].after, std::vector<std::string>{"grow-0002"});
  EXPECT_EQ(tasks[0].memory, 1000u);
  EXPECT_EQ(tasks[1].memory, 1000u);
  EXPECT_EQ(tasks[5].memory, 0u);
  std::set<std::string> before;
  for (const FarmTask& task : tasks) {
    for (const std::string& name : task.after) EXPECT_TRUE(before.contains(name)) << task.name;
    EXPECT_TRUE(before.insert(task.name).second);
  }
}

TEST(FarmPlan, FramesThatAreNotDividedMeasureTheirOwnBoxes) {
  FarmRequest whole = request();
  whole.grows = true;
  const std::vector<FarmTask> tasks = make_farm_plan(whole);
  ASSERT_EQ(tasks.size(), 4u);
  for (size_t i = 1; i < 4; ++i) EXPECT_EQ(tasks[i].after, std::vector<std::string>{"grow"});
}

TEST(FarmPlan, ATaskWritesTheFileThatThePlanNames) {
  FarmRequest percent = request();
  percent.frames = {-3};
  percent.output = "100%%d_##.exr";
  for (const int columns : {1, 2}) {
    percent.columns = columns;
    for (const FarmTask& task : make_farm_plan(percent)) {
      const auto flag = std::find(task.command.begin(), task.command.end(), "-o");
      ASSERT_NE(flag, task.command.end());
      const bool renders = task.command[1] == "render";  // merge has no placeholders
      EXPECT_EQ(renders ? frame_file_name(flag[1], -3) : flag[1], task.output);
    }
    EXPECT_EQ(make_farm_plan(percent).back().output, "100%d_-03.exr");
  }
}

TEST(FarmPlan, BoxesCoverEachPixelOnce) {
  for (const auto& [width, height, columns, rows] :
       {std::tuple{100, 50, 4, 4}, {1920, 1080, 7, 5}, {5, 3, 4, 4}, {64, 64, 1, 1}, {33, 200, 3, 9}}) {
    std::vector<int> covered(static_cast<size_t>(width * height));
    for (const PixelBox& box : divide_picture(width, height, columns, rows)) {
      EXPECT_TRUE(box.x0 % 16 == 0 && box.y0 % 16 == 0);
      for (int y = box.y0; y < box.y1; ++y) {
        for (int x = box.x0; x < box.x1; ++x) ++covered[static_cast<size_t>(y * width + x)];
      }
    }
    EXPECT_EQ(covered, std::vector<int>(covered.size(), 1)) << width << " " << columns;
  }
  EXPECT_EQ(divide_picture(1920, 1080, 4, 4).size(), 16u);
}

}  // namespace
}  // namespace pelage
