// SPDX-License-Identifier: Apache-2.0
#include "lab/runs/variant.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "base/error.h"
#include "base/file.h"
#include "lab/report/machine.h"

namespace pelage {
namespace {

constexpr int kMemoryExitCode = 4;

// The first lines of a log contain the error; quiet runs print nothing else.
std::string error_lines(const std::filesystem::path& log) {
  constexpr int kMax = 3;
  std::istringstream lines(read_file(log));
  std::string text;
  int count = 0;
  for (std::string line; count < kMax && std::getline(lines, line);) {
    if (line.empty()) continue;
    text += (text.empty() ? "" : "; ") + line;
    ++count;
  }
  return text;
}

std::string end_text(const ProcessEnd& end) {
  if (end.interrupted) return "interrupted";
  if (end.timed_out) return "time-out";
  if (end.signal != 0) return fmt::format("signal {}", end.signal);
  if (end.exit_code == kMemoryExitCode) return "refused";
  return end.exit_code == 0 ? "done" : fmt::format("exit code {}", end.exit_code);
}

}  // namespace

bool Outcome::succeeded() const { return !runs.empty() && runs.back().end.succeeded(); }

bool Outcome::refused() const {
  return !runs.empty() && !interrupted() && !timed_out() && runs.back().end.signal == 0 &&
         runs.back().end.exit_code == kMemoryExitCode;
}

bool Outcome::timed_out() const { return !runs.empty() && runs.back().end.timed_out; }

bool Outcome::interrupted() const { return runs.empty() || runs.back().end.interrupted; }

std::string Outcome::status() const { return runs.empty() ? "not run" : end_text(runs.back().end); }

std::string Outcome::error() const { return runs.empty() ? "" : runs.back().error; }

const VariantRun* Outcome::typical() const {
  std::vector<const VariantRun*> good;
  for (const VariantRun& run : runs) {
    if (run.end.succeeded() && run.statistics) good.push_back(&run);
  }
  if (good.empty()) return nullptr;
  std::sort(good.begin(), good.end(), [](const VariantRun* a, const VariantRun* b) {
    return a->statistics->number("wall_s") < b->statistics->number("wall_s");
  });
  return good[(good.size() - 1) / 2];
}

double Outcome::number(const std::string& path) const {
  const VariantRun* run = typical();
  return run ? run->statistics->number(path) : NAN;
}

double Outcome::min(const std::string& path) const {
  double min = NAN;
  for (const VariantRun& run : runs) {
    if (run.end.succeeded() && run.statistics) min = std::fmin(min, run.statistics->number(path));
  }
  return min;
}

double Outcome::max(const std::string& path) const {
  double max = NAN;
  for (const VariantRun& run : runs) {
    if (run.end.succeeded() && run.statistics) max = std::fmax(max, run.statistics->number(path));
  }
  return max;
}

VariantRunner::VariantRunner(const MeasureSetup& setup, Progress& progress, size_t count)
    : setup_(setup), progress_(progress), count_(count) {}

std::filesystem::path VariantRunner::picture(const Variant& variant) const {
  return setup_.folder / (variant.id + (variant.frames > 1 ? ".####.exr" : ".exr"));
}

Outcome VariantRunner::run(const Variant& variant) {
  Outcome outcome{variant, {}};
  const int repeats = variant.once ? 1 : setup_.repeat;
  ++done_;
  progress_.begin(fmt::format("variant {}/{} {}", done_, std::max(count_, done_), variant.title), repeats);
  for (int repeat = 1; repeat <= repeats && !progress_.cancelled(); ++repeat) {
    outcome.runs.push_back(run_once(variant, repeat));
    progress_.advance(1);
    if (!outcome.succeeded()) break;
  }
  progress_.end();
  note_failure(outcome);
  return outcome;
}

std::vector<Outcome> VariantRunner::run_in_rounds(const std::vector<Variant>& variants) {
  std::vector<Outcome> outcomes;
  for (const Variant& variant : variants) outcomes.push_back({variant, {}});
  for (int round = 1; round <= setup_.repeat && !progress_.cancelled(); ++round) {
    progress_.begin(fmt::format("round {}/{}", round, setup_.repeat), static_cast<double>(variants.size()));
    for (Outcome& outcome : outcomes) {
      const bool again = round == 1 || (outcome.succeeded() && !outcome.variant.once);
      if (again && !progress_.cancelled()) outcome.runs.push_back(run_once(outcome.variant, round));
      progress_.advance(1);
    }
    progress_.end();
    if (round > 1) continue;
    for (const Outcome& outcome : outcomes) note_failure(outcome);
  }
  std::erase_if(outcomes, [](const Outcome& outcome) { return outcome.runs.empty(); });
  return outcomes;
}

void VariantRunner::note_failure(const Outcome& outcome) {
  if (outcome.succeeded() || outcome.interrupted()) return;
  progress_.note(fmt::format("{}: {}: {}", outcome.variant.title, outcome.status(), outcome.error()));
}

VariantRun VariantRunner::run_once(const Variant& variant, int repeat) {
  const std::string stem = repeat == 1 ? variant.id : fmt::format("{}.{}", variant.id, repeat);
  const std::filesystem::path statistics = setup_.folder / (stem + ".json"),
                              log = setup_.folder / (stem + ".log");
  // Files of an earlier experiment must not be mistaken for results of this one.
  std::error_code ignored;
  std::filesystem::remove(statistics, ignored);
  if (variant.prepare) variant.prepare();

  VariantRun run;
  run.command = {setup_.program.string(), variant.command, setup_.scene};
  if (variant.command == "render") run.command.insert(run.command.end(), {"-o", picture(variant).string()});
  run.command.insert(run.command.end(), {"--stats", statistics.string(), "--quiet"});
  // Every run does the same work, whatever earlier runs left in the user's cache.
  if (variant.command == "render" || variant.command == "grow") run.command.push_back("--no-cache");
  for (const auto* list : {&setup_.arguments, &variant.arguments})
    run.command.insert(run.command.end(), list->begin(), list->end());
  run.load = load_average();
  ProcessLimits limits;
  limits.seconds = setup_.time_limit_s * variant.frames;
  limits.cancelled = [&] { return progress_.cancelled(); };
  ProcessSetup process{run.command};
  process.log = log;
  run.end = run_process(process, limits).end;
  run.statistics = RunStatistics::read(statistics);
  if (run.end.timed_out) {
    run.error = fmt::format("stopped after {:g} s", limits.seconds);
  } else if (!run.end.succeeded()) {
    run.error = error_lines(log);
  }
  return run;
}

}  // namespace pelage
