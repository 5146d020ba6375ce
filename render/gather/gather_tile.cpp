// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/gather/gather_integrator_test.cpp.
#include "render/gather/gather_tile.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/hash.h"
#include "render/gather/systematic_choice.h"

namespace pelage {
namespace {

/// Memory of the samples of a tile.
constexpr size_t kSampleBytes = size_t{4} << 20;
constexpr uint32_t kMaxSamples = 64;
constexpr size_t kPixels = static_cast<size_t>(GatherTile::kSide) * GatherTile::kSide;
/// Weight of a tile's mean light in the brightness by which errors of a pixel are judged.
constexpr double kDarkest = 0.1;
/// Fraction of the samples from which the rest learns which lights arrive.
constexpr uint32_t kPilotShare = 8;
constexpr uint32_t kSamplesPerCheck = 256;  // whether to stop

uint64_t random_of(const RenderScene& scene, const Tile& tile, uint32_t first, uint64_t use) {
  return hash64(use, static_cast<uint64_t>(scene.render.seed), static_cast<uint32_t>(tile.x0),
                static_cast<uint32_t>(tile.y0), first);
}

}  // namespace

/// Collects the light that arrives along the first ray of a path, by light.
class GatherTile::PathSink {
 public:
  PathSink(std::vector<Rgb>& arriving, IndirectClamp& clamp) : arriving_(arriving), clamp_(clamp) {}

  void shadow(const PathState& path, const LightPoint& from, float factor, float through) {
    if (through > 0) add(path, from.light, from.value.total() * from.arriving * (through * factor));
  }
  void met(const PathState& path, size_t light, const Rgb& radiance, float weight, float through) {
    if (weight * through > 0) add(path, light, radiance * (weight * through));
  }

 private:
  void add(const PathState& path, size_t source, const Rgb& light) {
    const Rgb arriving = path.throughput * light;
    arriving_[source] += arriving * clamp_.keep(path.first, arriving);
  }

  std::vector<Rgb>& arriving_;
  IndirectClamp& clamp_;
};

GatherTile::GatherTile(const RenderScene& scene, const Accel& accel, const FilmLayers& layers,
                       const PathOptions& options)
    : scene_(scene),
      accel_(accel),
      layers_(layers),
      options_(options),
      shading_(scene),
      camera_(scene, accel, layers.splat.has_value()),
      points_(scene, accel, shading_, layers),
      walk_(scene, accel, shading_, options) {}

std::unique_ptr<GatherTile::Scratch> GatherTile::make_scratch() const { return std::make_unique<Scratch>(); }

uint32_t GatherTile::max_samples(size_t lights) {
  const size_t fits = kSampleBytes / (kPixels * TileSamples::bytes_per_sample(lights));
  return static_cast<uint32_t>(std::clamp<size_t>(fits, 1, kMaxSamples));
}

size_t GatherTile::scratch_bytes(size_t lights, uint32_t samples) {
  constexpr size_t kMapEntry = 48;  // of an unordered_map, with its share of the buckets
  const size_t order = lights * (sizeof(uint64_t) + sizeof(double));
  // At worst, each sample has a knot of its own.
  const size_t knot = kMapEntry + LightSharing::bytes_per_knot(lights) + PathSharing::bytes_per_knot(lights);
  const size_t sample = TileSamples::bytes_per_sample(lights) + order + knot;
  return kPixels * (samples * sample + sizeof(TileSamples::Front) + sizeof(double));
}

bool GatherTile::trace(const Tile& tile, uint32_t first, uint32_t count, const Job& job,
                       Scratch& scratch) const {
  scratch.tile = tile;
  scratch.first = first;
  scratch.count = count;
  scratch.clamp.limit = scene_.render.clamp_indirect;
  const size_t pixels = static_cast<size_t>(tile.x1 - tile.x0) * static_cast<size_t>(tile.y1 - tile.y0);
  scratch.samples.begin(pixels, pixels * count, scene_.lights.size());
  scratch.look.knots.clear();
  scratch.look.layers.clear();
  scratch.lights.begin(scene_.lights.size(), scene_.render.gather.reuse);
  // The first samples find out which lights arrive at all.
  const uint32_t pilot = (count + kPilotShare - 1) / kPilotShare;
  for (uint32_t begin = 0, end = pilot; begin < count; begin = end, end = count) {
    const size_t earlier = scratch.samples.light_rays.size();
    if (!look(begin, end, job, scratch) || !trace_lights(earlier, job, scratch)) return false;
  }
  scratch.lights.finish(scratch.samples.layer_of_knot);
  return trace_paths(job, scratch);
}

/// Finds the points that samples `begin` to `end` of all pixels see, counted from the first.
bool GatherTile::look(uint32_t begin, uint32_t end, const Job& job, Scratch& scratch) const {
  const Tile& tile = scratch.tile;
  uint32_t pixel = 0;
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x, ++pixel) {
      if (job.progress.cancelled()) return false;
      for (uint32_t i = begin; i < end; ++i) {
        points_.look(x, y, pixel, scratch.first + i, scratch.look, scratch, scratch.samples);
      }
    }
  }
  return true;
}

/// Traces some of the shadow rays from `first` on, chosen in proportion to the error that they prevent: the
/// standard deviation of the light that arrives, relative to the light of their pixel.
bool GatherTile::trace_lights(size_t first, const Job& job, Scratch& scratch) const {
  const TileSamples& samples = scratch.samples;
  const size_t lights = scene_.lights.size();
  const bool reuse = scene_.render.gather.reuse;
  scratch.pixel_light.assign(samples.fronts.size(), 0);
  double tile_light = 0;
  const auto layer = [&](const LightRay& ray) {
    return samples.layer_of_knot[samples.points[ray.point].knot];
  };
  scratch.order.clear();
  for (size_t i = first; i < samples.light_rays.size(); ++i) {
    const LightRay& ray = samples.light_rays[i];
    const VisiblePoint& point = samples.points[ray.point];
    scratch.lights.add_unoccluded(point.knot, ray.light, ray.unoccluded);
    const double expected = ray.unoccluded * scratch.lights.chance(layer(ray), ray.light);
    scratch.pixel_light[point.pixel] += expected;
    tile_light += expected;
    scratch.order.push_back((point.knot * lights + ray.light) << 32 | i);
  }
  if (scratch.order.empty()) return true;
  std::sort(scratch.order.begin(), scratch.order.end());
  const double darkest = kDarkest * tile_light / static_cast<double>(scratch.pixel_light.size());
  const auto mass = [&](const LightRay& ray) {
    if (!reuse) return 1.0;
    return ray.unoccluded * std::sqrt(scratch.lights.chance(layer(ray), ray.light)) /
           (scratch.pixel_light[samples.points[ray.point].pixel] + darkest);
  };
  scratch.masses.clear();
  double total = 0;
  for (uint64_t entry : scratch.order) {
    scratch.masses.push_back(mass(samples.light_rays[entry & 0xffffffffu]));
    total += scratch.masses.back();
  }
  size_t points = samples.points.size() - samples.light_rays[first].point;
  const double rays = reuse ? scene_.render.gather.light_rays * static_cast<double>(points) : total;
  SystematicChoice choice(total / rays,
                          unit_float(random_of(scene_, scratch.tile, scratch.first + (first > 0 ? 1 : 0),
                                               random_use("shadow rays"))));
  size_t traced = 0;
  for (size_t i = 0; i < scratch.order.size(); ++i) {
    const uint32_t times = choice.times(scratch.masses[i]);
    if (times == 0) continue;
    const LightRay& ray = samples.light_rays[scratch.order[i] & 0xffffffffu];
    const VisiblePoint& point = samples.points[ray.point];
    if (++traced % kSamplesPerCheck == 0 && job.progress.cancelled()) return false;
    ++scratch.rays.shadow;
    const float through = accel_.transmittance(point.ray(ray.ray), scratch.thread);
    const double stands_for = times * choice.step() / scratch.masses[i] * ray.unoccluded;
    scratch.lights.add_ray(point.knot, layer(ray), ray.light, static_cast<float>(stands_for), through);
  }
  return true;
}

/// Traces paths from some points, as roulette would choose them.
bool GatherTile::trace_paths(const Job& job, Scratch& scratch) const {
  const TileSamples& samples = scratch.samples;
  const bool reuse = scene_.render.gather.reuse;
  scratch.paths.begin(samples.layer_of_knot.size(), samples.layers, scene_.lights.size(), reuse);
  if (scene_.render.bounces == 0) return true;
  SystematicChoice choice(reuse ? 1 / double{scene_.render.gather.paths} : 1.0,
                          unit_float(random_of(scene_, scratch.tile, scratch.first, random_use("paths"))));
  scratch.order.clear();
  for (size_t i = 0; i < samples.points.size(); ++i) {
    scratch.order.push_back(static_cast<uint64_t>(samples.points[i].knot) << 32 | i);
  }
  std::sort(scratch.order.begin(), scratch.order.end());
  size_t traced = 0;
  const auto columns = static_cast<uint32_t>(scratch.tile.x1 - scratch.tile.x0);
  for (uint64_t entry : scratch.order) {
    const VisiblePoint& point = samples.points[entry & 0xffffffffu];
    scratch.paths.add_weights(point.knot, point.weights);
    const float mass = options_.roulette ? PathWalk<PathSink>::survival(point.weight()) : 1.0f;
    const uint32_t times = choice.times(mass);
    if (times == 0 || !(mass > 0)) continue;
    if (++traced % kSamplesPerCheck == 0 && job.progress.cancelled()) return false;
    const auto factor = static_cast<float>(times * choice.step() / mass);
    PathState path(camera_.stream(scratch.tile.x0 + static_cast<int>(point.pixel % columns),
                                  scratch.tile.y0 + static_cast<int>(point.pixel / columns), point.sample));
    path.time = point.time;
    path.random = point.random;
    std::copy(std::begin(point.weights), std::end(point.weights), path.first);
    path.weight = point.weight() * factor;
    scratch.arriving.assign(scene_.lights.size(), Rgb(0));
    PathSink sink(scratch.arriving, scratch.clamp);
    walk_.follow(point.ray(point.scattered), path, scratch.direct, scratch, sink);
    scratch.paths.add_path(point.knot, point.weights, factor, scratch.arriving);
  }
  scratch.paths.finish(samples.layer_of_knot);
  return true;
}

int64_t GatherTile::add_to(Film& film, Scratch& scratch) const {
  const TileSamples& samples = scratch.samples;
  const size_t lights = scene_.lights.size();
  const int columns = scratch.tile.x1 - scratch.tile.x0;
  int64_t rejected = 0;
  size_t seen = 0;
  for (size_t index = 0; index < samples.samples.size(); ++index) {
    const uint32_t pixel = samples.samples[index].pixel;
    FilmSample& sample = scratch.sample = FilmSample{};
    sample.offset = samples.samples[index].offset;
    scratch.by_layer.assign(layers_.size(), Rgb(0));
    for (; seen < samples.seen_lights.size() && samples.seen_lights[seen].sample == index; ++seen) {
      sample.radiance += samples.seen_lights[seen].radiance;
      if (!layers_.empty()) {
        scratch.by_layer[layers_.emitted(samples.seen_lights[seen].light)] +=
            samples.seen_lights[seen].radiance;
      }
    }
    const uint32_t number = samples.samples[index].point;
    if (number != TileSamples::kNoPoint) {
      sample.alpha = 1;
      if (samples.fronts[pixel].sample == index) sample.surface = samples.fronts[pixel].surface;
      const VisiblePoint& point = samples.points[number];
      for (size_t light = 0; light < lights; ++light) {
        const float fraction = scratch.lights.fraction(point.knot, light);
        for (int g = 0; g < kLobeGroups; ++g) {
          const size_t of = (number * lights + light) * kLobeGroups + static_cast<size_t>(g);
          const Rgb part = samples.unoccluded[of] * fraction +
                           point.weights[g] * scratch.paths.radiance(point.knot, light, g);
          sample.radiance += part;
          if (g < layers_.groups) scratch.by_layer[layers_.scattered(light, g)] += part;
        }
      }
    }
    const int x = scratch.tile.x0 + static_cast<int>(pixel) % columns;
    const int y = scratch.tile.y0 + static_cast<int>(pixel) / columns;
    if (!film.add(x, y, sample, scratch.by_layer)) ++rejected;
  }
  return rejected;
}

}  // namespace pelage
