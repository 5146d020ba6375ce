// SPDX-License-Identifier: Apache-2.0
#include "farm/slurm_jobs.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/program.h"

namespace pelage {
namespace {

// Quotes in %-placeholders of sbatch would be taken literally by Slurm, so words are quoted for the shell
// only.
std::string word(const std::string& text) { return shell_line({text}); }

// Whether two tasks can be elements of the same array.
bool alike(const FarmTask& a, const FarmTask& b) {
  return a.after == b.after && a.region.has_value() == b.region.has_value() && a.kind() == b.kind() &&
         (!a.region || a.frame == b.frame);
}

std::string job_name(const FarmPlan& plan, const SlurmJob& job, size_t number) {
  const FarmTask& first = plan.tasks[job.tasks.front()];
  if (!first.region) return job.tasks.size() == 1 ? first.name : fmt::format("render-part{}", number);
  return fmt::format("render-{:04}{}", *first.frame, number > 0 ? fmt::format("-part{}", number) : "");
}

std::string element_line(const FarmPlan& plan, const SlurmJob& job) {
  const bool merges = plan.tasks[job.tasks.front()].kind() == "merge";
  const uint64_t bytes = merges ? plan.estimate.merge_bytes : plan.estimate.render_bytes;
  std::string line = fmt::format("--mem={}M", (bytes + (1 << 20) - 1) >> 20);
  if (merges) return line + " --cpus-per-task=1";
  return line + (plan.threads > 0 ? fmt::format(" --cpus-per-task={}", plan.threads) : " --exclusive");
}

}  // namespace

std::vector<SlurmJob> slurm_jobs(const FarmPlan& plan) {
  std::vector<SlurmJob> jobs;
  std::map<std::string, size_t> job_of;
  size_t parts = 0;
  for (size_t i = 0; i < plan.tasks.size(); ++i) {
    const FarmTask& task = plan.tasks[i];
    const FarmTask* last = jobs.empty() ? nullptr : &plan.tasks[jobs.back().tasks.front()];
    const bool joins = last && alike(*last, task) && jobs.back().tasks.size() < kMaxArray;
    if (!joins) {
      parts = last && alike(*last, task) ? parts + 1 : 0;
      jobs.emplace_back();
      for (const std::string& before : task.after) {
        const size_t job = job_of.at(before);
        std::vector<size_t>& after = jobs.back().after;
        if (std::find(after.begin(), after.end(), job) == after.end()) after.push_back(job);
      }
    }
    jobs.back().tasks.push_back(i);
    jobs.back().name = job_name(plan, jobs.back(), parts);
    job_of[task.name] = jobs.size() - 1;
  }
  return jobs;
}

std::string log_name(const SlurmJob& job, size_t element) {
  return fmt::format("logs/{}-{}.txt", job.name, element + 1);
}

std::string task_list(const FarmPlan& plan, const SlurmJob& job) {
  std::string text;
  for (const size_t task : job.tasks) {
    text += plan.tasks[task].name + " ";
    // A line per task: bash reads a line feed, which shell_line() put between quotes, as $'\n'.
    for (const char c : shell_line(plan.tasks[task].command)) {
      if (c == '\n') {
        text += "'$'\\n''";
      } else {
        text += c;
      }
    }
    text += "\n";
  }
  return text;
}

std::string task_script(const FarmPlan& plan, const SlurmParams& params) {
  return fmt::format(R"sh(#!/bin/bash
# Runs one task of a shot: line $SLURM_ARRAY_TASK_ID of a list. Stops it before the time limit (SIGUSR1) and when the job
# is cancelled (SIGTERM); both write a checkpoint. Queues it again if it was stopped or killed, but not if it was cancelled.
folder={0}
signalled= warned= cancelled=   # whatever the job inherits
read -r name command < <(sed -n "${{SLURM_ARRAY_TASK_ID}}p" "$1")
[ "$command" ] || {{ echo "$1 has no line $SLURM_ARRAY_TASK_ID" >&2; exit 1; }}
for file in jobs state "state/$name"; do
  [ ! -L "$folder/$file" ] || {{ echo "$folder/$file is a symbolic link" >&2; exit 3; }}
done
# A submission that was killed may not have noted this job.
grep -qs "^$SLURM_ARRAY_JOB_ID " "$folder/jobs" || echo "$SLURM_ARRAY_JOB_ID ${{1##*/}}" >> "$folder/jobs"
# Begins a line, because the last one may have been cut off (full disk, power failure).
note() {{ printf '\n%s %s\n' "$(date +%s)" "$*" >> "$folder/state/$name"; }}
note start "${{SLURM_RESTART_COUNT:-0}}" "${{SLURMD_NODENAME:-$(hostname)}}" "$SLURM_JOB_ID"
trap 'signalled=1; warned=1; note warned; kill -TERM $child' USR1
# Slurm also sends SIGTERM at the time limit, to a task that was warned and still writes its checkpoint.
trap 'signalled=1; [ "$warned" ] || cancelled=1; kill -TERM $child' TERM
eval "exec $command" &   # exec: signals must reach the command itself
child=$!
[ "$signalled" ] && kill -TERM $child   # a signal that came before there was a child
while :; do
  signalled=
  wait $child; code=$?
  [ "$signalled" ] || break   # a signal interrupts wait
done
note end "$code"
case $code in
  {2})
    if [ "$cancelled" ]; then
      note cancelled
    elif [ "${{SLURM_RESTART_COUNT:-0}}" -lt {1} ]; then
      note requeued
      # The number of a job alone may mean the whole array.
      scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_${{SLURM_ARRAY_TASK_ID}}" || note end "$code"
    fi ;;
esac
exit "$code"
)sh",
                     word(params.folder), plan.retries, fmt::join(kRetriedCodes, "|"));
}

std::string submit_script(const FarmPlan& plan, const std::vector<SlurmJob>& jobs,
                          const SlurmParams& params) {
  std::string text = fmt::format(R"sh(#!/bin/bash
# Submits the tasks of a shot to Slurm, and notes the numbers of the jobs in `jobs`. SIGTERM stops it before the next
# job. It does not reach sbatch, because a job that Slurm accepts must be noted.
set -e
folder={0}
stopped=   # whatever the caller has
cd {1}
trap 'stopped=1' TERM
submit() {{   # NAME ELEMENTS DEPENDENCY OPTION...: sets $id
  local name=$1 elements=$2 after=$3; shift 3
  [ -z "$stopped" ] || exit 143
  id=$(trap '' TERM; exec sbatch --parsable --job-name="$name" --array="1-$elements" --chdir={1} --output="${{folder//%/%%}}/logs/%x-%a.txt" \
    --open-mode=append --requeue --signal=B:USR1@{2} ${{after:+--dependency="$after" --kill-on-invalid-dep=yes}} \
    "$@" {3} "$folder/task.sh" "$folder/tasks/$name")
  id=${{id:0:64}}   # patterns take forever on a long text
  id=${{id%%;*}}
  case $id in ''|*[!0-9]*) echo "sbatch printed no number of a job" >&2; exit 1 ;; esac
  grep -qs "^$id " "$folder/jobs" || echo "$id $name" >> "$folder/jobs"
}}
)sh",
                                 word(params.folder), word(plan.folder.string()), params.warning_s,
                                 shell_line(params.options));
  for (size_t i = 0; i < jobs.size(); ++i) {
    std::string after;
    for (const size_t before : jobs[i].after) after += fmt::format(":$j{}", before);
    if (!after.empty()) after = "afterok" + after;
    text += fmt::format("submit {} {} \"{}\" {}; j{}=$id\n", jobs[i].name, jobs[i].tasks.size(), after,
                        element_line(plan, jobs[i]), i);
  }
  return text;
}

}  // namespace pelage
