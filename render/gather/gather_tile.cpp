// SPDX-License-Identifier: Apache-2.0
#include "render/gather/gather_tile.h"

#include <algorithm>

#include "base/hash.h"

namespace pelage {
namespace {

/// Memory of the samples of a tile.
constexpr size_t kSampleBytes = size_t{4} << 20;
constexpr uint32_t kMaxSamples = 64;
constexpr size_t kPixels = static_cast<size_t>(GatherTile::kSide) * GatherTile::kSide;
/// One in kPilotShare samples is traced first. From these, the others learn which lights arrive.
constexpr uint32_t kPilotShare = 8;

}  // namespace

GatherTile::GatherTile(const RenderScene& scene, const Accel& accel, const ResidentChunks& chunks,
                       const FilmLayers& layers, const PathOptions& options,
                       const std::optional<ReflectionCache>& cache)
    : scene_(scene),
      accel_(accel),
      layers_(layers),
      shading_(scene, options.balls),
      camera_(scene, accel, layers.splat.has_value()),
      points_(scene, shading_, camera_, samples_at_once(scene)),
      shadow_rays_(scene, accel),
      indirect_paths_(scene, accel, shading_, camera_, options, cache) {
  if (scene.render.draws_visible()) raster_.emplace(scene, accel, chunks, camera_);
}

std::unique_ptr<GatherTile::Scratch> GatherTile::make_scratch() const { return std::make_unique<Scratch>(); }

uint32_t GatherTile::max_samples(size_t lights) {
  const size_t fits = kSampleBytes / (kPixels * TileSamples::bytes_per_sample(lights));
  return static_cast<uint32_t>(std::clamp<size_t>(fits, 1, kMaxSamples));
}

uint32_t GatherTile::samples_at_once(const RenderScene& scene) {
  return std::min(max_samples(scene.lights.size()), static_cast<uint32_t>(scene.render.samples));
}

size_t GatherTile::scratch_bytes(size_t lights, uint32_t samples, bool draws) {
  const size_t rays = lights * TileSamples::targets(lights);
  const size_t ordered =
      GatherPointOrder::bytes(1, 1) + GatherPointOrder::bytes(rays, lights) + rays * sizeof(float);
  // At worst, each sample has a gather point of its own.
  const size_t gather_point = 2 * IndexTable::bytes_per_key() + LightSharing::bytes_per_gather_point(lights) +
                              PathSharing::bytes_per_gather_point(lights);
  const size_t sample = TileSamples::bytes_per_sample(lights) + ordered + gather_point;
  // One sample in kPilotShare is a pilot; at least one is.
  const size_t pilots = rays * sizeof(ShadowRays::Pilot) * (samples / kPilotShare + 1);
  return RecentGatherPoints::bytes() + ArrivalGuess::bytes(lights) + kPixels * pilots +
         kPixels * (samples * sample + sizeof(TileSamples::Front) + sizeof(double)) +
         (draws ? TileRaster::scratch_bytes(kPixels * samples) : 0);
}

bool GatherTile::trace(const Tile& tile, uint32_t first, uint32_t count, const Job& job,
                       Scratch& scratch) const {
  TileSamples& samples = scratch.samples;
  const size_t lights = scene_.lights.size();
  const bool reuse = scene_.render.gather.reuse;
  samples.begin(tile, count, lights);
  samples.random_key = hash64(static_cast<uint64_t>(scene_.render.seed), static_cast<uint32_t>(tile.x0),
                              static_cast<uint32_t>(tile.y0), first);
  scratch.clamp.limit = scene_.render.clamp_indirect;
  scratch.look.clear();
  scratch.lights.begin(lights);
  if (raster_) {
    const double began_s = thread_cpu_seconds();
    if (!raster_->find(tile, first, count, job, scratch.thread.worker, scratch.raster)) return false;
    scratch.costs.rays.add(RayKind::kCamera, thread_cpu_seconds() - began_s - scratch.raster.growth_s);
  }
  scratch.first_sample = first;
  const uint32_t pilot = (count + kPilotShare - 1) / kPilotShare;
  if (!look(first, pilot, job, scratch)) return false;
  if (!shadow_rays_.trace(samples, 0, job, scratch.shadow_rays, scratch, scratch.lights)) return false;
  const size_t pilot_rays = samples.light_rays.size();
  if (!look(first + pilot, count - pilot, job, scratch)) return false;
  if (!shadow_rays_.trace(samples, pilot_rays, job, scratch.shadow_rays, scratch, scratch.lights))
    return false;
  scratch.lights.finish(samples.zone_of_gather_point.size());
  scratch.paths.begin(samples.zone_of_gather_point.size(), samples.zones, lights, reuse);
  if (!indirect_paths_.trace(samples, job, scratch.indirect_paths, scratch, scratch.paths)) return false;
  scratch.paths.finish(samples.zone_of_gather_point);
  if (reuse) scratch.paths.blend(samples.patch_of_gather_point, samples.patches);
  return true;
}

/// Finds what samples first .. first + count - 1 of all pixels see.
bool GatherTile::look(uint32_t first, uint32_t count, const Job& job, Scratch& scratch) const {
  for (uint32_t pixel = 0; pixel < scratch.samples.pixels(); ++pixel) {
    if (job.progress.cancelled()) return false;
    for (uint32_t i = 0; i < count; ++i) {
      const uint32_t drawn = first + i - scratch.first_sample;
      const auto hit = [&](const Ray& ray) {
        if (!raster_) return scratch.closest(RayKind::kCamera, accel_, ray);
        return scratch.costs.rays.measure(RayKind::kCamera, scratch.thread.counts, [&] {
          return raster_->closest(pixel, drawn, scratch.thread, scratch.raster);
        });
      };
      const CameraSample* known = raster_ ? &TileRaster::sample(pixel, drawn, scratch.raster) : nullptr;
      points_.look(pixel, first + i, known, hit, scratch.look, scratch, scratch.lights, scratch.samples);
    }
  }
  TileRaster::end(scratch.thread, scratch.raster);
  return true;
}

/// Adds the light that a visible point scatters to `scratch.sample` and `scratch.by_layer`.
void GatherTile::add_scattered(uint32_t point, Scratch& scratch) const {
  const VisiblePoint& at = scratch.samples.points[point];
  const Rgb* unoccluded = &scratch.samples.unoccluded[point * scene_.lights.size() * kLobeGroups];
  for (size_t light = 0; light < scene_.lights.size(); ++light) {
    for (int g = 0; g < kLobeGroups; ++g) {
      const Rgb direct = *unoccluded++ * scratch.lights.fraction(at.gather_point, light, g);
      const Rgb part = direct + at.weights[g] * scratch.paths.radiance(at.gather_point, light, g);
      scratch.sample.radiance += part;
      if (g >= layers_.groups) continue;
      scratch.by_layer[layers_.scattered(light, g)] += part;
      if (layers_.events) scratch.by_layer[layers_.direct(light, g)] += direct;
    }
  }
}

int64_t GatherTile::add_to(const PixelBox& window, Film& film, Scratch& scratch) const {
  const TileSamples& samples = scratch.samples;
  int64_t rejected = 0;
  auto seen = samples.seen_lights.begin();
  for (uint32_t i = 0; i < samples.samples.size(); ++i) {
    const TileSamples::Sample& from = samples.samples[i];
    scratch.sample = FilmSample{};
    scratch.sample.offset = from.offset;
    scratch.by_layer.assign(layers_.size(), Rgb(0));
    for (; seen != samples.seen_lights.end() && seen->sample == i; ++seen) {
      scratch.sample.radiance += seen->radiance;
      if (!layers_.empty()) scratch.by_layer[layers_.emitted(seen->light)] += seen->radiance;
    }
    if (from.point != TileSamples::kNoPoint) {
      const TileSamples::Front& front = samples.fronts[from.pixel];
      scratch.sample.alpha = 1;
      if (front.sample == i) scratch.sample.surface = front.of_pixel.surface;
      add_scattered(from.point, scratch);
    }
    const bool added = film.add(samples.x(from.pixel) - window.x0, samples.y(from.pixel) - window.y0,
                                scratch.sample, scratch.by_layer);
    rejected += added ? 0 : 1;
  }
  return rejected;
}

}  // namespace pelage
