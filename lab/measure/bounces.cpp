// SPDX-License-Identifier: Apache-2.0
// Tested in tests/cli/measure_test.py.
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/counted.h"
#include "lab/measure/caches.h"
#include "lab/measure/experiments.h"
#include "lab/pictures/picture_error.h"
#include "lab/runs/outcome_table.h"

namespace pelage {
namespace {

constexpr int kBounces[] = {0, 1, 2, 4, 8, 16, 32, 64};

/// A way to follow light from surface to surface.
struct Method {
  const char* id;
  const char* title;
  std::vector<std::pair<const char*, const char*>> settings;
};
const std::vector<Method>& methods() {
  static const std::vector<Method> all{
      {"path", "path", {{"integrator", "path"}}},
      {"rays", "gather, cache: false", {{"integrator", "gather"}, {"gather.cache", "false"}}},
      {"cache", "gather, cache: true", {{"integrator", "gather"}, {"gather.cache", "true"}}}};
  return all;
}

struct Run {
  const Method* method = nullptr;  // null: the warm-up
  int bounces = 0;
  Outcome outcome;
  std::filesystem::path picture;
  double light = NAN;  // mean luminance of fur, relative to `path` with most bounces
};

class Sweep {
 public:
  Sweep(const SceneDescription& scene, int samples, const MeasureSetup& setup, Progress& progress)
      : samples_(samples),
        progress_(progress),
        caches_(CacheFolders(scene, setup.folder).arguments("warm")),
        runner_(setup, progress, 1 + methods().size() * std::size(kBounces)) {}

  void run() {
    render(methods().front(), kBounces[0], true);
    if (!runs.back().outcome.succeeded()) return;
    runs.back().method = nullptr;
    // All methods with few bounces first: if the speed of the machine changes, it does so for all.
    for (const int bounces : kBounces) {
      for (const Method& method : methods()) {
        if (progress_.cancelled()) return;
        render(method, bounces, false);
      }
    }
    compare();
  }

  std::vector<Run> runs;

 private:
  void render(const Method& method, int bounces, bool once) {
    Variant variant{fmt::format("{}-{}", method.id, bounces),
                    fmt::format("{}, {}", method.title, counted(bounces, "bounce")), "render", caches_, once};
    if (once) variant.id = variant.title = "warm-up";
    const auto set = [&](const std::string& key, const std::string& value) {
      variant.arguments.insert(variant.arguments.end(), {"--set", "render." + key + "=" + value});
    };
    for (const auto& [key, value] : method.settings) set(key, value);
    set("bounces", std::to_string(bounces));
    set("samples", std::to_string(samples_));
    Outcome outcome = runner_.run(variant);
    runs.push_back({&method, bounces, std::move(outcome), runner_.picture(variant)});
  }

  void compare() {
    const Run* most = nullptr;
    for (const Run& run : runs) {
      if (run.method == &methods().front() && run.outcome.succeeded()) most = &run;
    }
    for (Run& run : runs) {
      if (!most || !run.outcome.succeeded()) continue;
      const auto error = picture_error_of_files(run.picture, most->picture, most->picture, ErrorRegion::kFur);
      if (error) run.light = 1 + error->bias;
    }
  }

  int samples_;
  Progress& progress_;
  std::vector<std::string> caches_;
  VariantRunner runner_;
};

/// The run of a method with this count of bounces; null if there is none.
const Run* find(const std::vector<Run>& runs, const Method* method, int bounces) {
  for (const Run& run : runs) {
    if (run.method == method && run.bounces == bounces) return &run;
  }
  return nullptr;
}

double light_of_last_bounces(const std::vector<Run>& runs, const Run& run) {
  const Run* before = nullptr;
  for (const int bounces : kBounces) {
    if (bounces < run.bounces) before = find(runs, run.method, bounces);
  }
  return before ? run.light - before->light : run.light;
}

Table bounce_table(const std::vector<Run>& runs, const std::vector<Outcome>& outcomes) {
  Table table = outcome_table(outcomes);
  const auto add = [&](const char* key, const char* title, Quantity quantity, const auto& value) {
    add_column(table, {key, title, quantity}, outcomes, [&](const Outcome& o) -> Cell {
      const Run& run = runs[static_cast<size_t>(&o - outcomes.data())];
      return run.method ? value(run) : NAN;
    });
  };
  const auto cpu_s = [](const Run* run) { return run ? run->outcome.number("cpu_s") : NAN; };
  add("bounces", "bounces", Quantity::kCount, [](const Run& run) { return double(run.bounces); });
  add("of_one_bounce", "of one bounce", Quantity::kRatio,
      [&](const Run& run) { return cpu_s(&run) / cpu_s(find(runs, run.method, 1)); });
  add("of_path", "of path", Quantity::kRatio,
      [&](const Run& run) { return cpu_s(&run) / cpu_s(find(runs, &methods().front(), run.bounces)); });
  add("light", "light", Quantity::kRatio, [](const Run& run) { return run.light; });
  add("light_of_last_bounces", "of it, by the last bounces", Quantity::kRatio,
      [&](const Run& run) { return light_of_last_bounces(runs, run); });
  add("light_off", "off path", Quantity::kError, [&](const Run& run) {
    const Run* path = find(runs, &methods().front(), run.bounces);
    return path ? run.light / path->light - 1 : NAN;
  });
  const auto number = [](const Run& run, const char* key) { return run.outcome.number(key); };
  add("cells", "cells", Quantity::kCount, [&](const Run& run) { return number(run, "reflection_cells"); });
  add("paths_per_cell", "paths per cell", Quantity::kRatio, [&](const Run& run) {
    // Each path is in a cell of each size.
    return 3 * number(run, "reflection_paths") / number(run, "reflection_cells");
  });
  add("lookups", "lookups", Quantity::kCount,
      [&](const Run& run) { return number(run, "reflection_lookups"); });
  add("found", "found", Quantity::kRatio,
      [&](const Run& run) { return number(run, "reflections_found") / number(run, "reflection_lookups"); });
  add("cache_bytes", "cache, while filled", Quantity::kBytes,
      [&](const Run& run) { return number(run, "memory_bytes.reflection_cache"); });
  return table;
}

LinePlot bounce_plot(const std::vector<Run>& runs) {
  LinePlot plot;
  plot.caption = "CPU seconds by bounces.";
  plot.x = {"bounces + 1", Quantity::kCount, true};
  plot.y = {"CPU time", Quantity::kSeconds};
  plot.markers = true;
  for (const Method& method : methods()) {
    Series line{method.title, {}};
    for (const Run& run : runs) {
      if (run.method == &method && run.outcome.succeeded())
        line.points.emplace_back(run.bounces + 1, run.outcome.number("cpu_s"));
    }
    plot.lines.push_back(std::move(line));
  }
  return plot;
}

}  // namespace

Measured measure_bounces(const SceneDescription& scene, int samples, const MeasureSetup& setup,
                         Progress& progress) {
  Sweep sweep(scene, samples, setup, progress);
  sweep.run();
  Measured measured;
  for (const Run& run : sweep.runs) measured.outcomes.push_back(run.outcome);
  Report& report = measured.report;
  report.title = "Bounces";
  report.data = bounce_table(sweep.runs, measured.outcomes);
  report.sections.push_back(
      {"Time",
       {Paragraph{
            fmt::format("Pictures with {}. CPU seconds count the whole process, growth included; caches "
                        "of boxes and operators are warm.",
                        counted(samples, "sample"))},
        select(report.data, {"variant", "cpu_s", "of_one_bounce", "of_path"},
               "CPU time; relative to one bounce, and to path with as many bounces."),
        bounce_plot(sweep.runs)}});
  report.sections.push_back(
      {"Light",
       {select(report.data, {"variant", "light", "light_of_last_bounces", "light_off"},
               "Mean luminance of fur, relative to path with most bounces; the part that came with the last "
               "bounces, those that the row above does not have; and the difference from path with as many "
               "bounces. The noise of two pictures is part of this difference.")}});
  report.sections.push_back(
      {"Reflection cache",
       {select(report.data, {"variant", "cells", "paths_per_cell", "lookups", "found", "cache_bytes"},
               "Cells of all sizes; paths in a cell, on average; paths that asked for the light of their "
               "second surface, and the fraction that was answered; memory.")}});
  return measured;
}

}  // namespace pelage
