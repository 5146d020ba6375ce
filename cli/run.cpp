// SPDX-License-Identifier: Apache-2.0
#include "cli/run.h"

#include "cli/stats_json.h"

namespace pelage {

Run::Run(const Options& options)
    : workers_(options.threads), display_(options.progress, &SignalGuard::interrupted) {
  statistics_.baseline_rss_bytes = current_rss_bytes();
}

double Run::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Run::finish(const Options& options) {
  statistics_.wall_s = seconds();
  statistics_.cpu_s = cpu_seconds();
  statistics_.peak_rss_bytes = peak_rss_bytes();
  for (int tag = 0; tag < static_cast<int>(MemoryTag::kCount); ++tag) {
    const auto memory_tag = static_cast<MemoryTag>(tag);
    statistics_.memory_bytes[std::string(memory_tag_name(memory_tag))] = ledger_.peak(memory_tag);
  }
  if (options.stats) write_statistics(*options.stats, statistics_);
}

Run::StageTimer::StageTimer(Run& run, std::string_view name) : run_(run), name_(name), began_(run.seconds()) {
  run_.display_.begin(name_, 1);
}

Run::StageTimer::~StageTimer() {
  run_.display_.advance(1);
  run_.display_.end();
  run_.statistics_.stages_s[name_] += run_.seconds() - began_;
}

}  // namespace pelage
