// SPDX-License-Identifier: Apache-2.0
// How long the command takes to start, and how much memory: whole processes, from fork to exit. `ratio` is to
// /bin/true in the same run; the aim is 50 ms and 20 MB.
#include <algorithm>
#include <array>
#include <chrono>
#include <string>

#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace {

struct Cost {
  double seconds = 0;
  double peak_megabytes = 0;
  bool succeeded = false;
};

Cost run(const std::array<std::string, 3>& arguments) {
  std::array<char*, 4> argv{};
  size_t count = 0;
  for (const std::string& argument : arguments) {
    if (!argument.empty()) argv[count++] = const_cast<char*>(argument.c_str());
  }
  const auto start = std::chrono::steady_clock::now();
  const pid_t child = ::fork();
  if (child == 0) {
    const int nowhere = ::open("/dev/null", O_WRONLY);
    ::dup2(nowhere, STDOUT_FILENO);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  int status = 0;
  rusage usage{};
  if (child < 0 || ::wait4(child, &status, 0, &usage) != child) return {};
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
  return {passed.count(), static_cast<double>(usage.ru_maxrss) / 1024,
          WIFEXITED(status) && WEXITSTATUS(status) == 0};
}

void start(benchmark::State& state, const std::string& verb, const std::string& file) {
  double seconds = 0, yardstick = 0, peak = 0;
  for (auto _ : state) {
    const Cost ours = run({PELAGE_COMMAND, verb, file}), bare = run({"/bin/true", "", ""});
    if (!ours.succeeded || !bare.succeeded) {
      state.SkipWithError("the command failed");
      return;
    }
    state.SetIterationTime(ours.seconds);
    seconds += ours.seconds;
    yardstick += bare.seconds;
    peak = std::max(peak, ours.peak_megabytes);
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
