// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/scene_techniques.h"

#include <cmath>
#include <memory>
#include <string>

#include "render/render_frame.h"
#include "world/assets.h"
#include "world/compose.h"

namespace pelage {
namespace {

constexpr int kMostSamples = 32;

struct Technique {
  const char *id, *title;
  PathOptions path;
  SkinBallUse balls = SkinBallUse::kOff;
  bool magnets = true;
};

std::vector<Technique> techniques_of(const SceneDescription& scene) {
  const DirectTechniques both = DirectTechniques::kBoth;
  std::vector<Technique> all{
      {"both", "lights and lobes, MIS", {both}},
      {"lights", "lights alone", {DirectTechniques::kLightsOnly}},
      {"lobes", "lobes alone", {DirectTechniques::kLobesOnly}},
      {"importance", "MIS, lights chosen by angle and radiance", {both, LightChoice::kImportance}},
      {"balls", "MIS, balls in skins", {both}, SkinBallUse::kExact}};
  if (!scene.magnets.items.empty())
    all.push_back({"no_magnets", "MIS, without magnets", {both}, SkinBallUse::kOff, false});
  return all;
}

/// Mean and variance over the pixels that show a surface.
struct SurfaceNoise {
  double mean = 0, variance = 0;

  explicit SurfaceNoise(const Film& film) {
    double count = 0;
    const auto each = [&](const auto& visit) {
      for (int y = 0; y < film.height(); ++y) {
        for (int x = 0; x < film.width(); ++x) {
          if (film.alpha(x, y) > 0.5f)
            visit(film.moments()[static_cast<size_t>(y) * static_cast<size_t>(film.width()) +
                                 static_cast<size_t>(x)]);
        }
      }
    };
    each([&](const PixelMoments& pixel) {
      mean += pixel.mean;
      ++count;
    });
    mean /= count;
    // Relative to the pixel, but not to black ones.
    each([&](const PixelMoments& pixel) {
      variance += pixel.variance() / (pixel.mean * pixel.mean + 0.01 * mean * mean) / count;
    });
  }
};

}  // namespace

Table scene_techniques(const SceneDescription& scene, const Job& job) {
  SceneDescription reduced = scene;
  reduced.image.noise_layers = true;
  reduced.image.light_layers = false;
  reduced.render.integrator = Integrator::kPath;
  reduced.render.indirect = IndirectLight::kPath;
  reduced.render.adaptive.reset();
  reduced.render.samples = std::min(reduced.render.samples, kMostSamples);
  Table table;
  table.caption =
      "Variance of a sample relative to the square of its pixel, per sample and per shadow or indirect ray.";
  table.columns = {{"technique", "technique"},
                   {"mean", "mean"},
                   {"variance", "variance"},
                   {"rays", "rays per sample"},
                   {"variance_per_ray", "variance x rays"}};
  const auto assets = load_assets(reduced, job);
  for (const Technique& technique : techniques_of(scene)) {
    SceneDescription own = reduced;
    own.render.skin_ball = technique.balls;
    if (!technique.magnets) own.magnets.items.clear();
    const World world = compose(own, *assets, own.frames.frames.front(), job);
    FrameOptions options;
    options.path = technique.path;
    const FrameResult result = render_frame(world.scene, job, options);
    if (result.partial) return table;
    const SurfaceNoise noise(result.film);
    double samples = 0;
    for (int y = 0; y < result.film.height(); ++y) {
      for (int x = 0; x < result.film.width(); ++x)
        samples += result.film.alpha(x, y) > 0.5f ? result.film.samples(x, y) : 0;
    }
    const RayStatistics& rays = result.statistics.rays;
    const double per_sample = static_cast<double>(rays.shadow + rays.indirect) / samples;
    table.rows.push_back(
        {Text{technique.title}, noise.mean, noise.variance, per_sample, noise.variance * per_sample});
  }
  return table;
}

}  // namespace pelage
