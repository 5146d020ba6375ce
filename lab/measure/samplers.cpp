// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "image/exr.h"
#include "lab/measure/experiments.h"
#include "lab/measure/sampler_variance.h"
#include "lab/measure/scene_techniques.h"
#include "lab/pictures/picture_difference.h"
#include "lab/pictures/picture_error.h"
#include "lab/runs/outcome_table.h"

namespace pelage {
namespace {

// Fractions of render.samples, the max per pixel.
constexpr int kPlainShares[] = {16, 4};
constexpr int kReferenceFactor = 2;

void set_value(Variant& variant, const std::string& key, const std::string& value) {
  variant.arguments.insert(variant.arguments.end(), {"--set", key + "=" + value});
}

/// Each variant has another seed, so that no two pictures share noise.
Variant sampler_variant(const std::string& id, const std::string& title, int samples, size_t seed) {
  Variant variant{id, title, "render", {}};
  set_value(variant, "render.samples", std::to_string(samples));
  set_value(variant, "render.seed", std::to_string(1000 + seed));
  set_value(variant, "render.indirect", "path");
  set_value(variant, "render.integrator", "path");
  set_value(variant, "image.noise_layers", "true");
  set_value(variant, "image.light_layers", "false");
  return variant;
}

struct SamplerRow {
  int plain = 0;        // samples of the uniform picture that it is compared with; 0: a reference
  size_t plain_at = 0;  // its index
  PictureError error;
  bool known = false;
};

class SamplerSweep {
 public:
  /// `magnets`: whether the scene has some; then it is also rendered without them.
  SamplerSweep(int max, bool magnets, const MeasureSetup& setup, Progress& progress)
      : max_(max),
        magnets_(magnets),
        progress_(progress),
        runner_(setup, progress, 2 + (magnets ? 7 : 5) * std::size(kPlainShares)) {}

  void run() {
    for (const char* id : {"reference-a", "reference-b"}) {
      Variant reference = sampler_variant(id, id, kReferenceFactor * max_, outcomes.size());
      reference.once = true;
      if (!add(reference, 0, 0)) return;
    }
    best = best_gain(read_exr(runner_.picture(outcomes[0].variant)));
    for (const int share : kPlainShares) {
      const int samples = std::max(1, max_ / share);
      const size_t plain = outcomes.size();
      if (!add(sampler_variant(fmt::format("plain-{}", samples), fmt::format("plain, {}", samples), samples,
                               plain),
               samples, plain))
        return;
      // The noise of uniform sampling is the noise budget of the others.
      const std::string noise = fmt::format("{:g}", outcomes[plain].number("noise"));
      const auto adaptive = [&](const char* goal) {
        Variant variant =
            sampler_variant(fmt::format("{}-{}", goal, samples),
                            fmt::format("adaptive, {}, {}", goal, samples), max_, outcomes.size());
        set_value(variant, "render.adaptive.goal", goal);
        set_value(variant, "render.adaptive.noise", noise);
        return add(variant, samples, plain);
      };
      if (!adaptive("frame") || !adaptive("pixel")) return;
      const auto gather = [&](const char* id, const char* title, const char* reject) {
        Variant variant = sampler_variant(fmt::format("{}-{}", id, samples),
                                          fmt::format("{}, {}", title, samples), samples, outcomes.size());
        set_value(variant, "render.integrator", "gather");
        set_value(variant, "render.gather.reject", reject);
        set_value(variant, "image.noise_layers", "false");
        return add(variant, samples, plain);
      };
      if (!gather("gather", "gather", "false") || !gather("reject", "gather, rejecting", "true")) return;
      if (magnets_ &&
          (!without_magnets("path", samples, plain) || !without_magnets("gather", samples, plain)))
        return;
    }
  }

  std::vector<Outcome> outcomes;
  std::vector<SamplerRow> rows;
  BestGain best{NAN, NAN};
  const VariantRunner& runner() const { return runner_; }

 private:
  bool without_magnets(const std::string& integrator, int samples, size_t plain) {
    Variant variant =
        sampler_variant(fmt::format("{}-without-magnets-{}", integrator, samples),
                        fmt::format("{} without magnets, {}", integrator, samples), samples, outcomes.size());
    set_value(variant, "render.integrator", integrator);
    set_value(variant, "magnets", "{}");
    set_value(variant, "image.noise_layers", "false");
    return add(variant, samples, plain);
  }
  bool add(const Variant& variant, int plain, size_t plain_at) {
    outcomes.push_back(runner_.run(variant));
    SamplerRow row{plain, plain_at, {}, false};
    if (plain > 0 && outcomes.back().succeeded()) {
      const auto error =
          picture_error_of_files(runner_.picture(variant), runner_.picture(outcomes[0].variant),
                                 runner_.picture(outcomes[1].variant), ErrorRegion::kSurfaces);
      row.known = error.has_value();
      row.error = error.value_or(PictureError{});
      if (std::isnan(row.error.samples)) row.error.samples = row.error.region_samples = plain;  // gather
    }
    rows.push_back(row);
    return outcomes.back().succeeded() && !progress_.cancelled();
  }

  int max_;
  bool magnets_;
  Progress& progress_;
  VariantRunner runner_;
};

/// Uniform samples per pixel that would have the error of this row, relative to its samples.
double gain_of(const std::vector<SamplerRow>& rows, const SamplerRow& row, double samples) {
  const SamplerRow& plain = rows[row.plain_at];
  if (!row.known || !plain.known) return NAN;
  return plain.plain * plain.error.rel_mse / row.error.rel_mse / samples;
}

/// Adds the variances of samplers and techniques, which are computed here instead of in runs of the program.
void add_techniques(const SceneDescription& scene, Report& report, Progress& progress) {
  report.sections.push_back(
      {"Samplers of the cone shell",
       {Paragraph{
            "One fibre of the model cone-shell (variant wigner, seen at 30 degrees), lit by an even light of "
            "the "
            "given half angle around the mirror direction. Wigner: the semicircle, which is proportional to "
            "the "
            "shell. Tent: the piecewise-linear density that it replaced in the film; its knots were not "
            "published, this one is fitted to the semicircle. Uniform: in solid angle between the cones. "
            "MIS: "
            "one sample of the light and one of the shell, by the power heuristic; their two rays count."},
        integrand_variances()}});
  if (progress.cancelled()) return;
  MemoryLedger ledger;
  const Workers workers;
  report.sections.push_back(
      {"Techniques that find light",
       {Paragraph{
            "The scene by `path` with one technique at a time, with at most 32 samples. Rays per sample are "
            "shadow and indirect rays of the samples that see a surface. Variance x rays says how many rays "
            "a "
            "technique needs for the same error. Techniques alone find less light where they cannot find all "
            "of it: see the means."},
        scene_techniques(scene, {workers, ledger, progress})}});
}

}  // namespace

Measured measure_samplers(const SceneDescription& scene, const MeasureSetup& setup, Progress& progress) {
  SamplerSweep sweep(scene.render.samples, !scene.magnets.items.empty(), setup, progress);
  sweep.run();
  Measured measured;
  measured.outcomes = std::move(sweep.outcomes);
  const std::vector<Outcome>& outcomes = measured.outcomes;
  Report& report = measured.report;
  report.title = "Samplers";
  report.data = outcome_table(outcomes);
  const auto add = [&](const char* key, const char* title, Quantity quantity, const auto& value) {
    add_column(report.data, {key, title, quantity}, outcomes, [&](const Outcome& o) -> Cell {
      const SamplerRow& row = sweep.rows[static_cast<size_t>(&o - outcomes.data())];
      return row.known ? value(row) : NAN;
    });
  };
  add_column(report.data, {"noise", "noise", Quantity::kPercent}, outcomes,
             [](const Outcome& o) -> Cell { return o.number("noise"); });
  add("samples", "samples", Quantity::kRatio, [](const SamplerRow& r) { return r.error.samples; });
  add("surface_samples", "on surfaces", Quantity::kRatio,
      [](const SamplerRow& r) { return r.error.region_samples; });
  add("rel_mse", "relMSE", Quantity::kRatio, [](const SamplerRow& r) { return r.error.rel_mse; });
  add("rel_mse_4", "of 4 x 4", Quantity::kRatio, [](const SamplerRow& r) { return r.error.rel_mse_4; });
  add("rel_mse_16", "of 16 x 16", Quantity::kRatio, [](const SamplerRow& r) { return r.error.rel_mse_16; });
  add("top_error", "99.9th percentile", Quantity::kPercent,
      [](const SamplerRow& r) { return r.error.top_error; });
  add("bias", "bias", Quantity::kPercent, [](const SamplerRow& r) { return r.error.bias; });
  add("gain", "fewer samples", Quantity::kRatio,
      [&](const SamplerRow& r) { return gain_of(sweep.rows, r, r.error.samples); });
  add("surface_gain", "on surfaces", Quantity::kRatio,
      [&](const SamplerRow& r) { return gain_of(sweep.rows, r, r.error.region_samples); });
  add("inverse_surface_share", "1 / share of surfaces", Quantity::kRatio,
      [](const SamplerRow& r) { return 1 / r.error.region_share; });
  add("inverse_coverage", "1 / coverage", Quantity::kRatio,
      [](const SamplerRow& r) { return 1 / r.error.coverage; });

  report.sections.push_back(
      {"Method",
       {Paragraph{fmt::format(
           "Two pictures with {} samples and independent seeds are the reference. Plain pictures have the "
           "same number of samples in every pixel; their noise is the noise budget of the adaptive pictures, "
           "whose pixels get at most {}. All pictures have different seeds. relMSE is the mean over pixels "
           "with alpha of (x - a)(x - b) / (t^2 + 0.01 m^2), where a and b are the two references, t is "
           "their mean over 9 x 9 pixels and m the mean of t; of 4 x 4 and 16 x 16: of means of so many "
           "pixels. "
           "The 99.9th percentile is the error that one pixel in a thousand exceeds. Fewer samples: the "
           "samples that plain sampling "
           "needs for the "
           "same relMSE, divided by the samples taken, over all pixels and over pixels with alpha. Bias is "
           "the error of the mean luminance over these pixels. A rule that knew the variance of every pixel "
           "beforehand and took no sample elsewhere would need {:.2f} times fewer samples on pixels with "
           "alpha, {:.2f} times fewer in all: the best counts are proportional to the square root of the "
           "variance. Rows of gather have as many samples as the plain ones; those that reject follow the "
           "rule of \"Rendering Fur in Life of Pi\": no shadow ray where the first rays of a tile were "
           "blocked. What these rays miss is lost, which the bias shows. A scene with magnets is also "
           "rendered "
           "without them.",
           kReferenceFactor * scene.render.samples, scene.render.samples, sweep.best.surface,
           sweep.best.all)}}});
  report.sections.push_back(
      {"Samples",
       {select(report.data,
               {"variant", "wall_s", "cpu_s", "cpu_least_s", "cpu_most_s", "noise", "samples",
                "surface_samples", "rel_mse", "rel_mse_4", "rel_mse_16", "top_error", "bias", "gain",
                "surface_gain", "inverse_surface_share", "inverse_coverage"},
               "Samples and error.")}});
  add_techniques(scene, report, progress);
  return measured;
}

}  // namespace pelage
