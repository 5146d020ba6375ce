// SPDX-License-Identifier: Apache-2.0
#include "render/frame_estimate.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "base/heap.h"
#include "base/memory_budget.h"
#include "base/parallel.h"
#include "base/process_usage.h"
#include "geom/skin_balls.h"
#include "image/exr_file.h"
#include "procedurals/bounds/bounds_file.h"
#include "render/accel/resident_chunks.h"
#include "render/film/film.h"
#include "render/frame/frame_chunks.h"
#include "render/frame/frame_layers.h"
#include "render/frame/frame_window.h"
#include "render/frame/sample_passes.h"
#include "render/gather/gather_tracer.h"
#include "render/weighted_selection.h"

namespace pelage {
namespace {

constexpr size_t kSkinsWithBalls = 4;  // whose balls are found

/// Finds the balls of some skins, and adds what the balls of all skins need.
void add_balls(const RenderScene& scene, const Job& job, ShadowEstimate& estimate) {
  std::vector<double> sizes;
  for (const SkinPart& part : scene.skins)
    sizes.push_back(static_cast<double>(part.skin->temporary_bytes({})));
  double held = 0;
  for (const SelectedItem& item : select_by_weight(sizes, kSkinsWithBalls)) {
    job.check_stop();
    const double began = cpu_seconds();
    const SkinMesh mesh = scene.skins[item.index].skin->tessellate({}, scene.camera.view());
    const SkinBalls balls(mesh, job);
    held += item.scale * static_cast<double>(balls.bytes());
    estimate.cpu_s += item.scale * (cpu_seconds() - began);
    estimate.making_bytes = std::max(estimate.making_bytes,
                                     static_cast<int64_t>(mesh.bytes() + SkinBalls::temporary_bytes(mesh)));
  }
  estimate.held_bytes += static_cast<int64_t>(held);
  // Many skins are worked on concurrently.
  const int threads = job.workers.thread_count();
  if (scene.skins.size() >= 4 * static_cast<size_t>(threads)) estimate.making_bytes *= threads;
}

// Code, tables of libraries and stacks that a render touches after the scene has been read: about 5 MiB in a
// picture of a few strands, and more with all kinds of lights and maps.
constexpr int64_t kLibraries = int64_t{5} << 20, kThread = int64_t{2} << 20;
constexpr size_t kSampledFur = 24, kSampledSkins = 8;  // chunks to grow
// Rough CPU seconds: of a channel of a pixel in a file, of a camera sample, and of each bounce after it.
constexpr double kWrittenValue_s = 1e-7;
// Rays per chunk for which two thirds of the memory of all chunks is needed: half as many rays as were
// measured in crowds with few samples (docs/lab/FARM.md), so that the estimate is rather too large.
constexpr double kRaysToReach = 5;
constexpr double kPathSample_s = 4e-6, kPathBounce_s = 2e-6, kGatherSample_s = 2.5e-6;

/// A kind of chunk, fur or skin: its chunks are `first` to `last` - 1.
struct Kind {
  uint32_t first = 0, last = 0;
  double bytes = 0, peak_bytes = 0, cpu_s = 0;  // of all chunks; peak_bytes: while one is made
};

/// Size of a chunk from its counts, in arbitrary units.
double weight(const ChunkCounts& n) {
  return static_cast<double>(n.points * static_cast<size_t>(n.motion_keys) + 2 * n.strands + n.triangles);
}

/// Grows a selection of chunks, and adds what all chunks of their kind need.
void sample(const ResidentChunks& chunks, const std::vector<double>& weights, size_t count, const Job& job,
            Kind& kind) {
  const std::span of_kind(weights.data() + kind.first, kind.last - kind.first);
  const std::vector<SelectedItem> chosen = select_by_weight(of_kind, count);
  std::vector<Kind> found(chosen.size());
  job.for_each(chosen.size(), 1, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end; ++i) {
      const double began = thread_cpu_seconds();
      const uint32_t chunk = kind.first + static_cast<uint32_t>(chosen[i].index);
      chunks.visit(chunk, range.worker, [&](const ChunkGeometry& geometry) {
        found[i].bytes = static_cast<double>(geometry.bytes());
        found[i].peak_bytes = static_cast<double>(geometry.build_peak_bytes());
        return 0;
      });
      found[i].cpu_s = thread_cpu_seconds() - began;
    }
  });
  for (size_t i = 0; i < chosen.size(); ++i) {
    kind.bytes += found[i].bytes * chosen[i].scale;
    kind.cpu_s += found[i].cpu_s * chosen[i].scale;
    kind.peak_bytes += found[i].peak_bytes * chosen[i].share;
  }
}

FilmLayers layers_of(const RenderScene& scene) {
  std::vector<FilmLayers::LightInfo> lights;
  for (size_t i = 0; i < scene.lights.size(); ++i)
    lights.push_back({scene.lights.light(i).name(), scene.lights.light(i).visible()});
  return frame_layers(scene.image, scene.render, lights, scene.materials);
}

ResidentChunksOptions options_of(const RenderScene& scene, const FrameChunks& chunks, const Job& job) {
  ResidentChunksOptions options;
  options.kind = scene.render.accel;
  options.chunk.shape = scene.render.curves;
  options.chunk.compact_attributes = options.fur.compact_attributes = scene.render.compact_attributes;
  if (const float width = scene.render.min_width(); width > 0)
    options.fur.min_width = MinWidth{scene.camera.lod_view(), width};
  options.memory_limit = scene.render.memory.bytes;
  options.threads = job.workers.thread_count();
  options.opaque = chunks.opaque();
  return options;
}

/// Adds the cell bounds of leaves, and the memory and time of measuring them.
void add_measuring(const RenderScene& scene, const FrameChunks& chunks, const Job& job, Kind& fur,
                   FrameEstimate& estimate) {
  const BoundingStrategy strategy = scene.render.bounds;
  if (!measures_strands(strategy)) return;
  size_t segments = 0, unknown = 0, block = 0;
  std::set<std::pair<uint64_t, uint64_t>> read;
  const auto ignore = [](const std::string&) {};
  for (uint32_t leaf = 0; leaf < chunks.leaves().size(); ++leaf) {
    const ChunkCounts n = chunks.counts(leaf);
    segments += n.segments;
    block = std::max(block, n.growth_bytes + measuring_bytes(chunks.leaves()[leaf]->counts()));
    const std::optional<BoundsRecord> record = chunks.leaves()[leaf]->bounds_record();
    if (record && read.contains({record->key.high, record->key.low})) continue;
    if (record && !read_bounds(*record, bound_span(strategy), bound_keys(strategy), ignore).empty())
      read.insert({record->key.high, record->key.low});
    else
      unknown += n.segments;
  }
  constexpr double kFineBytes = 0.25;  // per segment: SegmentCellBounds
  estimate.box_bytes += static_cast<int64_t>(kFineBytes * static_cast<double>(segments));
  estimate.measuring_bytes = static_cast<int64_t>(block) * job.workers.thread_count();
  estimate.measuring_cpu_s = fur.cpu_s * static_cast<double>(unknown) / std::max(1.0, double(segments));
}

void add_chunks(const RenderScene& scene, const FrameChunks& chunks, const Job& job, bool measures,
                FrameEstimate& estimate) {
  // The size of a chunk does not depend on its box. In a crowd, finding the real boxes takes longer than
  // everything else here.
  std::vector<ChunkBounds> boxes(chunks.size());
  for (size_t i = 0; i < boxes.size(); ++i) {
    const V3f corner(static_cast<float>(i), 0, 0);
    boxes[i].boxes = {Box3f(corner, corner + V3f(1))};
  }
  const ResidentChunks resident(std::move(boxes), chunks, options_of(scene, chunks, job), job);
  std::vector<double> weights;
  for (uint32_t chunk = 0; chunk < chunks.size(); ++chunk) {
    const ChunkCounts n = chunks.counts(chunk);
    weights.push_back(weight(n));
    estimate.strands += static_cast<int64_t>(n.strands);
  }
  const auto leaves = static_cast<uint32_t>(chunks.leaves().size());
  Kind fur{0, leaves}, skins{leaves, static_cast<uint32_t>(chunks.size())};
  sample(resident, weights, kSampledFur, job, fur);
  sample(resident, weights, kSampledSkins, job, skins);
  estimate.chunks = static_cast<int64_t>(chunks.size());
  estimate.box_bytes = static_cast<int64_t>(chunks.bytes() + resident.boxes().bytes_bound() +
                                            resident.boxes().tree()->bytes());
  const double growing = job.workers.thread_count() * std::max(fur.peak_bytes, skins.peak_bytes);
  estimate.chunk_bytes = static_cast<int64_t>(fur.bytes + skins.bytes + growing);
  estimate.growing_cpu_s = fur.cpu_s + skins.cpu_s;
  if (measures) add_measuring(scene, chunks, job, fur, estimate);
}

double sample_count(const RenderScene& scene, const PixelBox& pixels) {
  return double(pixels.width()) * pixels.height() * scene.render.samples;
}

/// Fraction of the memory of all chunks that rays need. It is below 1 only if there are few rays for each
/// chunk, as in a preview of a crowd.
double reached_fraction(const RenderScene& scene, const PixelBox& pixels, int64_t chunks) {
  const double rays = sample_count(scene, pixels) * 2 * (1 + scene.render.bounces);
  return 1 - std::exp(-rays / (kRaysToReach * static_cast<double>(std::max<int64_t>(1, chunks))));
}

double tracing_s(const RenderScene& scene, const PixelBox& pixels) {
  const RenderParams& render = scene.render;
  const double samples = sample_count(scene, pixels);
  return samples * (render.integrator == Integrator::kGather
                        ? kGatherSample_s
                        : kPathSample_s + kPathBounce_s * std::min(render.bounces, 4));
}

}  // namespace

ShadowEstimate estimate_shadows(const RenderScene& scene, const Job& job) {
  ShadowEstimate estimate;
  const SkinBallUse use = scene.render.ball_use(scene.skins.size());
  if (use != SkinBallUse::kOff && !scene.skins.empty()) add_balls(scene, job, estimate);
  return estimate;
}

int64_t FrameEstimate::peak_bytes() const {
  const int64_t tracing = chunk_bytes + shadows.held_bytes;
  const int64_t rendering =
      box_bytes + std::max(measuring_bytes, buffer_bytes + std::max(tracing, shadows.making_bytes));
  return std::max(preparing_bytes,
                  scene_bytes + library_bytes + film_bytes + std::max(rendering, writing_bytes));
}

FrameEstimate estimate_frame(const RenderScene& scene, const Job& job,
                             const std::optional<PixelBox>& region) {
  FrameEstimate estimate;
  job.ledger.set_limit(scene.render.memory.bytes);
  const FilmLayers layers = layers_of(scene);
  const FrameWindow window = frame_window(scene.image.width, scene.image.height, region, layers.splat);
  estimate.film_bytes = Film::bytes_needed(window.film.width(), window.film.height(), layers);
  estimate.film_bytes +=
      SamplePasses::bytes_needed(scene.render, int64_t{window.film.width()} * window.film.height());
  const MemoryCharge film = reserve(job.ledger, MemoryTag::kFilm, estimate.film_bytes, "the frame buffer");
  const int64_t before = job.ledger.budgeted();
  GatherTracer::Memory tiles;
  if (scene.render.integrator == Integrator::kGather) tiles = GatherTracer::reserve(scene, job);
  estimate.buffer_bytes = job.ledger.budgeted() - before;

  FrameChunks chunks(scene, job);
  trim_heap();
  estimate.scene_bytes = current_rss_bytes();
  estimate.preparing_bytes = peak_rss_bytes();
  const int64_t taken = job.ledger.budgeted();
  estimate.shadows = estimate_shadows(scene, job);
  const bool at_once = scene.render.bvh.file.empty() && chunks.grow_at_once(job);
  add_chunks(scene, chunks, job, !at_once, estimate);
  if (!at_once)
    estimate.chunk_bytes = static_cast<int64_t>(reached_fraction(scene, window.traced, estimate.chunks) *
                                                static_cast<double>(estimate.chunk_bytes));
  if (const int64_t limit = job.ledger.limit(); limit > 0) {
    const int64_t room =
        std::max<int64_t>(0, limit - taken - estimate.box_bytes - estimate.shadows.held_bytes);
    estimate.fits = estimate.chunk_bytes <= room;
    estimate.chunk_bytes = std::min(estimate.chunk_bytes, room);
  }
  estimate.library_bytes = kLibraries + kThread * job.workers.thread_count();
  MemoryLedger none;
  const std::vector<ExrChannel> channels = Film(1, 1, layers, none).exr_pixels({0, 0, 0, 0});
  estimate.writing_bytes =
      exr_writing_bytes(channels, window.region.width(), window.region.height(), job.workers.thread_count());
  estimate.tracing_cpu_s = tracing_s(scene, window.traced);
  estimate.writing_cpu_s =
      kWrittenValue_s * static_cast<double>(channels.size()) * window.region.width() * window.region.height();
  return estimate;
}

}  // namespace pelage
