// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/shading_runs.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lab/measure/caches.h"

namespace pelage {
namespace {

/// Adaptive sampling may give a pixel this many times the samples of the picture whose noise is its budget.
constexpr int kAdaptiveFactor = 16;
/// Samples of the warm-up run, which also measures the noise of `path`.
constexpr int kWarmUpSamples = 16;

class Sweep {
 public:
  Sweep(const SceneDescription& scene, const ShadingPlan& plan, const MeasureSetup& setup, Progress& progress)
      : results{shading_curves(scene, plan.parts), {}, {}, same_as_gather(scene)},
        plan_(plan),
        progress_(progress),
        caches_(CacheFolders(scene, setup.folder).arguments("warm")),
        runner_(setup, progress, count()) {}

  void run() {
    const ShadingCurve &path = results.curves.front(), splatted = reference();
    if (!add(variant_of(path, "warm-up", "warm-up", kWarmUpSamples, true), {})) return;
    noise_ = results.runs.back().outcome.number("noise");
    for (const char* id : {"reference-a", "reference-b"}) {
      if (!add(variant_of(splatted, id, id, plan_.reference_samples, true), {})) return;
      results.references.push_back(results.runs.back().picture);
    }
    // All curves with few samples first: if the speed of the machine changes, it does so for all.
    for (const int samples : plan_.samples) {
      for (size_t curve = 0; curve < results.curves.size(); ++curve) {
        if (progress_.cancelled()) return;
        measure(curve, samples);
      }
    }
    for (ShadingRun& run : results.runs) {
      if (run.last && results.curves[*run.curve].gather && !progress_.cancelled()) measure_reuse(run);
    }
    results.runs.insert(results.runs.end(), others_.begin(), others_.end());
    std::stable_sort(results.runs.begin(), results.runs.end(),
                     [](const ShadingRun& a, const ShadingRun& b) { return a.curve < b.curve; });
  }

  ShadingRuns results;

 private:
  size_t count() const {
    const auto gathers = std::count_if(results.curves.begin(), results.curves.end(),
                                       [](const ShadingCurve& curve) { return curve.gather; });
    return 3 + results.curves.size() * plan_.samples.size() + static_cast<size_t>(gathers);
  }

  static ShadingCurve reference() {
    return {"reference",
            "reference",
            {{"render.integrator", "path"},
             {"image.filter_samples", "splatted"},
             {"render.skin_ball", "off"},
             {"render.screen_door", "false"}}};
  }

  /// Each variant has another seed, so that no two pictures share noise.
  Variant variant_of(const ShadingCurve& curve, const std::string& id, const std::string& title, int samples,
                     bool once) {
    Variant variant{id, title, "render", caches_, once};
    const auto set = [&](const std::string& key, const std::string& value) {
      variant.arguments.insert(variant.arguments.end(), {"--set", key + "=" + value});
    };
    for (const auto& [key, value] : curve.settings) set(key, value);
    if (curve.adaptive) {
      // The noise of independent samples.
      set("render.adaptive.noise",
          fmt::format("{:g}", noise_ * std::sqrt(static_cast<double>(kWarmUpSamples) / samples)));
      samples *= kAdaptiveFactor;
    }
    set("render.samples", std::to_string(samples));
    set("render.seed", std::to_string(3000 + seed_++));
    set("image.noise_layers", id == "warm-up" ? "true" : "false");
    return variant;
  }

  /// Whether it succeeded.
  bool add(const Variant& variant, const ShadingRun& run) {
    results.runs.push_back(run);
    results.runs.back().outcome = runner_.run(variant);
    results.runs.back().picture = runner_.picture(variant);
    return results.runs.back().outcome.succeeded() && !progress_.cancelled();
  }

  void measure(size_t at, int samples) {
    const ShadingCurve& curve = results.curves[at];
    ShadingRun run;
    run.curve = at;
    run.last = samples == plan_.samples.back();
    if (!add(variant_of(curve, fmt::format("{}-{}", curve.id, samples),
                        fmt::format("{}, {}", curve.title, samples), samples, false),
             run))
      return;
    ShadingRun& done = results.runs.back();
    done.error =
        picture_error_of_files(done.picture, results.references[0], results.references[1], ErrorRegion::kFur);
  }

  /// Renders the picture of `run` with another seed.
  void measure_reuse(ShadingRun& run) {
    if (!run.outcome.succeeded()) return;
    const ShadingCurve& curve = results.curves[*run.curve];
    const Variant variant = variant_of(curve, fmt::format("{}-{}-other", curve.id, plan_.samples.back()),
                                       fmt::format("{}, {}, other seed", curve.title, plan_.samples.back()),
                                       plan_.samples.back(), true);
    ShadingRun other;
    other.curve = run.curve;
    other.second = true;
    other.outcome = runner_.run(variant);
    other.picture = run.other = runner_.picture(variant);
    const auto &a = results.references[0], &b = results.references[1];
    if (other.outcome.succeeded()) {
      other.error = picture_error_of_files(other.picture, a, b, ErrorRegion::kFur);
      run.reuse = picture_error_of_files(run.picture, other.picture, a, b, ErrorRegion::kFur);
    }
    others_.push_back(std::move(other));
  }

  const ShadingPlan& plan_;
  Progress& progress_;
  std::vector<std::string> caches_;
  VariantRunner runner_;
  std::vector<ShadingRun> others_;
  double noise_ = NAN;
  int seed_ = 0;
};

}  // namespace

ShadingRuns run_shading(const SceneDescription& scene, const ShadingPlan& plan, const MeasureSetup& setup,
                        Progress& progress) {
  Sweep sweep(scene, plan, setup, progress);
  sweep.run();
  return std::move(sweep.results);
}

}  // namespace pelage
