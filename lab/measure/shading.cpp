// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "lab/measure/error_curve.h"
#include "lab/measure/experiments.h"
#include "lab/measure/shading_report.h"
#include "lab/measure/shading_runs.h"
#include "lab/runs/outcome_table.h"

namespace pelage {
namespace {

ErrorCurve curve_of(const ShadingRuns& all, size_t curve) {
  ErrorCurve points;
  for (const ShadingRun& run : all.runs) {
    // A second picture of another seed would count its number of samples twice.
    if (run.curve == curve && run.error && !run.second) points.emplace_back(run.cpu_s(), run.error->rel_mse);
  }
  return points;
}

class Columns {
 public:
  Columns(const ShadingRuns& all, const std::vector<Outcome>& outcomes, Table& table)
      : all_(all), outcomes_(outcomes), table_(table) {}

  template <class Value>
  void add(const std::string& key, const std::string& title, Quantity quantity, const Value& value) {
    add_column(table_, {key, title, quantity}, outcomes_, [&](const Outcome& o) -> Cell {
      return value(all_.runs[static_cast<size_t>(&o - outcomes_.data())]);
    });
  }
  /// A number of the run's error, or NaN.
  template <class Value>
  void add_error(const std::string& key, const std::string& title, const Value& value) {
    add(key, title, Quantity::kError,
        [&](const ShadingRun& run) { return run.error ? value(*run.error) : NAN; });
  }
  template <class Value>
  void add_reuse(const std::string& key, const std::string& title, const Value& value) {
    add(key, title, Quantity::kError,
        [&](const ShadingRun& run) { return run.reuse ? value(*run.reuse) : NAN; });
  }
  void add_number(const std::string& key, const std::string& title, const std::string& path) {
    add(key, title, Quantity::kCount, [&](const ShadingRun& run) { return run.outcome.number(path); });
  }

 private:
  const ShadingRuns& all_;
  const std::vector<Outcome>& outcomes_;
  Table& table_;
};

void add_errors(const ShadingRuns& all, Columns& columns) {
  columns.add("curve", "", Quantity::kRatio, [&](const ShadingRun& run) -> Cell {
    return Text{run.curve ? all.curves[*run.curve].title : ""};
  });
  columns.add("samples", "samples", Quantity::kRatio,
              [](const ShadingRun& run) { return run.outcome.number("samples_per_pixel"); });
  columns.add_error("rel_mse", "relMSE", [](const PictureError& e) { return e.rel_mse; });
  columns.add_error("rel_mse_deviation", "standard error",
                    [](const PictureError& e) { return e.rel_mse_deviation; });
  columns.add_error("block_rel_mse", "relMSE of 4 x 4",
                    [](const PictureError& e) { return e.block_rel_mse; });
  columns.add_error("bias", "mean off", [](const PictureError& e) { return e.bias; });
  columns.add_reuse("reuse_bias", "bias of reuse", [](const PictureError& e) { return e.rel_mse; });
  columns.add_reuse("reuse_bias_deviation", "its standard error",
                    [](const PictureError& e) { return e.rel_mse_deviation; });
  columns.add_reuse("reuse_mean", "mean of both off", [](const PictureError& e) { return e.bias; });
}

void add_work(Columns& columns) {
  for (const std::string kind : {"camera", "shadow", "indirect"})
    columns.add_number("rays_" + kind, kind + " rays", "rays." + kind);
  columns.add("candidates_proved", "candidates proved", Quantity::kRatio, [](const ShadingRun& run) {
    const double drawn = run.outcome.number("shadow_candidates");
    return drawn > 0 ? run.outcome.number("shadow_candidates_proved") / drawn : NAN;
  });
  columns.add_number("rays_proved", "rays proved", "rays_skipped_skin");
  columns.add_number("gather_points", "gather points", "gather_points");
  columns.add("samples_per_gather_point", "samples per gather point", Quantity::kRatio,
              [](const ShadingRun& run) {
                const double points = run.outcome.number("gather_points");
                return points > 0 ? run.outcome.number("gather_point_samples") / points : NAN;
              });
  for (const std::string key : {"reflection_cells", "reflection_paths", "reflection_lookups"}) {
    std::string title = key;
    std::replace(title.begin(), title.end(), '_', ' ');
    columns.add_number(key, title, key);
  }
  columns.add("reflections_found", "found", Quantity::kRatio, [](const ShadingRun& run) {
    const double lookups = run.outcome.number("reflection_lookups");
    return lookups > 0 ? run.outcome.number("reflections_found") / lookups : NAN;
  });
}

void add_times(const ShadingRuns& all, Columns& columns) {
  std::vector<ErrorCurve> curves;
  for (size_t i = 0; i < all.curves.size(); ++i) curves.push_back(curve_of(all, i));
  const auto add = [&](const std::string& key, const std::string& title, Quantity quantity,
                       const auto& value) {
    columns.add(key, title, quantity,
                [&](const ShadingRun& run) { return run.last ? value(curves[*run.curve]) : NAN; });
  };
  for (const int percent : kShadingTargets) {
    add(fmt::format("cpu_s_to_{}", percent), fmt::format("to {} %", percent), Quantity::kSeconds,
        [&](const ErrorCurve& curve) { return cpu_s_to(curve, percent / 100.0); });
  }
  for (const int percent : kShadingTargets) {
    add(fmt::format("gain_at_{}", percent), fmt::format("gain at {} %", percent), Quantity::kRatio,
        [&](const ErrorCurve& curve) {
          return cpu_s_to(curves.front(), percent / 100.0) / cpu_s_to(curve, percent / 100.0);
        });
  }
}

}  // namespace

Measured measure_shading(const SceneDescription& scene, const ShadingPlan& plan, const MeasureSetup& setup,
                         Progress& progress) {
  const ShadingRuns all = run_shading(scene, plan, setup, progress);
  Measured measured;
  for (const ShadingRun& run : all.runs) measured.outcomes.push_back(run.outcome);
  Report& report = measured.report;
  report.title = "Shading";
  report.data = outcome_table(measured.outcomes);
  Columns columns(all, measured.outcomes, report.data);
  add_errors(all, columns);
  add_work(columns);
  add_times(all, columns);
  add_shading_sections(all, plan, setup.folder, report);
  return measured;
}

}  // namespace pelage
