// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/shading_report.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "base/counted.h"
#include "base/file.h"
#include "lab/pictures/picture_difference.h"
#include "lab/pictures/scaled_difference.h"
#include "lab/report/png.h"
#include "lab/runs/outcome_table.h"

namespace pelage {
namespace {

constexpr double kFactor = 10;
constexpr int kMaxWidth = 960;

using Wanted = std::function<bool(const ShadingRun&)>;

/// The columns with these keys, of some of the runs.
Table table_of(const ShadingRuns& all, const Report& report, const Wanted& wanted,
               const std::vector<std::string>& keys, const std::string& caption) {
  Table table = select(report.data, keys, caption);
  std::vector<std::vector<Cell>> rows;
  for (size_t i = 0; i < all.runs.size(); ++i) {
    if (wanted(all.runs[i])) rows.push_back(std::move(table.rows[i]));
  }
  table.rows = std::move(rows);
  return table;
}

LinePlot plot_of(const ShadingRuns& all, double PictureError::*error, const std::string& label,
                 const std::string& caption) {
  LinePlot plot;
  plot.caption = caption;
  plot.x = {"CPU time", Quantity::kSeconds, true};
  plot.y = {label, Quantity::kError, true};
  plot.markers = true;
  for (size_t i = 0; i < all.curves.size(); ++i) {
    Series line{all.curves[i].title, {}};
    for (const ShadingRun& run : all.runs) {
      if (run.curve == i && run.error && !run.extra)
        line.points.emplace_back(run.cpu_s(), (*run.error).*error);
    }
    std::sort(line.points.begin(), line.points.end());
    plot.lines.push_back(std::move(line));
  }
  return plot;
}

/// What the row of `gather` with most samples says of times and errors; empty without this row.
std::string gain_text(const ShadingRuns& all, const Report& report) {
  const auto gather = std::find_if(all.runs.begin(), all.runs.end(), [&](const ShadingRun& run) {
    return run.last && all.curves[*run.curve].id == "gather";
  });
  if (gather == all.runs.end()) return "";
  const auto number = [&](const std::string& key) {
    return column_values(report.data, key)[static_cast<size_t>(gather - all.runs.begin())];
  };
  std::string text;
  for (const int percent : kShadingTargets) {
    const double gain = number(fmt::format("gain_at_{}", percent)),
                 seconds = number(fmt::format("cpu_s_to_{}", percent));
    if (!std::isfinite(gain)) continue;
    text += fmt::format(
        "gather reaches {} % relMSE on fur after {:.2f} CPU seconds, path after {:.2f}: gain {:.2f}. ",
        percent, seconds, gain * seconds, gain);
  }
  if (text.empty())
    text = "With these sample counts, path and gather reach no common relMSE of 5, 2 or 1 %. ";
  const double pixels = number("equal_gain"), of_4 = number("equal_gain_4"), of_16 = number("equal_gain_16");
  if (std::isfinite(pixels + of_4 + of_16))
    text += fmt::format(
        "After {:.2f} CPU seconds each, the relMSE of path divided by that of gather is {:.2f} for pixels, "
        "{:.2f} for means of 4 x 4 pixels and {:.2f} for means of 16 x 16 pixels. ",
        number("equal_cpu_s"), pixels, of_4, of_16);
  if (const double error = number("systematic_8"); std::isfinite(error))
    text +=
        fmt::format("Two seeds of gather share an error of {:.2f} % in means of 8 x 8 pixels. ", 100 * error);
  text.pop_back();
  return text;
}

std::string method_text(const ShadingPlan& plan, const std::string& same_as_gather) {
  std::string text = fmt::format(
      "The references a and b are two splatted pictures of path with {}. Every picture has a seed of its "
      "own. relMSE of a picture x is the mean over pixels with fur (squared length of the layer tangent "
      "above 0.05 in both references) and channels of (x - a)(x - b) / (t^2 + 0.01 m^2), where t is the mean "
      "of (a + b) / 2 over 9 x 9 pixels and m the mean of t; the noise of the references cancels. relMSE of "
      "4 x 4 and of 16 x 16 is the same of means of so many pixels, with t over 3 x 3 means. The 99.9th "
      "percentile is the relative error that one pixel of fur in a thousand exceeds. Mean off is the error "
      "of the mean luminance of fur. CPU seconds count the whole process, growth included; caches of boxes "
      "and operators are warm. Where sampling is adaptive, its noise budget is the noise of path with the "
      "stated number of samples, and a pixel may get 16 times as many.",
      counted(plan.reference_samples, "sample"));
  if (!same_as_gather.empty())
    text += fmt::format(" {} is left out: in this scene, gather does exactly that.", same_as_gather);
  return text;
}

/// A reference, gather, and the differences of all variants of gather.
Section pictures_of(const ShadingRuns& all, const std::filesystem::path& folder) {
  Section section{
      "Differences, times ten",
      {Paragraph{"The mean of two pictures of the variant, with most samples and other seeds, minus the "
                 "mean of both references, times ten: grey where they are equal, light where the variant "
                 "is brighter. Path has only noise."}}};
  const auto add = [&](std::optional<Picture> picture) {
    if (!picture) return;
    picture->half = true;
    section.blocks.emplace_back(std::move(*picture));
  };
  if (all.references.size() < 2) return section;
  add(screen_picture_of(all.references.front(), kMaxWidth, "A reference."));
  for (const ShadingRun& run : all.runs) {
    if (!run.last || !run.outcome.succeeded()) continue;
    const ShadingCurve& curve = all.curves[*run.curve];
    if (!curve.gather && curve.id != "path") continue;
    if (curve.id == "gather") add(screen_picture_of(run.picture, kMaxWidth, run.outcome.variant.title + "."));
    std::vector<std::filesystem::path> pictures{run.picture};
    if (run.shared) pictures.push_back(run.other);
    auto difference = scaled_difference_of_files(pictures, all.references, kFactor,
                                                 run.outcome.variant.title + ", times ten.");
    if (difference)
      write_file(folder / fmt::format("difference-{}.png", curve.id), png_bytes(*difference),
                 Links::kReplace);
    add(std::move(difference));
  }
  return section;
}

/// The columns of the report with these keys, of some of the runs.
using Tables = std::function<Table(const Wanted&, const std::vector<std::string>&, const char* caption)>;

void add_time_sections(const ShadingRuns& all, const Tables& table, Report& report) {
  const Wanted is_last = [](const ShadingRun& run) { return run.last; };
  report.sections.push_back(
      {"Time to an error",
       {table(is_last,
              {"curve", "cpu_s_to_5", "cpu_s_to_2", "cpu_s_to_1", "gain_at_5", "gain_at_2", "gain_at_1"},
              "CPU seconds to 5, 2 and 1 % relMSE, interpolated between the runs in logarithms of both; "
              "nothing is extrapolated. Gain: the time of path, divided by the time of the variant."),
        plot_of(all, &PictureError::rel_mse, "relMSE", "Error of pixels with fur over CPU time."),
        plot_of(all, &PictureError::rel_mse_4, "relMSE of 4 x 4",
                "Error of means of 4 x 4 pixels over CPU time."),
        plot_of(all, &PictureError::rel_mse_16, "relMSE of 16 x 16",
                "Error of means of 16 x 16 pixels over CPU time.")}});
  report.sections.push_back(
      {"At equal CPU time",
       {table(
           is_last, {"curve", "equal_cpu_s", "equal_gain", "equal_gain_4", "equal_gain_16"},
           "relMSE of path, divided by relMSE of the variant after the same CPU time: the largest time that "
           "both have reached. Both are interpolated between the runs. A ratio below 1 is a loss.")}});
}

void add_shared_sections(const ShadingRuns& all, const Tables& table, Report& report) {
  const Wanted is_shared = [](const ShadingRun& run) { return run.shared.has_value(); };
  const Wanted has_flicker = [](const ShadingRun& run) { return std::isfinite(run.flicker); };
  if (std::any_of(all.runs.begin(), all.runs.end(), is_shared)) {
    report.sections.push_back(
        {"Systematic error",
         {table(is_shared, {"variant", "systematic_8", "worst_8", "systematic_32", "worst_32"},
                "The error of means of 8 x 8 and 32 x 32 pixels that two pictures x and y with other seeds "
                "share: the root of the mean of (x - a)(y - b) / (t^2 + 0.01 m^2), and the error of the "
                "worst block. Noise does not count. The row of path has no such error and shows the "
                "uncertainty of these estimates."),
          table(is_shared, {"variant", "reuse_bias", "reuse_bias_deviation", "reuse_mean"},
                "The part of relMSE of pixels that is no noise, for the same x and y. Its root is a relative "
                "error. Mean of both off: error of the mean luminance of fur.")}});
  }
  if (std::any_of(all.runs.begin(), all.runs.end(), has_flicker)) {
    report.sections.push_back(
        {"Flicker",
         {table(
             has_flicker, {"variant", "samples", "flicker"},
             "Change of means of 8 x 8 pixels from one frame to the next that is not in the references, "
             "relative to the picture (root mean square), over 8 frames. In each frame, the camera moves by "
             "one pixel.")}});
  }
}

}  // namespace

void add_shading_sections(const ShadingRuns& all, const ShadingPlan& plan,
                          const std::filesystem::path& folder, Report& report) {
  const Tables table = [&](const Wanted& wanted, const std::vector<std::string>& keys, const char* caption) {
    return table_of(all, report, wanted, keys, caption);
  };
  const Wanted is_measured = [](const ShadingRun& run) { return run.error.has_value(); };
  report.abstract = gain_text(all, report);
  report.sections.push_back({"Method", {Paragraph{method_text(plan, all.same_as_gather)}}});
  add_time_sections(all, table, report);
  add_shared_sections(all, table, report);
  report.sections.push_back({"Runs",
                             {table(is_measured,
                                    {"variant", "samples", "cpu_s", "cpu_least_s", "cpu_most_s", "rel_mse",
                                     "rel_mse_deviation", "rel_mse_4", "rel_mse_16", "top_error", "bias"},
                                    "Error of each picture.")}});
  std::vector<std::string> work{
      "variant", "cpu_s", "rays_camera", "rays_shadow", "rays_indirect", "candidates_proved", "rays_proved"};
  for (const std::string& key : keys_with(report.data, "cpu_")) {
    if (key.ends_with("_s") && key != "cpu_s" && key != "cpu_least_s" && key != "cpu_most_s")
      work.push_back(key);
  }
  work.insert(work.end(),
              {"gather_points", "samples_per_gather_point", "reflection_cells", "reflection_paths",
               "reflection_lookups", "reflections_found", "peak_rss_bytes", "peak_anonymous_bytes"});
  report.sections.push_back(
      {"Rays, gather points and memory", {table(is_measured, work, "Work of each run.")}});
  report.sections.push_back(pictures_of(all, folder));
}

}  // namespace pelage
