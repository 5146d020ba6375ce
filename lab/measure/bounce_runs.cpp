// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/bounce_runs.h"

#include <iterator>

#include <fmt/format.h>

#include "base/counted.h"
#include "lab/measure/caches.h"
#include "lab/pictures/picture_error.h"

namespace pelage {
namespace {

class BounceSweep {
 public:
  BounceSweep(const SceneDescription& scene, int samples, const MeasureSetup& setup, Progress& progress)
      : samples_(samples),
        progress_(progress),
        caches_(CacheFolders(scene, setup.folder).arguments("warm")),
        runner_(setup, progress, 1 + bounce_methods().size() * std::size(kBounces)) {}

  void run() {
    render(0, kBounces[0], true);
    if (!runs.back().outcome.succeeded()) return;
    // All methods with few bounces first: if the speed of the machine changes, it does so for all.
    for (const int bounces : kBounces) {
      for (size_t method = 0; method < bounce_methods().size(); ++method) {
        if (progress_.cancelled()) return;
        render(method, bounces, false);
      }
    }
    compare();
  }

  std::vector<BounceRun> runs;

 private:
  void render(size_t method, int bounces, bool is_warm_up) {
    const BounceMethod& by = bounce_methods()[method];
    Variant variant{fmt::format("{}-{}", by.id, bounces),
                    fmt::format("{}, {}", by.title, counted(bounces, "bounce")), "render", caches_,
                    is_warm_up};
    if (is_warm_up) variant.id = variant.title = "warm-up";
    const auto set = [&](const std::string& key, const std::string& value) {
      variant.arguments.insert(variant.arguments.end(), {"--set", "render." + key + "=" + value});
    };
    for (const auto& [key, value] : by.settings) set(key, value);
    set("bounces", std::to_string(bounces));
    set("samples", std::to_string(samples_));
    Outcome outcome = runner_.run(variant);
    runs.push_back({method, is_warm_up, bounces, std::move(outcome), runner_.picture(variant)});
  }

  /// Compares each picture with the picture of `path` that has the most bounces.
  void compare() {
    const BounceRun* most = nullptr;
    for (const BounceRun& run : runs) {
      if (run.method == 0 && !run.is_warm_up && run.outcome.succeeded()) most = &run;
    }
    for (BounceRun& run : runs) {
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

}  // namespace

const std::vector<BounceMethod>& bounce_methods() {
  static const std::vector<BounceMethod> all = [] {
    std::vector<BounceMethod> methods{
        {"path", "path", {{"integrator", "path"}}},
        {"rays", "gather, cache: false", {{"integrator", "gather"}, {"gather.cache", "false"}}},
        {"cache", "gather, cache: true", {{"integrator", "gather"}, {"gather.cache", "true"}}}};
    for (BounceMethod& method : methods) method.settings.emplace_back("indirect", "path");
    return methods;
  }();
  return all;
}

std::vector<BounceRun> run_bounces(const SceneDescription& scene, int samples, const MeasureSetup& setup,
                                   Progress& progress) {
  BounceSweep sweep(scene, samples, setup, progress);
  sweep.run();
  return std::move(sweep.runs);
}

}  // namespace pelage
