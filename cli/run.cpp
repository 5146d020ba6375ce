// SPDX-License-Identifier: Apache-2.0
#include "cli/run.h"

#include <exception>

#include "world/statistics_json.h"

namespace pelage {
namespace {

// Without --sample-memory only the peak is used.
constexpr double kSampleMemory_s = 0.05;

ProcessUsage baseline() {
  ProcessUsage usage;
  usage.baseline_rss_bytes = current_rss_bytes();
  usage.baseline_anonymous_bytes = resident_memory().anonymous;
  return usage;
}

}  // namespace

Run::Run(const RunOptions& options)
    : statistics_{.process = baseline()},
      keeps_timeline_(options.sample_memory_s.has_value()),
      sampler_(ledger_, start_, options.sample_memory_s.value_or(kSampleMemory_s)),
      workers_(options.threads),
      display_(options.progress, &SignalGuard::interrupted) {}

double Run::seconds() const {
  return std::chrono::duration<double>(MemorySampler::Clock::now() - start_).count();
}

void Run::finish(const RunOptions& options) {
  ProcessUsage& process = statistics_.process;
  process.wall_s = seconds();
  process.cpu_s = cpu_seconds();
  process.peak_rss_bytes = peak_rss_bytes();
  const MemoryHistory& memory = sampler_.stop();
  process.peak_anonymous_bytes = memory.highest.resident.anonymous;
  process.unexplained_bytes =
      memory.highest.resident.anonymous - process.baseline_anonymous_bytes - memory.highest.tagged();
  if (keeps_timeline_) process.timeline = memory.timeline;
  for (int tag = 0; tag < static_cast<int>(MemoryTag::kCount); ++tag) {
    const auto memory_tag = static_cast<MemoryTag>(tag);
    process.memory_bytes[std::string(memory_tag_name(memory_tag))] = ledger_.peak(memory_tag);
  }
  if (options.stats) write_statistics(*options.stats, statistics_);
}

Run::StageTimer::StageTimer(Run& run, std::string_view name)
    : run_(run), name_(name), began_(run.seconds()), exceptions_(std::uncaught_exceptions()) {
  run_.display_.begin(name_, 1);
}

Run::StageTimer::~StageTimer() {
  if (std::uncaught_exceptions() == exceptions_) run_.display_.advance(1);
  run_.display_.end();
  run_.statistics_.stages_s[name_] += run_.seconds() - began_;
}

}  // namespace pelage
