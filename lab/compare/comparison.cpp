// SPDX-License-Identifier: Apache-2.0
#include "lab/compare/comparison.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/counted.h"
#include "lab/compare/contact_sheet.h"

namespace pelage {
namespace {

/// CPU seconds at which all frames of one light are compared: the median of their times.
std::map<std::string, double> equal_times(const std::vector<ComparedFrame>& frames) {
  std::map<std::string, std::vector<double>> seconds;
  for (const ComparedFrame& frame : frames) seconds[frame.light].push_back(frame.cpu_s);
  std::map<std::string, double> medians;
  for (auto& [light, all] : seconds) {
    std::sort(all.begin(), all.end());
    medians[light] = all[all.size() / 2];
  }
  return medians;
}

Table frame_table(const std::vector<ComparedFrame>& frames) {
  Table table;
  table.columns = {{"model", "model"},
                   {"light", "light"},
                   {"cpu_s", "CPU time", Quantity::kSeconds},
                   {"cpu_spread", "halves differ by", Quantity::kPercent},
                   {"wall_s", "wall time", Quantity::kSeconds},
                   {"rays", "rays", Quantity::kCount},
                   {"rays_per_cpu_s", "rays per CPU second", Quantity::kRate},
                   {"relmse", "noise (relMSE)", Quantity::kRatio},
                   {"relmse_equal_time", "noise at equal time", Quantity::kRatio},
                   {"luminance", "mean luminance of fur", Quantity::kRatio},
                   {"luminance_to_chiang", "of that of chiang", Quantity::kRatio},
                   {"fur_share", "pixels of fur", Quantity::kPercent}};
  std::map<std::string, double> chiang;
  for (const ComparedFrame& frame : frames) {
    if (frame.model == "chiang") chiang[frame.light] = frame.luminance;
  }
  const std::map<std::string, double> times = equal_times(frames);
  for (const ComparedFrame& f : frames) {
    const auto reference = chiang.find(f.light);
    table.rows.push_back({Text{f.model}, Text{f.light}, f.cpu_s, f.cpu_spread, f.wall_s, f.rays,
                          f.rays / f.cpu_s, f.noise, f.noise * f.cpu_s / times.at(f.light), f.luminance,
                          reference == chiang.end() ? NAN : f.luminance / reference->second, f.fur_share});
  }
  return table;
}

Table energy_table(const Comparison& comparison) {
  Table table;
  table.caption =
      "Energy. A fibre that absorbs nothing scatters all the light it receives (energy 1), and a white coat "
      "is invisible in a white furnace. Distances are total variations from the traced light: 0 means the "
      "same distribution, 1 means no overlap.";
  table.columns = {{"model", "model"},
                   {"white_across", "white fibre, light across it", Quantity::kRatio},
                   {"white_slanted", "light at 57 degrees", Quantity::kRatio},
                   {"furnace", "white coat in a furnace", Quantity::kRatio},
                   {"energy", "energy of the fibre", Quantity::kRatio},
                   {"traced", "traced", Quantity::kRatio},
                   {"azimuth_distance", "distance around the fibre", Quantity::kRatio},
                   {"inclination_distance", "distance along it", Quantity::kRatio}};
  for (const SingleFibre& f : comparison.fibres) {
    const auto furnace = comparison.furnace.find(f.model);
    table.rows.push_back({Text{f.model}, f.white_across, f.white_slanted,
                          furnace == comparison.furnace.end() ? NAN : furnace->second, f.by_model.total(),
                          f.traced.total(), f.azimuth_distance(), f.inclination_distance()});
  }
  return table;
}

BarPlot bars(const std::vector<ComparedFrame>& frames, const char* label, Quantity quantity,
             const std::string& caption, double (*value)(const ComparedFrame&)) {
  BarPlot plot;
  plot.caption = caption;
  plot.value = {label, quantity};
  plot.half = true;
  for (const ComparedFrame& frame : frames) {
    if (std::find(plot.groups.begin(), plot.groups.end(), frame.model) == plot.groups.end())
      plot.groups.push_back(frame.model);
  }
  for (const ComparedFrame& frame : frames) {
    auto series = std::find_if(plot.series.begin(), plot.series.end(),
                               [&](const auto& s) { return s.name == frame.light; });
    if (series == plot.series.end()) {
      plot.series.push_back({frame.light, std::vector<double>(plot.groups.size(), NAN)});
      series = plot.series.end() - 1;
    }
    const auto group = std::find(plot.groups.begin(), plot.groups.end(), frame.model) - plot.groups.begin();
    series->values[static_cast<size_t>(group)] = value(frame);
  }
  return plot;
}

/// "darkest, 0.91 times as bright as that of chiang", without the ratio for chiang itself.
std::string extreme_text(const char* what, const ComparedFrame& frame, const ComparedFrame& chiang) {
  if (frame.model == chiang.model) return what;
  return fmt::format("{}, {:.2f} times as bright as that of {}", what, frame.luminance / chiang.luminance,
                     chiang.model);
}

std::string findings(const Comparison& comparison) {
  std::set<std::string> models;
  for (const ComparedFrame& f : comparison.frames) models.insert(f.model);
  std::string text = fmt::format("{} of {}.", counted(std::ssize(comparison.frames), "picture"),
                                 counted(std::ssize(models), "model"));
  const auto chiang = std::find_if(comparison.frames.begin(), comparison.frames.end(),
                                   [](const ComparedFrame& f) { return f.model == "chiang"; });
  if (chiang == comparison.frames.end() || models.size() < 2) return text;
  const ComparedFrame *darkest = &*chiang, *brightest = &*chiang;
  for (const ComparedFrame& f : comparison.frames) {
    if (f.light != chiang->light) continue;
    if (f.luminance < darkest->luminance) darkest = &f;
    if (f.luminance > brightest->luminance) brightest = &f;
  }
  if (darkest == brightest) return text;
  return text + fmt::format(" In light from the {} the fur of {} is the {}; that of {} is the {}.",
                            chiang->light, darkest->model, extreme_text("darkest", *darkest, *chiang),
                            brightest->model, extreme_text("brightest", *brightest, *chiang));
}

}  // namespace

Report comparison_report(const Comparison& comparison, const SceneDescription& scene) {
  Report report;
  report.experiment = "compare";
  report.title = "Fibre models side by side";
  report.abstract = findings(comparison);
  report.data = frame_table(comparison.frames);

  Picture sheet = contact_sheet(comparison.frames);
  sheet.caption = "Every model under every light; contact_sheet.png has the pictures without labels.";
  Table frames = report.data;
  frames.caption =
      "Cost, noise and brightness. Noise at equal time is the noise after as many CPU seconds as the median "
      "model took under that light.";
  report.sections.push_back({"Pictures", {sheet}});
  report.sections.push_back(
      {"Cost, noise, brightness",
       {frames,
        bars(comparison.frames, "CPU time", Quantity::kSeconds, "CPU time.",
             [](const ComparedFrame& f) { return f.cpu_s; }),
        bars(comparison.frames, "mean luminance", Quantity::kRatio, "Mean luminance of fur.",
             [](const ComparedFrame& f) { return f.luminance; })}});
  if (!comparison.fibres.empty()) {
    Picture fibres = single_fibre_sheet(comparison.fibres);
    fibres.caption = fmt::format(
        "One fibre, lit from {:.0f} degrees off its normal plane, evenly over its width. Left: where the "
        "model scatters light, with sin(theta_i) upward and azimuth to the right; colours cover four "
        "decades. Middle: light traced by brute force through the same fibre (absorption {:.1f} per radius), "
        "blurred by the roughness of the model. Right: both around the fibre, as square roots of the energy; "
        "the light comes from the right. Cuticle tilts are left out. Opaque models are compared with a clear "
        "fibre of the same energy.",
        SingleFibre::kInclination * 180 / 3.14159265, SingleFibre::kAbsorption);
    report.sections.push_back({"Single fibres", {energy_table(comparison), fibres}});
  }
  report.sections.push_back(
      {"Method",
       {Paragraph{fmt::format(
            "One lamp and a fill replace the lights of the scene. The lamp shines from the front, the side "
            "or behind. It is as far from the camera's target as the camera is, and 16 degrees wide; the "
            "fill has a fiftieth of the radiance of a white wall. Each model in turn replaces every strand "
            "material, with its default parameters and the colour and opacity of that material; a material "
            "that is already of this model stays unchanged. {} samples per pixel, {} bounces.",
            scene.render.samples, scene.render.bounces)},
        Paragraph{"Each picture is rendered in two halves with different seeds. A quarter of their squared "
                  "difference is the variance of their mean; relMSE is the mean over fur of this variance "
                  "divided by (squared radiance + 0.01 of the squared mean radiance). Times include growing "
                  "the fur, which all models share, but not making tables."},
        Paragraph{"In the furnace everything is white and the sky is 1 everywhere, with a thousand bounces. "
                  "A deviation from 1 is energy that the model loses or adds, apart from noise of a few "
                  "thousandths."}}});
  return report;
}

std::string fibres_json(const std::vector<SingleFibre>& fibres) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const SingleFibre& f : fibres) {
    all.push_back({{"model", f.model},
                   {"energy", f.by_model.total()},
                   {"traced_energy", f.traced.total()},
                   {"by_azimuth", f.by_model.by_azimuth()},
                   {"traced_by_azimuth", f.traced.by_azimuth()},
                   {"by_sine", f.by_model.by_sine()},
                   {"traced_by_sine", f.traced.by_sine()}});
  }
  return all.dump(1);
}

}  // namespace pelage
