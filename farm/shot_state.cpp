// SPDX-License-Identifier: Apache-2.0
#include "farm/shot_state.h"

#include <algorithm>
#include <charconv>
#include <sstream>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "farm/slurm_jobs.h"

namespace pelage {
namespace {

/// Returns the text of a file that others may have written; empty for links, and for more than any shot
/// needs.
std::string text_of(const std::filesystem::path& path) {
  constexpr size_t kLongest = size_t(64) << 20;
  try {
    return read_file(path, kLongest, OpenFile::Links::kRefuse);
  } catch (const Error&) {
    return {};
  }
}

std::string argument_after(const FarmTask& task, std::string_view flag) {
  const auto found = std::find(task.command.begin(), task.command.end(), flag);
  return found == task.command.end() || found + 1 == task.command.end() ? "" : *(found + 1);
}

void add_statistics(const std::filesystem::path& path, TaskState& state) {
  const nlohmann::json json = nlohmann::json::parse(text_of(path), nullptr, false);
  if (!json.is_object()) return;
  const auto number = [&](const char* key) {
    const auto value = json.find(key);
    return value != json.end() && value->is_number() ? value->get<double>() : 0.0;
  };
  state.cpu_s = number("cpu_s");
  state.peak_bytes = static_cast<int64_t>(number("peak_rss_bytes"));
}

/// The numbers of the jobs of each name.
std::map<std::string, std::vector<int64_t>> read_jobs(const std::filesystem::path& folder) {
  std::map<std::string, std::vector<int64_t>> jobs;
  std::istringstream lines(text_of(folder / "jobs"));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    int64_t number = 0;
    std::string name;
    if (words >> number >> name) jobs[name].push_back(number);
  }
  return jobs;
}

// A queue knows more than the notes of a task that has not ended by itself, and a task that failed may have
// been submitted again.
void apply_queue(const QueuedElements& queue, const std::vector<int64_t>& numbers, size_t element,
                 TaskState& state) {
  if (state.stage == TaskStage::kDone) return;
  const std::string* found = nullptr;
  for (const int64_t number : numbers) {
    const auto at = queue.find({number, static_cast<int64_t>(element) + 1});
    if (at != queue.end()) found = &at->second;
  }
  if (state.stage == TaskStage::kFailed) {
    if (found && (*found == "PENDING" || *found == "CONFIGURING")) state.stage = TaskStage::kQueuedAgain;
  } else if (!found) {
    state.stage = state.stage == TaskStage::kRunning ? TaskStage::kLost : TaskStage::kCancelled;
  } else if (*found == "PENDING") {
    state.stage = state.starts > 0 ? TaskStage::kQueuedAgain : TaskStage::kWaiting;
  } else if (*found == "RUNNING" && state.starts > 0 && state.stage != TaskStage::kQueuedAgain) {
    state.stage = TaskStage::kRunning;
  }
}

}  // namespace

std::string_view stage_name(TaskStage stage) {
  constexpr std::string_view kNames[] = {"waiting",   "running", "queued again", "done",
                                         "cancelled", "failed",  "lost"};
  return kNames[static_cast<size_t>(stage)];
}

int64_t ShotState::count(TaskStage stage) const {
  return std::count_if(tasks.begin(), tasks.end(), [&](const TaskState& t) { return t.stage == stage; });
}

QueuedElements parse_queue(std::string_view text) {
  QueuedElements queue;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    int64_t job = 0, element = 0;
    const char* end = line.data() + line.size();
    const auto [blank, no_job] = std::from_chars(line.data(), end, job);
    if (no_job != std::errc() || blank == end) continue;
    const auto [second, no_element] = std::from_chars(blank + 1, end, element);
    if (no_element != std::errc() || second == end || second + 1 == end) continue;
    const std::string_view state(second + 1, static_cast<size_t>(end - second - 1));
    queue.insert_or_assign(queue.end(), {job, element}, std::string(state.substr(0, state.find(' '))));
  }
  return queue;
}

TaskState read_events(std::string_view text, int64_t now) {
  TaskState state;
  std::istringstream lines{std::string(text)};
  int64_t start = 0;
  std::string looker;  // host of a start that finds the task finished
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    int64_t time = 0;
    std::string event;
    if (!(words >> time >> event)) continue;
    if (event == "start") {
      std::string attempt, host;
      words >> attempt >> host;
      looker = state.stage == TaskStage::kDone ? host : "";
      if (looker.empty()) {
        state.host = host;
        ++state.starts;
      }
      state.stage = TaskStage::kRunning;
      start = time;
      if (state.began == 0) state.began = time;
    } else if (event == "end" && words >> state.exit_code) {
      state.stage = state.exit_code == 0 ? TaskStage::kDone : TaskStage::kFailed;
      if (!looker.empty() && state.exit_code != 0) {
        state.host = looker;
        ++state.starts;
      }
      looker.clear();
      if (start > 0) state.busy_s += static_cast<double>(time - start);
      start = 0;
      state.ended = time;
    } else if (event == "cancelled") {
      state.stage = TaskStage::kCancelled;
    } else if (event == "requeued") {
      state.stage = TaskStage::kQueuedAgain;
    }
  }
  if (state.stage == TaskStage::kRunning && start > 0) state.busy_s += static_cast<double>(now - start);
  return state;
}

ShotState read_shot_state(const std::filesystem::path& folder, const std::optional<QueuedElements>& queue,
                          int64_t now) {
  ShotState shot;
  shot.plan = read_plan(folder);
  shot.owner = OpenFile(folder / "plan.json", OpenFile::Links::kRefuse).owner();
  shot.tasks.resize(shot.plan.tasks.size());
  const auto numbers = read_jobs(folder);
  for (const SlurmJob& job : slurm_jobs(shot.plan)) {
    const auto submitted = numbers.find(job.name);
    for (size_t i = 0; i < job.tasks.size(); ++i) {
      const FarmTask& task = shot.plan.tasks[job.tasks[i]];
      TaskState& state = shot.tasks[job.tasks[i]];
      state = read_events(text_of(folder / "state" / task.name), now);
      state.log = log_name(job, i);
      if (const std::string stats = argument_after(task, "--stats"); !stats.empty())
        add_statistics(shot.plan.folder / stats, state);
      if (queue && submitted != numbers.end()) apply_queue(*queue, submitted->second, i, state);
    }
  }
  return shot;
}

std::vector<int64_t> read_job_numbers(const std::filesystem::path& folder) {
  std::vector<int64_t> all;
  for (const auto& [name, numbers] : read_jobs(folder)) all.insert(all.end(), numbers.begin(), numbers.end());
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace pelage
