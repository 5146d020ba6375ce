// SPDX-License-Identifier: Apache-2.0
#include "render/reflection/reflection_paths.h"

#include <cmath>
#include <optional>

#include "base/hash.h"
#include "render/reflection/reflection_cache.h"
#include "render/sampling/systematic_choice.h"

namespace pelage {

/// A sink of PathWalk: sums up the light that the third surface of a path reflects, by light, except the
/// light that shadow rays from this surface find.
class ReflectionPaths::Recorder {
 public:
  Recorder(const FrameScene& scene, const CellKeys& keys, const CellRange& range, std::vector<Rgb>& reflected)
      : scene_(scene), keys_(keys), range_(range), reflected_(reflected) {}

  Arrival arrive(PathState& path, const HitGeometry& hit_geometry) {
    if (path.vertex < ReflectionCache::kVertex) return Arrival::kPass;
    if (path.vertex > ReflectionCache::kVertex) return Arrival::kGoOn;
    cells_ = keys_.of(path.ray, path.hit, hit_geometry);
    if (cells_ && !range_.contains(*cells_)) cells_.reset();
    weight_ = luminance(path.weight);
    path.throughput = Rgb(1);  // from here on
    return cells_ ? Arrival::kPass : Arrival::kEnd;
  }
  uint32_t branches(const PathState& path) const {
    return path.vertex == ReflectionCache::kVertex ? kBranches : 1;
  }
  void shadow(const PathState& path, const LightPoint& from, float factor, float through) {
    if (path.vertex > ReflectionCache::kVertex && through > 0)
      reflected_[scene_.source(from.light)] +=
          path.throughput * from.value.total() * from.arriving * (through * factor);
  }
  void hit_light(const PathState& path, size_t light, const Rgb& radiance, float weight, float through) {
    if (path.vertex >= ReflectionCache::kVertex && weight * through > 0)
      reflected_[scene_.source(light)] += path.throughput * radiance * (weight * through);
  }
  /// Returns the cells of the third surface; empty where there is none, or no cell of the range.
  const std::optional<CellPath>& cells() const { return cells_; }
  /// Returns the fraction of the light of the third surface that reaches the camera.
  float weight() const { return weight_; }

 private:
  const FrameScene& scene_;
  const CellKeys& keys_;
  const CellRange& range_;
  std::vector<Rgb>& reflected_;
  std::optional<CellPath> cells_;
  float weight_ = 0;
};

ReflectionPaths::ReflectionPaths(const FrameScene& scene, const Accel& accel, const FrameShading& shading,
                                 const CameraSamples& camera, const PathOptions& options)
    : scene_(scene),
      accel_(accel),
      shading_(shading),
      camera_(camera),
      options_(options),
      keys_(scene),
      walk_(scene, accel, shading, options) {}

bool ReflectionPaths::trace(const Tile& tile, const Share& share, const Job& job, Scratch& scratch,
                            ReflectionTable& table) const {
  const uint64_t random =
      hash64(random_use("paths of reflections"), static_cast<uint64_t>(scene_.render.seed),
             static_cast<uint32_t>(tile.x0), static_cast<uint32_t>(tile.y0), share.round);
  const auto samples = static_cast<uint32_t>(std::ceil(share.paths));  // at most, of a pixel
  SystematicChoice choice(1, unit_float(random));
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      if (job.progress.cancelled()) return false;
      const uint32_t count = choice.times(static_cast<float>(share.paths));
      for (uint32_t i = 0; i < count; ++i)
        follow(x, y, samples * share.round + i, share.cells, scratch, table);
    }
  }
  return true;
}

void ReflectionPaths::follow(int x, int y, uint32_t sample, const CellRange& cells, Scratch& scratch,
                             ReflectionTable& table) const {
  SampleStream stream(hash64(random_use("reflections"), static_cast<uint64_t>(scene_.render.seed)),
                      static_cast<uint32_t>(x), static_cast<uint32_t>(y), sample);
  const CameraSample from = camera_.sample(x, y, sample, stream);
  const Hit hit = scratch.closest(RayKind::kCamera, accel_, from.ray);
  if (!hit) return;
  const ScatterPoint point = shading_.scatter_point(from.ray, hit, scratch.thread.hit_geometry);
  seek(stream, VertexDimension::kLobe);
  const auto scattered = point.sample(stream.next3d());
  if (!scattered) return;
  PathState path(stream);
  path.time = from.ray.time;
  path.random = from.ray.random;
  for (int g = 0; g < kLobeGroups; ++g) path.first[g] = scattered->value.lobes[g] / scattered->value.pdf;
  path.weight = scattered->value.total() / scattered->value.pdf;
  path.attraction = scattered->value.attraction;
  if (!(max_component(path.weight) > 0)) return;
  if (options_.roulette) {
    const float survived = PathWalk<Recorder>::survival(path.weight, path.attraction);
    seek(stream, VertexDimension::kRoulette);
    if (stream.next1d() >= survived) return;
    path.weight /= survived;
  }
  Ray ray;
  ray.origin = point.start(scattered->wi);
  ray.direction = scattered->wi;
  ray.time = path.time;
  if (!point.can_hit_own_strand()) ray.start = hit.start;
  scratch.reflected.assign(scene_.sources(), Rgb(0));
  Recorder recorder(scene_, keys_, cells, scratch.reflected);
  walk_.follow(ray, path, scratch.direct, scratch, recorder);
  if (!recorder.cells()) return;
  table.add(*recorder.cells(), recorder.weight(), scratch.reflected);
}

}  // namespace pelage
