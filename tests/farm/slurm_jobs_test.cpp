// SPDX-License-Identifier: Apache-2.0
#include "farm/slurm_jobs.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace pelage::slurm_jobs_test {
namespace {

FarmPlan plan(int frames, int columns, bool grows = false) {
  FarmRequest request;
  request.program = "/opt/pelage";
  request.scene = "my rat.yaml";
  for (int frame = 1; frame <= frames; ++frame) request.frames.push_back(frame);
  request.output = "shot.%04d.exr";
  request.folder = "farm";
  request.width = request.height = 64 * 16;
  request.columns = columns;
  request.memory = 1000;
  request.grows = grows;
  FarmPlan plan{"/shows/my rat", 2, make_farm_plan(request)};
  plan.estimate = {uint64_t{700} << 20, uint64_t{100} << 20, 0};
  return plan;
}

SlurmParams params() {
  SlurmParams params;
  params.folder = "/shows/my rat/farm";
  params.options = {"--partition=fur", "--comment=two words"};
  return params;
}

TEST(SlurmJobs, TheRegionsOfAFrameAreOneArrayAndItsMergeFollows) {
  const FarmPlan shot = plan(2, 3, true);
  const std::vector<SlurmJob> jobs = slurm_jobs(shot);
  ASSERT_EQ(jobs.size(), 6u);
  EXPECT_EQ(jobs[0].name, "grow");
  EXPECT_EQ(jobs[1].name, "render-0001");
  EXPECT_EQ(jobs[1].tasks, (std::vector<size_t>{1, 2, 3}));
  EXPECT_EQ(jobs[1].after, std::vector<size_t>{0});
  EXPECT_EQ(jobs[2].name, "merge-0001");
  EXPECT_EQ(jobs[2].after, std::vector<size_t>{1});
  EXPECT_EQ(jobs[3].name, "grow-0002");
  EXPECT_EQ(jobs[3].after, std::vector<size_t>{0});
  EXPECT_EQ(jobs[4].name, "render-0002");
  EXPECT_EQ(jobs[4].after, std::vector<size_t>{3});
  EXPECT_EQ(jobs[5].after, std::vector<size_t>{4});
}

TEST(SlurmJobs, FramesShareArraysThatSlurmAccepts) {
  const FarmPlan shot = plan(2500, 1);
  const std::vector<SlurmJob> jobs = slurm_jobs(shot);
  ASSERT_EQ(jobs.size(), 3u);
  size_t tasks = 0;
  std::vector<std::string> names;
  for (const SlurmJob& job : jobs) {
    EXPECT_LE(job.tasks.size(), kMaxArray);
    EXPECT_TRUE(job.after.empty());
    for (const size_t task : job.tasks) EXPECT_EQ(task, tasks++);
    names.push_back(job.name);
  }
  EXPECT_EQ(tasks, 2500u);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::unique(names.begin(), names.end()), names.end());
}

TEST(SlurmJobs, EachLineOfAListIsATask) {
  const FarmPlan shot = plan(1, 2);
  const std::vector<SlurmJob> jobs = slurm_jobs(shot);
  const std::string list = task_list(shot, jobs[0]);
  EXPECT_EQ(std::count(list.begin(), list.end(), '\n'), 2);
  EXPECT_TRUE(list.starts_with("render-0001-r0c0 /opt/pelage render 'my rat.yaml' ")) << list;
  EXPECT_EQ(log_name(jobs[0], 1), "logs/render-0001-2.txt");
}

TEST(SlurmJobs, ALineFeedInAnArgumentStaysInItsLine) {
  FarmPlan shot = plan(1, 2);
  shot.tasks[0].command.push_back("a: {\n b: 1}");
  const std::string list = task_list(shot, slurm_jobs(shot)[0]);
  EXPECT_EQ(std::count(list.begin(), list.end(), '\n'), 2);
  EXPECT_NE(list.find("'a: {'$'\\n'' b: 1}'"), std::string::npos) << list;
}

TEST(SlurmJobs, TheScriptSubmitsInOrderWithMemoryAndOptions) {
  const FarmPlan shot = plan(1, 2, true);
  const std::string script = submit_script(shot, slurm_jobs(shot), params());
  EXPECT_NE(script.find("folder='/shows/my rat/farm'"), std::string::npos);
  EXPECT_NE(script.find("--partition=fur '--comment=two words'"), std::string::npos);
  EXPECT_NE(script.find("submit grow 1 \"\" --mem=700M --cpus-per-task=2; j0=$id\n"), std::string::npos)
      << script;
  EXPECT_NE(script.find("submit render-0001 2 \"afterok:$j0\" --mem=700M --cpus-per-task=2; j1=$id\n"),
            std::string::npos);
  EXPECT_NE(script.find("submit merge-0001 1 \"afterok:$j1\" --mem=100M --cpus-per-task=1; j2=$id\n"),
            std::string::npos);
}

TEST(SlurmJobs, TheScriptOfATaskKnowsItsFolderAndItsRetries) {
  FarmPlan few = plan(1, 2);
  few.retries = 3;
  const std::string script = task_script(few, params());
  EXPECT_NE(script.find("folder='/shows/my rat/farm'\n"), std::string::npos);
  EXPECT_NE(script.find("-lt 3 ]"), std::string::npos);
  EXPECT_NE(script.find("\n  1|129|137|143)\n"), std::string::npos);
}

}  // namespace
}  // namespace pelage::slurm_jobs_test
