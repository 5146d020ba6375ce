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

/// An error of a picture, and the end of the keys of its columns.
struct ErrorScale {
  double PictureError::*error;
  std::string suffix, title;
};
const std::vector<ErrorScale>& error_scales() {
  static const std::vector<ErrorScale> all{{&PictureError::rel_mse, "", "of pixels"},
                                           {&PictureError::rel_mse_4, "_4", "of 4 x 4"},
                                           {&PictureError::rel_mse_16, "_16", "of 16 x 16"}};
  return all;
}

ErrorCurve curve_of(const ShadingRuns& all, size_t curve, double PictureError::*error) {
  ErrorCurve points;
  for (const ShadingRun& run : all.runs) {
    // A second picture of another seed would count its number of samples twice.
    if (run.curve == curve && run.error && !run.extra) points.emplace_back(run.cpu_s(), (*run.error).*error);
  }
  return points;
}

/// The largest CPU time that pictures of both curves reach.
double common_cpu_s(const ErrorCurve& a, const ErrorCurve& b) {
  if (a.empty() || b.empty()) return NAN;
  return std::min(std::max_element(a.begin(), a.end())->first, std::max_element(b.begin(), b.end())->first);
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
  /// A number of the error that two seeds share, or NaN.
  template <class Value>
  void add_shared(const std::string& key, const std::string& title, const Value& value) {
    add(key, title, Quantity::kError,
        [&](const ShadingRun& run) { return run.shared ? value(*run.shared) : NAN; });
  }
  template <class Value>
  void add_systematic(const std::string& key, const std::string& title, const Value& value) {
    add(key, title, Quantity::kError,
        [&](const ShadingRun& run) { return run.systematic ? value(*run.systematic) : NAN; });
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
  columns.add_error("rel_mse_4", "relMSE of 4 x 4", [](const PictureError& e) { return e.rel_mse_4; });
  columns.add_error("rel_mse_16", "relMSE of 16 x 16", [](const PictureError& e) { return e.rel_mse_16; });
  columns.add_error("top_error", "99.9th percentile", [](const PictureError& e) { return e.top_error; });
  columns.add_error("bias", "mean off", [](const PictureError& e) { return e.bias; });
  columns.add_systematic("systematic_8", "systematic error of 8 x 8",
                         [](const SystematicError& e) { return e.of_8.rms; });
  columns.add_systematic("worst_8", "worst 8 x 8", [](const SystematicError& e) { return e.of_8.worst; });
  columns.add_systematic("systematic_32", "systematic error of 32 x 32",
                         [](const SystematicError& e) { return e.of_32.rms; });
  columns.add_systematic("worst_32", "worst 32 x 32", [](const SystematicError& e) { return e.of_32.worst; });
  columns.add("flicker", "flicker", Quantity::kError, [](const ShadingRun& run) { return run.flicker; });
  columns.add_shared("reuse_bias", "bias of reuse", [](const PictureError& e) { return e.rel_mse; });
  columns.add_shared("reuse_bias_deviation", "its standard error",
                     [](const PictureError& e) { return e.rel_mse_deviation; });
  columns.add_shared("reuse_mean", "mean of both off", [](const PictureError& e) { return e.bias; });
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
  for (size_t i = 0; i < all.curves.size(); ++i) curves.push_back(curve_of(all, i, &PictureError::rel_mse));
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

/// Errors of `path`, divided by those of each curve after the same CPU time.
void add_equal_times(const ShadingRuns& all, Columns& columns) {
  const auto add = [&](const std::string& key, const std::string& title, Quantity quantity,
                       double PictureError::*error, const auto& value) {
    columns.add(key, title, quantity, [&](const ShadingRun& run) {
      return run.last ? value(curve_of(all, 0, error), curve_of(all, *run.curve, error)) : NAN;
    });
  };
  add("equal_cpu_s", "CPU time", Quantity::kSeconds, &PictureError::rel_mse, common_cpu_s);
  for (const ErrorScale& scale : error_scales()) {
    add("equal_gain" + scale.suffix, scale.title, Quantity::kRatio, scale.error,
        [](const ErrorCurve& path, const ErrorCurve& curve) {
          const double cpu_s = common_cpu_s(path, curve);
          return error_after(path, cpu_s) / error_after(curve, cpu_s);
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
  add_equal_times(all, columns);
  add_shading_sections(all, plan, setup.folder, report);
  return measured;
}

}  // namespace pelage
