// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/process.h"
#include "base/progress.h"
#include "lab/runs/run_statistics.h"

namespace pelage {

/// Settings that are common to all variants of an experiment.
struct MeasureSetup {
  std::filesystem::path program;  ///< program that every run starts
  std::filesystem::path folder;   ///< folder for all output files
  std::string scene;
  std::vector<std::string> arguments;  ///< arguments of every run, such as --set and --threads
  int repeat = 1;                      ///< number of runs of each variant
  double time_limit_s = kNoLimit_s;    ///< a run that takes longer is stopped
};

/// One way to run the program.
struct Variant {
  std::string id;     ///< start of the names of its files: "exact-cold"
  std::string title;  ///< name for readers: "exact, cold"
  std::string command = "render";
  std::vector<std::string> arguments;
  /// Runs only once: for warm-up runs, and for cold runs, which would be warm the second time.
  bool once = false;
  std::function<void()> prepare = {};  ///< called before each run
  /// Number of frames that a run renders. Each frame has the time limit of a run.
  int frames = 1;
};

struct VariantRun {
  std::vector<std::string> command;
  ProcessEnd end;
  std::string error;  ///< error message; empty if the run succeeded
  double load = 0;    ///< load average of the last minute when the run started
  std::optional<RunStatistics> statistics;
};

/// Result of a variant.
struct Outcome {
  Variant variant;
  std::vector<VariantRun> runs;

  bool succeeded() const;  ///< whether all runs succeeded
  /// Whether the exit code was 4: the memory budget was too small, which is a valid result.
  bool refused() const;
  bool timed_out() const;    ///< whether a run exceeded the time limit
  bool interrupted() const;  ///< whether it was stopped by the user or never started
  /// "done", "refused", "time-out", "exit code 1", "signal 9", "interrupted" or "not run".
  std::string status() const;
  std::string error() const;  ///< error message of the failed run; empty if there is none

  /// Returns the successful run with the median wall time (the faster of two middle runs). Null when no run
  /// succeeded.
  const VariantRun* typical() const;
  /// Returns one value of the statistics of typical(). `path`: of the value in the JSON. NaN when unknown.
  double number(const std::string& path) const;
  /// min() and max() return the min and max of a number over all successful runs. NaN when unknown.
  double min(const std::string& path) const;
  double max(const std::string& path) const;
};

/// Runs variants one after the other, each run in its own process.
class VariantRunner {
 public:
  /// `count`: expected number of variants, for the progress display.
  VariantRunner(const MeasureSetup& setup, Progress& progress, size_t count);

  /// Runs a variant. A run writes ID.json (--stats), ID.log and, if it renders, ID.exr (-o), where ID is
  /// Variant::id. Repeated runs write ID.2.json, ID.2.log and so on. The pictures of several frames are
  /// ID.0001.exr and so on. A variant that fails is a valid result; it is not run again. Throws Error
  /// (kFailed) when the folder cannot be written.
  Outcome run(const Variant& variant);
  /// Runs several variants in rounds: every round runs each variant once, so that a change of the machine's
  /// load affects all variants alike. A variant that failed is not run again. Omits variants that were never
  /// run because the user stopped.
  std::vector<Outcome> run_in_rounds(const std::vector<Variant>& variants);

  /// Path of the picture that the runs of a variant write. If they render several frames, it has a
  /// placeholder for frame_file_name().
  std::filesystem::path picture(const Variant& variant) const;

 private:
  VariantRun run_once(const Variant& variant, int repeat);
  void note_failure(const Outcome& outcome);

  const MeasureSetup& setup_;
  Progress& progress_;
  size_t count_ = 0, done_ = 0;
};

/// Returns all runs as a JSON array, each with its command, its end and its statistics.
std::string runs_json(const std::vector<Outcome>& outcomes);

}  // namespace pelage
