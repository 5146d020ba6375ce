// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "lab/runs/process.h"
#include "lab/runs/run_statistics.h"

namespace pelage {

/// Settings that all variants of an experiment share.
struct MeasureSetup {
  std::filesystem::path program;  ///< run once per variant
  std::filesystem::path folder;   ///< receives all output files
  std::string scene;
  std::vector<std::string> arguments;  ///< for every run: --set, --threads
  int repeat = 1;                      ///< runs of each variant
  double time_limit_s = kNoLimit_s;    ///< a run that takes longer is killed
};

/// One way to run the program.
struct Variant {
  std::string id;     ///< names its files: "exact-cold"
  std::string title;  ///< for people: "exact, cold"
  std::string command = "render";
  std::vector<std::string> arguments;
  bool once = false;  ///< not repeated: warm-up runs, and cold runs, which would be warm the second time
  std::function<void()> prepare = {};  ///< called before each run
};

struct VariantRun {
  std::vector<std::string> command;
  ProcessEnd end;
  std::string error;  ///< error message of a run that failed
  double load = 0;    ///< load average (1 min) when it started
  std::optional<RunStatistics> statistics;
};

/// Result of a variant.
struct Outcome {
  Variant variant;
  std::vector<VariantRun> runs;

  bool succeeded() const;      ///< every run
  bool refused() const;        ///< exit code 4: the memory budget was too small, which is a valid result
  bool timed_out() const;      ///< a run exceeded the time limit
  bool interrupted() const;    ///< stopped from outside, or never started
  std::string status() const;  ///< "done", "refused", "time-out", "exit code 1", "signal 9", "interrupted"
  std::string error() const;   ///< error message of the run that failed

  /// The successful run with the median wall time; null when there is none.
  const VariantRun* typical() const;
  /// A number from the statistics of typical(), by path; NaN when unknown.
  double number(const std::string& path) const;
  /// Min and max over all successful runs.
  double min(const std::string& path) const;
  double max(const std::string& path) const;
};

/// Runs variants one at a time, each in its own process.
class VariantRunner {
 public:
  /// `count`: number of variants expected, for the progress display.
  VariantRunner(const MeasureSetup& setup, Progress& progress, size_t count);

  /// Writes ID.json (--stats), ID.exr or nothing (-o), and ID.log for every variant; repeated runs write
  /// ID.2.json and so on. A variant that fails is a valid result. Throws Error (kFailed) when the folder
  /// cannot be written.
  Outcome run(const Variant& variant);
  /// Runs many variants in rounds, every variant once per round, so that changing load of the machine affects
  /// all alike. A variant that failed is not run again.
  std::vector<Outcome> run_in_rounds(const std::vector<Variant>& variants);

  std::filesystem::path picture(const Variant& variant) const;

 private:
  VariantRun run_once(const Variant& variant, int repeat);
  void note_failure(const Outcome& outcome);

  const MeasureSetup& setup_;
  Progress& progress_;
  size_t count_ = 0, done_ = 0;
};

/// Every run with its command, end and statistics as a JSON array.
std::string runs_json(const std::vector<Outcome>& outcomes);

}  // namespace pelage
