// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/accel/embree_chunk_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <tuple>

#include "cache/residency.h"
#include "render/accel/accel.h"
#include "render/accel/crossings.h"
#include "render/accel/fur/fur_ray.h"

namespace pelage {

/// The nearest hit that a ray has so far, over all chunks that it visited.
struct NearestSoFar {
  Hit hit;
  uint32_t face = 0;      ///< ptex face, of a skin's hit
  uint32_t triangle = 0;  ///< of the chunk, of a skin's hit; in the same order in every chunk with the face

  /// What decides between equal distances: strands before skins, then strand id, part, segment, or face and
  /// triangle.
  auto rank() const {
    return std::tuple(hit.kind, hit.strand_id, hit.part, hit.kind == HitKind::kSkin ? face : hit.segment,
                      triangle);
  }
  /// Whether `other` comes before it.
  bool comes_after(const NearestSoFar& other) const {
    if (other.hit.distance != hit.distance) return other.hit.distance < hit.distance;
    return !hit || other.rank() < rank();
  }
};

/// What a chunk holds while it is resident, ready for rays. Thread safety: const members from any thread,
/// each inside a FlushDenormals scope.
class ChunkGeometry : public Resident {
 public:
  /// Whether the ray meets something here between near and far that stands before `nearest`, which then
  /// becomes that; `met` its geometry. `rays` is kept from chunk to chunk.
  virtual bool closest(const Ray& ray, FurRays& rays, NearestSoFar& nearest, HitGeometry& met) const = 0;
  /// Adds the semi-transparent crossings of a ray; false when something opaque blocks it.
  virtual bool collect(const Ray& ray, FurRays& rays, Crossings& crossings) const = 0;
  /// What is held, this object included.
  virtual size_t bytes() const = 0;
  /// Most that was held while it was made.
  virtual size_t build_peak_bytes() const = 0;
};

}  // namespace pelage
