// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/error.h"
#include "render/accel/flush_denormals.h"
#include "render/accel/fur_chunk_file.h"
#include "render/accel/part_bounds.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/fuzz/right_checksums.h"

namespace pelage {
namespace {

constexpr size_t kMaxChunks = 16;

/// Through the middle of a chunk, each a little beside the others.
Ray ray_at(const V3f& middle, float size, int i) {
  const auto k = static_cast<float>(i);
  Ray ray;
  ray.direction = V3f(0.3f * std::sin(k), 0.3f * std::cos(2 * k), -1).normalized();
  ray.origin =
      middle + size * (V3f(0.1f * std::sin(3 * k), 0.1f * std::cos(5 * k), 0) - 2.0f * ray.direction);
  ray.time = 0.1f * k;
  ray.random = 0x9e3779b9u * static_cast<uint32_t>(i);
  return ray;
}

void trace(const FurChunk& chunk, const Ray& ray) {
  HitGeometry hit_geometry;
  Ray here = ray;
  // A hit, and what is met from there.
  for (int bounce = 0; bounce < 2; ++bounce) {
    FurRays rays;
    NearestSoFar nearest;
    if (chunk.closest(here, rays, nearest, hit_geometry)) {
      const Hit& hit = nearest.hit;
      PELAGE_CHECK(hit.kind == HitKind::kStrand && hit.distance >= here.near && hit.distance <= here.far);
      PELAGE_CHECK(hit_geometry.strand.strand_count() == 1 && hit_geometry.strand.id(0) == hit.strand_id);
      PELAGE_CHECK(3 * hit.segment + 4 <= hit_geometry.strand.strand_points(0));
    }
    Crossings crossings;
    FurRays others;
    chunk.collect(here, others, crossings);
    const float light = crossings.transmittance();
    PELAGE_CHECK(light >= 0 && light <= 1);
    if (!nearest.hit) return;
    here.origin += nearest.hit.distance * here.direction;
    if (!std::isfinite(here.origin.length())) return;
    here.start = nearest.hit.start;
    here.direction = V3f(-here.direction.z, here.direction.x, here.direction.y);
  }
}

void use(const FurChunk& chunk) {
  const FurTree& tree = chunk.tree();
  const auto place = [&](float low, float high, int axis) {
    return static_cast<float>(tree.view().anchor[axis] + 0.5 * (double(low) + high) * tree.view().step);
  };
  V3f middle(0);
  float size = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<size_t>(axis);
    const float at = place(tree.box().low[a], tree.box().high[a], axis);
    if (std::isfinite(at)) middle[axis] = at;
    size = std::max(size, (tree.box().high[a] - tree.box().low[a]) * tree.view().step);
  }
  if (!std::isfinite(size)) size = 1;
  for (int i = 0; i < 8; ++i) trace(chunk, ray_at(middle, size, i));
  if (!tree.view().nodes) return;
  for (size_t axis = 0; axis < 3; ++axis) PELAGE_CHECK(tree.box().low[axis] <= tree.box().high[axis]);
  PELAGE_CHECK(PartBoxes(chunk.part_bounds(4)).count() >= 1);
}

void feed(std::span<const uint8_t> bytes) {
  try {
    const FurChunkFile file{StoredSections(fuzz_file(bytes, ".cache"))};
    const size_t chunks = std::min(file.chunk_count(), kMaxChunks);
    for (uint32_t c = 0; c < chunks; ++c) {
      if (!file.has(c)) continue;
      const std::unique_ptr<FurChunk> chunk = file.read(c, [](const std::string&) {});
      PELAGE_CHECK((chunk != nullptr) == file.has(c));
      if (!chunk) continue;
      PELAGE_CHECK(chunk->bytes() <= file.bytes_bound(c));
      use(*chunk);
    }
  } catch (const Error& error) {
    PELAGE_CHECK(error.kind() == ErrorKind::kInput);
  }
}

}  // namespace

void fuzz_chunks(std::span<const uint8_t> bytes) {
  const FlushDenormals flush;
  feed(bytes);
  feed(with_right_checksums(bytes));
}

}  // namespace pelage
