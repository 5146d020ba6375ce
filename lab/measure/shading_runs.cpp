// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/shading_runs.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lab/measure/caches.h"
#include "lab/measure/camera_pan.h"
#include "lab/pictures/flicker.h"

namespace pelage {
namespace {

/// Adaptive sampling may give a pixel this many times the samples of the picture whose noise is its budget.
constexpr int kAdaptiveFactor = 16;
/// The references of sequences have this fraction of the samples of the reference pictures. Flicker is a mean
/// over many blocks and frames, and the noise of its references does not count.
constexpr int kSequenceShare = 8;
/// Samples of the warm-up run, which also measures the noise of `path`.
constexpr int kWarmUpSamples = 16;

class ShadingSweep {
 public:
  ShadingSweep(const SceneDescription& scene, const ShadingPlan& plan, const MeasureSetup& setup,
               Progress& progress)
      : results{shading_curves(scene, plan.parts), {}, {}, same_as_gather(scene)},
        scene_(scene),
        plan_(plan),
        progress_(progress),
        caches_(CacheFolders(scene, setup.folder).arguments("warm")),
        runner_(setup, progress, count()) {}

  void run() {
    const ShadingCurve &path = results.curves.front(), splatted = reference_curve();
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
      if (run.last && !progress_.cancelled()) measure_shared(run);
    }
    measure_flicker();
    results.runs.insert(results.runs.end(), extras_.begin(), extras_.end());
    std::stable_sort(results.runs.begin(), results.runs.end(),
                     [](const ShadingRun& a, const ShadingRun& b) { return a.curve < b.curve; });
  }

  ShadingRuns results;

 private:
  size_t count() const {
    const size_t curves = results.curves.size(), sequences = plan_.flicker_samples.size();
    return 3 + curves * (plan_.samples.size() + 1) + (sequences > 0 ? 2 + curves * sequences : 0);
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
    run.samples = samples;
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
  void measure_shared(ShadingRun& run) {
    if (!run.outcome.succeeded()) return;
    const ShadingCurve& curve = results.curves[*run.curve];
    ShadingRun& other =
        add_extra(run.curve,
                  variant_of(curve, fmt::format("{}-{}-other", curve.id, run.samples),
                             fmt::format("{}, {}, other seed", curve.title, run.samples), run.samples, true));
    run.other = other.picture;
    const auto &a = results.references[0], &b = results.references[1];
    if (!other.outcome.succeeded()) return;
    other.error = picture_error_of_files(other.picture, a, b, ErrorRegion::kFur);
    run.shared = picture_error_of_files(run.picture, other.picture, a, b, ErrorRegion::kFur);
    run.systematic = systematic_error_of_files(run.picture, other.picture, a, b, ErrorRegion::kFur);
  }

  /// Renders sequences of the references and of the curves, with each of the plan's sample counts.
  void measure_flicker() {
    if (plan_.flicker_samples.empty()) return;
    std::vector<std::vector<std::filesystem::path>> references;
    for (const char* id : {"reference-a", "reference-b"}) {
      const int samples = std::max(1, plan_.reference_samples / kSequenceShare);
      references.push_back(render_sequence({}, variant_of(reference_curve(), id, id, samples, true)));
      if (references.back().empty()) return;
    }
    for (ShadingRun& run : results.runs) {
      const auto& wanted = plan_.flicker_samples;
      if (!run.curve || !run.outcome.succeeded() ||
          std::find(wanted.begin(), wanted.end(), run.samples) == wanted.end())
        continue;
      Variant variant = run.outcome.variant;
      variant.once = true;
      const auto frames = render_sequence(run.curve, variant);
      if (progress_.cancelled()) return;
      if (!frames.empty())
        run.flicker = flicker_of_files(frames, references[0], references[1], ErrorRegion::kFur);
    }
  }

  /// Renders kFlickerFrames with the settings of `variant`, while the camera moves. Returns the pictures, or
  /// nothing after a failure.
  std::vector<std::filesystem::path> render_sequence(std::optional<size_t> curve, Variant variant) {
    if (progress_.cancelled()) return {};
    variant.id += "-frames";
    variant.title += fmt::format(", {} frames", kFlickerFrames);
    variant.frames = kFlickerFrames;
    for (const auto& [key, value] : camera_pan(scene_, kFlickerFrames))
      variant.arguments.insert(variant.arguments.end(), {"--set", key + "=" + value});
    const ShadingRun& run = add_extra(curve, variant);
    std::vector<std::filesystem::path> pictures;
    if (!run.outcome.succeeded()) return pictures;
    for (const int frame : pan_frames(scene_, kFlickerFrames).frames)
      pictures.emplace_back(frame_file_name(run.picture.string(), frame));
    return pictures;
  }

  ShadingRun& add_extra(std::optional<size_t> curve, const Variant& variant) {
    ShadingRun run;
    run.curve = curve;
    run.extra = true;
    run.outcome = runner_.run(variant);
    run.picture = runner_.picture(variant);
    extras_.push_back(std::move(run));
    return extras_.back();
  }

  const SceneDescription& scene_;
  const ShadingPlan& plan_;
  Progress& progress_;
  std::vector<std::string> caches_;
  VariantRunner runner_;
  std::vector<ShadingRun> extras_;
  double noise_ = NAN;
  int seed_ = 0;
};

}  // namespace

ShadingRuns run_shading(const SceneDescription& scene, const ShadingPlan& plan, const MeasureSetup& setup,
                        Progress& progress) {
  ShadingSweep sweep(scene, plan, setup, progress);
  sweep.run();
  return std::move(sweep.results);
}

}  // namespace pelage
