// SPDX-License-Identifier: Apache-2.0
#include "render/gather/gather_tracer.h"

#include <algorithm>
#include <utility>

#include "base/hash.h"
#include "base/memory_budget.h"

namespace pelage {
namespace {

/// Memory of the samples of a tile.
constexpr size_t kSampleBytes = size_t{4} << 20;
constexpr uint32_t kMaxSamples = 64;
constexpr size_t kEstimateBytes = 16;  // of a pixel's luminance
constexpr size_t kPixels = static_cast<size_t>(FilmSums::kTileSide) * FilmSums::kTileSide;
/// One in kPilotShare samples is traced first. From these, the others learn which lights arrive.
constexpr uint32_t kPilotShare = 8;
/// With noise layers, the samples of a pixel are divided into this many parts. Samples of different parts
/// share no light, so that the parts differ by their whole noise.
constexpr uint32_t kNoiseParts = 4;
/// The pilot of adaptive sampling is divided into this many parts.
constexpr uint32_t kPilotParts = 2;
/// With so few samples, a first pass of one would find too few points that share light.
constexpr int kFewSamples = 4;
/// Fraction of `render.memory` that tiles may take: 1 / kMemoryShare.
constexpr int64_t kMemoryShare = 8;

/// Max count of samples per pixel of the scene that share light.
uint32_t samples_at_once(const FrameScene& scene) {
  return std::min(GatherTracer::max_samples(scene.sources()), static_cast<uint32_t>(scene.render.samples));
}

/// Returns the options with points on lights from `far_lights`.
PathOptions with(PathOptions options, const FarLightSamples& far_lights) {
  options.far_lights = &far_lights;
  return options;
}

}  // namespace

/// Memory, results and counts of one thread.
struct GatherTracer::Scratch final : SampleScratch {
  void add_to(FrameStatistics& statistics) const override {
    SampleScratch::add_to(statistics);
    statistics.gather_points += gather_points;
    statistics.reflections += indirect_paths.reflections;
  }

  TileSamples samples;
  TileRaster::Scratch raster;
  VisiblePoints::Scratch look;
  ShadowRays::Scratch shadow_rays;
  IndirectPaths::Scratch indirect_paths;
  LightSharing lights;
  PathSharing paths;
  GatherPointStatistics gather_points;
  uint32_t first_sample = 0;  // the first of the samples that share light
  struct Estimate {
    double luminance = 0;  // sum over `samples`
    uint32_t samples = 0;
  };
  static_assert(sizeof(Estimate) == kEstimateBytes);
  std::vector<Estimate> estimates;  // of the last samples that share light, by pixel of the tile
};

GatherTracer::Memory GatherTracer::reserve(const FrameScene& scene, const Job& job) {
  const RenderParams& render = scene.render;
  const auto tile =
      static_cast<int64_t>(scratch_bytes(scene.sources(), samples_at_once(scene), render.draws_visible()));
  const auto limit = static_cast<int64_t>(render.memory.bytes);
  const int threads = job.workers.thread_count();
  int tiles = threads;
  if (limit > 0) tiles = static_cast<int>(std::clamp<int64_t>(limit / kMemoryShare / tile, 1, threads));
  job.ledger.add_elastic((threads - tiles) * tile);
  const auto far_lights =
      static_cast<int64_t>(render.gather.reuse ? FarLightSamples::bytes(scene.lights) : 0);
  Memory memory{tiles,
                pelage::reserve(job.ledger, MemoryTag::kReflectionCache, tile * tiles + far_lights,
                                "the sample buffer of the tiles that are rendered at once"),
                {}};
  if (render.uses_cache(scene.skins.size())) memory.cache = CacheFill::reserve(scene, job);
  return memory;
}

GatherTracer::GatherTracer(const FrameScene& scene, const Accel& accel, const ResidentChunks& chunks,
                           const FilmLayers& layers, const PathOptions& options, Memory memory)
    : scene_(scene),
      accel_(accel),
      layers_(layers),
      far_lights_(scene.lights, static_cast<uint64_t>(scene.render.seed), scene.render.gather.reuse),
      options_(with(options, far_lights_)),
      memory_(std::move(memory)),
      first_alone_(scene.render.time_limit > 0 || (scene.render.samples > kFewSamples && !layers.noise)),
      shading_(scene, options.balls),
      camera_(scene, accel, layers.splat.has_value()),
      points_(scene, accel, shading_, camera_, far_lights_, samples_at_once(scene)),
      shadow_rays_(scene, accel),
      indirect_paths_(scene, accel, shading_, camera_, options_, cache_) {
  if (scene.render.draws_visible()) raster_.emplace(scene, accel, chunks, camera_);
}

TileCosts GatherTracer::fill_cache(const Job& job, const Stopwatch& clock, FrameStatistics& statistics) {
  if (!memory_.cache) return {};
  CacheFill fill(scene_, accel_, layers_.splat.has_value(), options_, std::move(*memory_.cache));
  memory_.cache.reset();
  fill.run(job, clock, cache_);
  fill.add_to(statistics);
  return fill.costs();
}

std::unique_ptr<SampleScratch> GatherTracer::make_scratch() const { return std::make_unique<Scratch>(); }

uint32_t GatherTracer::max_samples(size_t lights) {
  const size_t fits = kSampleBytes / (kPixels * TileSamples::bytes_per_sample(lights));
  return static_cast<uint32_t>(std::clamp<size_t>(fits, 1, kMaxSamples));
}

uint32_t GatherTracer::together(uint32_t first, uint32_t end) const {
  const RenderParams& render = scene_.render;
  uint32_t max = max_samples(scene_.sources());
  const auto at_most = [&](int samples, uint32_t parts) {
    max = std::min(max, (static_cast<uint32_t>(samples) + parts - 1) / parts);
  };
  const bool pilot = render.adaptive && first < static_cast<uint32_t>(render.adaptive->pilot);
  if (pilot)
    at_most(render.adaptive->pilot, kPilotParts);
  else if (layers_.noise && !render.adaptive)
    at_most(render.samples, kNoiseParts);
  if (first == 0 && first_alone_) max = 1;
  return std::min(max, end - first);
}

size_t GatherTracer::scratch_bytes(size_t lights, uint32_t samples, bool draws) {
  const size_t rays = lights * TileSamples::targets(lights);
  const size_t ordered =
      GatherPointOrder::bytes(1, 1) + GatherPointOrder::bytes(rays, lights) + rays * sizeof(float);
  // At worst, each sample has a gather point of its own.
  const size_t gather_point = 2 * IndexTable::bytes_per_key() + LightSharing::bytes_per_gather_point(lights) +
                              PathSharing::bytes_per_gather_point(lights);
  const size_t path = sizeof(IndirectPaths::Scratch::Traced) + lights * sizeof(Rgb);
  const size_t sample = TileSamples::bytes_per_sample(lights) + ordered + gather_point + 2 * path;
  // One sample in kPilotShare is a pilot; at least one is.
  const size_t pilots = rays * sizeof(ShadowRays::Pilot) * (samples / kPilotShare + 1);
  return RecentGatherPoints::bytes() + ArrivalGuess::bytes(lights) +
         DepthProfile::bytes(lights, kPixels * samples * rays) + DepthProfile::bytes(1, kPixels * samples) +
         kPixels * pilots +
         kPixels * (samples * sample + sizeof(TileSamples::Front) + sizeof(double) + kEstimateBytes) +
         (draws ? TileRaster::scratch_bytes(kPixels * samples) : 0);
}

bool GatherTracer::trace_tile(const TileTask& task, SampleScratch& memory) const {
  auto& scratch = static_cast<Scratch&>(memory);
  const Tile& own = task.tile;
  const Tile tile{own.x0 + task.left(), own.y0 + task.top(), own.x1 + task.left(), own.y1 + task.top()};
  const uint32_t end = task.goal(own.x0, own.y0);
  for (uint32_t first = task.film().min_samples(own); first < end;) {
    if (task.must_stop()) return false;
    const uint32_t count = together(first, end);
    if (!gather(tile, first, count, task.job(), scratch)) return false;
    add_samples(task, scratch);
    first += count;
  }
  return true;
}

/// Finds samples first .. first + count - 1 of each pixel of a tile of the picture, which share light.
/// Returns false when `job` was cancelled.
bool GatherTracer::gather(const Tile& tile, uint32_t first, uint32_t count, const Job& job,
                          Scratch& scratch) const {
  TileSamples& samples = scratch.samples;
  const size_t lights = scene_.sources();
  const bool reuse = scene_.render.gather.reuse;
  samples.begin(tile, count, lights);
  samples.random_key = hash64(static_cast<uint64_t>(scene_.render.seed), static_cast<uint32_t>(tile.x0),
                              static_cast<uint32_t>(tile.y0), first);
  scratch.clamp.limit = scene_.render.clamp_indirect;
  scratch.look.clear();
  scratch.lights.begin(lights, scene_.lights.groups());
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
  if (reuse) scratch.lights.profile().learn();
  add_unoccluded(scratch);
  scratch.lights.finish(samples.zone_of_gather_point.size());
  scratch.paths.begin(samples.zone_of_gather_point.size(), samples.zones, lights, reuse);
  if (!indirect_paths_.trace(samples, job, scratch.indirect_paths, scratch, scratch.paths)) return false;
  scratch.paths.finish(samples.zone_of_gather_point);
  if (reuse) scratch.paths.blend(samples.patch_of_gather_point, samples.patches);
  return true;
}

/// Finds what samples first .. first + count - 1 of all pixels see.
bool GatherTracer::look(uint32_t first, uint32_t count, const Job& job, Scratch& scratch) const {
  TileSamples& tile = scratch.samples;
  const auto add = [&](uint32_t pixel, uint32_t sample, const CameraSample& from, const Hit& hit) {
    points_.add(pixel, sample, from, hit, scratch.look, scratch, scratch.lights, tile);
  };
  for (uint32_t pixel = 0; pixel < tile.pixels(); ++pixel) {
    if (job.progress.cancelled()) return false;
    for (uint32_t sample = first; sample < first + count; ++sample) {
      if (raster_) {
        const uint32_t index = sample - scratch.first_sample;
        const Hit hit = scratch.costs.rays.measure(RayKind::kCamera, scratch.thread.counts, [&] {
          return raster_->closest(pixel, index, scratch.thread, scratch.raster);
        });
        add(pixel, sample, TileRaster::sample(pixel, index, scratch.raster), hit);
      } else {
        SampleStream stream = camera_.stream(tile.x(pixel), tile.y(pixel), sample);
        const CameraSample from = camera_.sample(tile.x(pixel), tile.y(pixel), sample, stream);
        add(pixel, sample, from, scratch.closest(RayKind::kCamera, accel_, from.ray));
      }
    }
  }
  TileRaster::end(scratch.thread, scratch.raster);
  return true;
}

/// Adds the unoccluded light of all visible points to their gather points, times what the profile expects at
/// the depth of the point.
void GatherTracer::add_unoccluded(Scratch& scratch) const {
  const Rgb* unoccluded = scratch.samples.unoccluded.data();
  for (const VisiblePoint& point : scratch.samples.points) {
    for (size_t light = 0; light < scene_.sources(); ++light, unoccluded += kLobeGroups) {
      const float expected = scratch.lights.profile().at(point.depth, scene_.group(light));
      Rgb lobes[kLobeGroups];
      for (int g = 0; g < kLobeGroups; ++g) lobes[g] = unoccluded[g] * expected;
      scratch.lights.add_unoccluded(point.gather_point, light, lobes);
    }
  }
}

/// Adds the light that a visible point scatters to `scratch.sample` and `scratch.by_layer`.
void GatherTracer::add_scattered(uint32_t point, Scratch& scratch) const {
  const VisiblePoint& at = scratch.samples.points[point];
  const Rgb* unoccluded = &scratch.samples.unoccluded[point * scene_.sources() * kLobeGroups];
  const float indirect = scratch.paths.profile().at(at.depth, 0);
  for (size_t light = 0; light < scene_.sources(); ++light) {
    const float arriving = scratch.lights.profile().at(at.depth, scene_.group(light));
    for (int g = 0; g < kLobeGroups; ++g) {
      const Rgb direct = *unoccluded++ * (arriving * scratch.lights.fraction(at.gather_point, light, g));
      const Rgb radiance = indirect * scratch.paths.radiance(at.gather_point, light, g);
      const Rgb part = direct + at.weights[g] * radiance;
      scratch.sample.radiance += part;
      if (g >= layers_.groups) continue;
      scratch.by_layer[layers_.scattered(light, g)] += part;
      if (layers_.events) scratch.by_layer[layers_.direct(light, g)] += direct;
    }
  }
}

/// Adds the samples of the last gather() to the film.
void GatherTracer::add_samples(const TileTask& task, Scratch& scratch) const {
  const TileSamples& samples = scratch.samples;
  const bool noise = layers_.noise;
  scratch.estimates.assign(noise ? samples.pixels() : 0, {});
  auto seen = samples.seen_lights.begin();
  for (uint32_t i = 0; i < samples.samples.size(); ++i) {
    const TileSamples::Sample& from = samples.samples[i];
    scratch.sample = FilmSample{};
    scratch.sample.offset = from.offset;
    scratch.sample.alpha = from.alpha;
    scratch.by_layer.assign(layers_.size(), Rgb(0));
    for (; seen != samples.seen_lights.end() && seen->sample == i; ++seen) {
      scratch.sample.radiance += seen->radiance;
      if (!layers_.empty()) scratch.by_layer[layers_.emitted(seen->light)] += seen->radiance;
    }
    if (from.point != TileSamples::kNoPoint) {
      const TileSamples::Front& front = samples.fronts[from.pixel];
      if (front.sample == i) scratch.sample.surface = front.of_pixel.surface;
      add_scattered(from.point, scratch);
    }
    const bool added =
        task.add(samples.x(from.pixel) - task.left(), samples.y(from.pixel) - task.top(), scratch);
    if (!noise || !added) continue;
    scratch.estimates[from.pixel].luminance += luminance(scratch.sample.radiance);
    ++scratch.estimates[from.pixel].samples;
  }
  for (uint32_t pixel = 0; pixel < scratch.estimates.size(); ++pixel) {
    const auto [sum, count] = scratch.estimates[pixel];
    if (count > 0)
      task.film().add_estimate(samples.x(pixel) - task.left(), samples.y(pixel) - task.top(), sum / count,
                               count);
  }
  scratch.gather_points += {.count = static_cast<int64_t>(samples.zone_of_gather_point.size()),
                            .samples = static_cast<int64_t>(samples.points.size())};
  task.advance(samples.samples.size());
}

}  // namespace pelage
