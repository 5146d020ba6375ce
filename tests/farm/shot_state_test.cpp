// SPDX-License-Identifier: Apache-2.0
#include "farm/shot_state.h"

#include <fstream>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/file.h"
#include "base/temporary_folder.h"

namespace pelage {
namespace {

FarmPlan plan(const std::filesystem::path& folder) {
  FarmRequest request;
  request.scene = "rat.yaml";
  request.frames = {1, 2};
  request.output = "shot.%04d.exr";
  request.folder = "farm";
  request.width = request.height = 64;
  request.columns = 2;
  request.memory = 1000;
  FarmPlan plan{folder, 2, make_farm_plan(request), request.folder};
  plan.estimate = {4096, 100, 7.5};
  plan.inputs = {{"scene render.samples", "4"}, {"instructions", "AVX2"}};
  return plan;
}

TEST(ShotState, APlanReadsBackAsItWasWritten) {
  const FarmPlan shot = plan("/shows/rat");
  const std::string text = plan_json(shot);
  const FarmPlan read = parse_plan(text, "plan.json");
  EXPECT_EQ(plan_json(read), text);
  EXPECT_EQ(read.tasks[0].region, shot.tasks[0].region);
  EXPECT_EQ(read.threads, 2);
  EXPECT_EQ(read.estimate.render_bytes, shot.estimate.render_bytes);
  EXPECT_EQ(read.inputs, shot.inputs);
}

TEST(ShotState, APlanSaysWhatOtherQueuesNeed) {
  const std::string text = plan_json(plan("/shows/rat"));
  for (const char* part : {"\"exit_codes\": [\n      1,\n      129,\n      137,\n      143\n    ]",
                           "\"max\": 9", "\"kind\": \"merge\"", "\"log\": \"farm/logs/render-0001-2.txt\"",
                           "\"reserve\": 4096", "\"reserve\": 100", "\"cpu_s\": 7.5"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST(ShotState, PlansOfOtherPicturesDifferInWhatTheyName) {
  const FarmPlan shot = plan("/shows/rat");
  FarmPlan same = shot;
  same.inputs["instructions"] = "AVX512";
  same.threads = 7;
  same.tasks[0].command.push_back("--quiet");
  EXPECT_EQ(plan_differences(shot, same), "");

  FarmRequest request;
  request.frames = {1, 2, 3, 4};
  request.output = "other.%04d.exr";
  request.width = request.height = 64;
  const FarmPlan longer{"/shows/rat", 2, make_farm_plan(request)};
  EXPECT_EQ(plan_differences(shot, longer),
            "frames (1,2 before, 1-4 now), regions (2x1 of 64 x 64 pixels before, none now)");
  request.frames = {1, 2};
  request.columns = 2;
  const FarmPlan renamed{"/shows/rat", 2, make_farm_plan(request)};
  EXPECT_EQ(plan_differences(shot, renamed),
            "output (/shows/rat/shot.0001.exr before, /shows/rat/other.0001.exr now)");
  FarmPlan changed = shot;
  changed.inputs["scene render.samples"] = "99";
  EXPECT_EQ(plan_differences(shot, changed), "`render.samples`");
  FarmPlan lower = shot;
  for (FarmTask& task : lower.tasks) {
    if (task.region) task.region->y0 = 16;
  }
  EXPECT_EQ(plan_differences(longer, lower),
            "frames (1-4 before, 1,2 now), regions (none before, 2x1 of 64 x 64 pixels now)");
}

TEST(ShotState, DamagedPlansAreRefusedByName) {
  const std::string text = plan_json(plan("/shows/rat"));
  for (size_t length = 0; length + 2 < text.size(); length += 7) {
    try {
      parse_plan(text.substr(0, length), "farm/plan.json");
      ADD_FAILURE() << length;
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find("farm/plan.json: is not a plan of a shot"), 0u)
          << error.what();
    }
  }
  // A name becomes the name of a file.
  std::string hostile = text;
  hostile.replace(hostile.find("render-0001-r0c0"), 16, "../../etc/passwd");
  EXPECT_THROW(parse_plan(hostile, "plan.json"), Error);
  // A task that does not exist.
  hostile = text;
  hostile.replace(hostile.rfind("render-0001-r0c0"), 16, "render-0009-r0c0");
  EXPECT_THROW(parse_plan(hostile, "plan.json"), Error);
}

TEST(ShotState, EventsTellWhatHasHappened) {
  EXPECT_EQ(read_events("", 500).stage, TaskStage::kWaiting);
  const TaskState running = read_events("100 start 0 node1 7\n", 160);
  EXPECT_EQ(running.stage, TaskStage::kRunning);
  EXPECT_EQ(running.busy_s, 60);
  EXPECT_EQ(running.host, "node1");
  const TaskState again = read_events("100 start 0 node1 7\n150 end 137\n150 requeued\n", 500);
  EXPECT_EQ(again.stage, TaskStage::kQueuedAgain);
  EXPECT_EQ(again.exit_code, 137);
  const TaskState done =
      read_events("100 start 0 node1 7\n150 end 143\n150 requeued\n300 start 1 node2 7\n320 end 0\n", 500);
  EXPECT_EQ(done.stage, TaskStage::kDone);
  EXPECT_EQ(done.starts, 2);
  EXPECT_EQ(done.busy_s, 70);
  EXPECT_EQ(done.began, 100);
  EXPECT_EQ(done.ended, 320);
  EXPECT_EQ(done.host, "node2");
  EXPECT_EQ(read_events("100 start 0 n 7\n150 end 3\n", 500).stage, TaskStage::kFailed);
  EXPECT_EQ(read_events("100 start 0 n 7\n150 end 143\n150 cancelled\n", 500).stage, TaskStage::kCancelled);
}

TEST(ShotState, AFinishedTaskThatIsLookedAtAgainIsNoRestart) {
  const std::string done = "100 start 0 node1 7\n150 end 0\n";
  const TaskState looked = read_events(done + "300 start 0 node2 8\n301 end 0\n", 500);
  EXPECT_EQ(looked.stage, TaskStage::kDone);
  EXPECT_EQ(looked.starts, 1);
  EXPECT_EQ(looked.host, "node1");
  // Its picture was lost, say.
  const TaskState failed = read_events(done + "300 start 0 node2 8\n301 end 3\n", 500);
  EXPECT_EQ(failed.stage, TaskStage::kFailed);
  EXPECT_EQ(failed.starts, 2);
  EXPECT_EQ(failed.host, "node2");
}

TEST(ShotState, TornLinesAreSkipped) {
  EXPECT_EQ(read_events("100 start 0 n 7\n150 en", 200).stage, TaskStage::kRunning);
  EXPECT_EQ(read_events("100 start 0 n 7\n150 end", 200).stage, TaskStage::kRunning);
  EXPECT_EQ(read_events("\n100 start 0 n 7\n\n150 en\n180 start 1 n 7\n", 200).starts, 2);
  EXPECT_EQ(read_events("garbage\n\n-\n99999999999999999999999 end 0\n", 200).stage, TaskStage::kWaiting);
}

/// Writes the folder of a shot that was submitted as these jobs, and returns the folder.
std::filesystem::path submitted(const std::filesystem::path& parent, const std::string& jobs) {
  const auto shot_folder = parent / "farm";
  write_file(shot_folder / "plan.json", plan_json(plan(parent)));
  write_file(shot_folder / "jobs", jobs);
  return shot_folder;
}

TEST(ShotState, AQueueTellsLostAndCancelledTasks) {
  const TemporaryFolder folder;
  const auto shot_folder =
      submitted(folder.path(), "11 render-0001\n12 merge-0001\n13 render-0002\n14 merge-0002\n");
  write_file(shot_folder / "state" / "render-0001-r0c0", "100 start 0 n 7\n");
  write_file(shot_folder / "state" / "render-0001-r0c1", "100 start 0 n 7\n150 end 0\n");
  write_file(shot_folder / "state" / "render-0002-r0c0", "100 start 0 n 7\n");
  write_file(folder.path() / "farm" / "stats" / "0001-r0c1.json",
             R"({"cpu_s": 12.5, "peak_rss_bytes": 1048576})");

  const ShotState alone = read_shot_state(shot_folder, {}, 200);
  EXPECT_EQ(alone.tasks[0].stage, TaskStage::kRunning);
  EXPECT_EQ(alone.tasks[1].stage, TaskStage::kDone);
  EXPECT_EQ(alone.tasks[1].cpu_s, 12.5);
  EXPECT_EQ(alone.tasks[1].peak_bytes, 1048576);
  EXPECT_EQ(alone.tasks[1].log, "logs/render-0001-2.txt");
  EXPECT_EQ(alone.count(TaskStage::kWaiting), 3);

  const QueuedElements queue = parse_queue("13 1 RUNNING\n13 2 PENDING\n\nnonsense\n12 1 PENDING\n");
  const ShotState asked = read_shot_state(shot_folder, queue, 200);
  EXPECT_EQ(asked.tasks[0].stage, TaskStage::kLost);  // began, and the queue has forgotten it
  EXPECT_EQ(asked.tasks[1].stage, TaskStage::kDone);
  EXPECT_EQ(asked.tasks[2].stage, TaskStage::kWaiting);  // merge-0001
  EXPECT_EQ(asked.tasks[3].stage, TaskStage::kRunning);
  EXPECT_EQ(asked.tasks[4].stage, TaskStage::kWaiting);
  EXPECT_EQ(asked.tasks[5].stage, TaskStage::kCancelled);  // merge-0002 never began and is gone
  EXPECT_EQ(read_job_numbers(shot_folder), (std::vector<int64_t>{11, 12, 13, 14}));
}

TEST(ShotState, AFailedTaskThatIsSubmittedAgainIsQueuedAgain) {
  const TemporaryFolder folder;
  const auto shot_folder = submitted(folder.path(), "11 render-0001\n21 render-0001\n");
  write_file(shot_folder / "state" / "render-0001-r0c0", "100 start 0 n 11\n150 end 3\n");
  EXPECT_EQ(read_shot_state(shot_folder, parse_queue("21 1 PENDING\n"), 200).tasks[0].stage,
            TaskStage::kQueuedAgain);
  EXPECT_EQ(read_shot_state(shot_folder, parse_queue(""), 200).tasks[0].stage, TaskStage::kFailed);
}

TEST(ShotState, OtherFoldersAreRefused) {
  const TemporaryFolder folder;
  try {
    read_shot_state(folder.path(), {}, 0);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("is not the folder of a shot"), std::string::npos);
  }
}

}  // namespace
}  // namespace pelage
