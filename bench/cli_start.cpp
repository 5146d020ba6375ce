// SPDX-License-Identifier: Apache-2.0
// How long the command takes to start, and how much memory: whole processes, from fork to exit. `ratio` is to
// /bin/true in the same run; the aim is 50 ms and 20 MB.
#include <algorithm>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "base/process.h"

namespace {

pelage::ProcessEnd run(const std::vector<std::string>& command) { return pelage::run_process({command}).end; }

void start(benchmark::State& state, const std::string& verb, const std::string& file) {
  double seconds = 0, yardstick = 0, peak = 0;
  for (auto _ : state) {
    std::vector<std::string> command{PELAGE_COMMAND, verb};
    if (!file.empty()) command.push_back(file);
    const pelage::ProcessEnd ours = run(command), bare = run({"/bin/true"});
    if (!ours.succeeded() || !bare.succeeded()) {
      state.SkipWithError("the command failed");
      return;
    }
    state.SetIterationTime(ours.wall_s);
    seconds += ours.wall_s;
    yardstick += bare.wall_s;
    peak = std::max(peak, static_cast<double>(ours.peak_rss_bytes) / (1 << 20));
  }
  state.counters["ratio"] = seconds / yardstick;
  state.counters["peak_MB"] = peak;
}

const std::string kExamples = PELAGE_EXAMPLES;
BENCHMARK_CAPTURE(start, help, "--help", "")->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(start, info_scene, "info", kExamples + "/rat.yaml")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(start, info_hair, "info", kExamples + "/imported.hair")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
