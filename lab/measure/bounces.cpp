// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>

#include "base/counted.h"
#include "lab/measure/bounce_runs.h"
#include "lab/runs/outcome_table.h"
#include "render/reflection/cell_keys.h"

namespace pelage {
namespace {

/// The run of a method with this count of bounces; null if there is none.
const BounceRun* run_of(const std::vector<BounceRun>& runs, size_t method, int bounces) {
  for (const BounceRun& run : runs) {
    if (!run.is_warm_up && run.method == method && run.bounces == bounces) return &run;
  }
  return nullptr;
}

double light_of_last_bounces(const std::vector<BounceRun>& runs, const BounceRun& run) {
  const BounceRun* before = nullptr;
  for (const int bounces : kBounces) {
    if (bounces < run.bounces) before = run_of(runs, run.method, bounces);
  }
  return before ? run.light - before->light : run.light;
}

Table bounce_table(const std::vector<BounceRun>& runs, const std::vector<Outcome>& outcomes) {
  Table table = outcome_table(outcomes);
  const auto add = [&](const char* key, const char* title, Quantity quantity, const auto& value) {
    add_column(table, {key, title, quantity}, outcomes, [&](const Outcome& o) -> Cell {
      const BounceRun& run = runs[static_cast<size_t>(&o - outcomes.data())];
      return run.is_warm_up ? NAN : value(run);
    });
  };
  const auto cpu_s = [](const BounceRun* run) { return run ? run->outcome.number("cpu_s") : NAN; };
  add("bounces", "bounces", Quantity::kCount, [](const BounceRun& run) { return double(run.bounces); });
  add("of_one_bounce", "of one bounce", Quantity::kRatio,
      [&](const BounceRun& run) { return cpu_s(&run) / cpu_s(run_of(runs, run.method, 1)); });
  add("of_path", "of path", Quantity::kRatio,
      [&](const BounceRun& run) { return cpu_s(&run) / cpu_s(run_of(runs, 0, run.bounces)); });
  add("light", "light", Quantity::kRatio, [](const BounceRun& run) { return run.light; });
  add("light_of_last_bounces", "of it, by the last bounces", Quantity::kRatio,
      [&](const BounceRun& run) { return light_of_last_bounces(runs, run); });
  add("light_off", "off path", Quantity::kError, [&](const BounceRun& run) {
    const BounceRun* path = run_of(runs, 0, run.bounces);
    return path ? run.light / path->light - 1 : NAN;
  });
  const auto number = [](const BounceRun& run, const char* key) { return run.outcome.number(key); };
  add("cells", "cells", Quantity::kCount,
      [&](const BounceRun& run) { return number(run, "reflection_cells"); });
  add("paths_per_cell", "paths per cell", Quantity::kRatio, [&](const BounceRun& run) {
    // Each path is in a cell of each size.
    constexpr double kSizes = std::tuple_size_v<CellPath>;
    return kSizes * number(run, "reflection_paths") / number(run, "reflection_cells");
  });
  add("lookups", "lookups", Quantity::kCount,
      [&](const BounceRun& run) { return number(run, "reflection_lookups"); });
  add("found", "found", Quantity::kRatio, [&](const BounceRun& run) {
    return number(run, "reflections_found") / number(run, "reflection_lookups");
  });
  add("slices", "slices", Quantity::kCount,
      [&](const BounceRun& run) { return number(run, "reflection_slices"); });
  add("cells_bytes", "cells, while read", Quantity::kBytes,
      [&](const BounceRun& run) { return number(run, "reflection_bytes"); });
  add("cache_bytes", "cache, while filled", Quantity::kBytes,
      [&](const BounceRun& run) { return number(run, "memory_bytes.reflection_cache"); });
  return table;
}

LinePlot bounce_plot(const std::vector<BounceRun>& runs) {
  LinePlot plot;
  plot.caption = "CPU seconds by bounces.";
  plot.x = {"bounces + 1", Quantity::kCount, true};
  plot.y = {"CPU time", Quantity::kSeconds};
  plot.markers = true;
  for (size_t method = 0; method < bounce_methods().size(); ++method) {
    Series line{bounce_methods()[method].title, {}};
    for (const BounceRun& run : runs) {
      if (!run.is_warm_up && run.method == method && run.outcome.succeeded())
        line.points.emplace_back(run.bounces + 1, run.outcome.number("cpu_s"));
    }
    plot.lines.push_back(std::move(line));
  }
  return plot;
}

}  // namespace

Measured measure_bounces(const SceneDescription& scene, int samples, const MeasureSetup& setup,
                         Progress& progress) {
  const std::vector<BounceRun> runs = run_bounces(scene, samples, setup, progress);
  Measured measured;
  for (const BounceRun& run : runs) measured.outcomes.push_back(run.outcome);
  Report& report = measured.report;
  report.title = "Bounces";
  report.data = bounce_table(runs, measured.outcomes);
  report.sections.push_back(
      {"Time",
       {Paragraph{
            fmt::format("Pictures with {}. CPU seconds count the whole process, growth included; caches "
                        "of boxes and operators are warm.",
                        counted(samples, "sample"))},
        select(report.data, {"variant", "cpu_s", "of_one_bounce", "of_path"},
               "CPU time; relative to one bounce, and to path with as many bounces."),
        bounce_plot(runs)}});
  report.sections.push_back(
      {"Light",
       {select(
           report.data, {"variant", "light", "light_of_last_bounces", "light_off"},
           "Mean luminance of fur, relative to path with the most bounces; the part that came with the last "
           "bounces, those that the row above does not have; and the difference from path with as many "
           "bounces. The noise of two pictures is part of this difference.")}});
  report.sections.push_back(
      {"Reflection cache",
       {select(report.data, {"variant", "cells", "paths_per_cell", "lookups", "found", "cache_bytes"},
               "Cells of all sizes; paths in a cell, on average; paths that asked for the light of their "
               "third surface, and the fraction that was answered; memory.")}});
  return measured;
}

}  // namespace pelage
