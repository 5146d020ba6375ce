// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>

#include "cache/residency.h"
#include "render/accel/accel.h"
#include "render/accel/beam.h"
#include "render/accel/crossings.h"
#include "render/accel/fur/fur_ray.h"
#include "render/accel/primitive_sink.h"

namespace pelage {

/// The nearest hit of a ray so far, over all visited chunks.
struct NearestSoFar {
  Hit hit;
  uint32_t face = 0;      ///< ptex face of a hit on a skin
  uint32_t triangle = 0;  ///< index in the chunk of the triangle, for a hit on a skin; every chunk stores the
                          ///< triangles of a face in the same order

  /// Returns the sort key that breaks ties in distance. Strands precede skins. Hits on strands are ordered by
  /// strand id, then part, then segment. Hits on skins are ordered by part, then face, then triangle.
  auto rank() const {
    return std::tuple(hit.kind, hit.strand_id, hit.part, hit.kind == HitKind::kSkin ? face : hit.segment,
                      triangle);
  }
  /// Whether `other` precedes this hit.
  bool comes_after(const NearestSoFar& other) const {
    if (other.hit.distance != hit.distance) return other.hit.distance < hit.distance;
    return !hit || other.rank() < rank();
  }
};

/// The content of a resident chunk, for ray tracing and for access strand by strand. Thread safety: const
/// members from any thread, each inside a FlushDenormals scope.
class ChunkGeometry : public Resident {
 public:
  /// Finds the nearest hit on this chunk between the ray's near and far ends. If that hit precedes `nearest`,
  /// stores the hit in `nearest` and its geometry in `hit_geometry`, and returns true. Otherwise changes
  /// neither and returns false. Pass the same `rays` for all chunks that one ray visits.
  virtual bool closest(const Ray& ray, FurRays& rays, NearestSoFar& nearest,
                       HitGeometry& hit_geometry) const = 0;
  /// Passes to the sink, as the camera sees them, all primitives that may lie inside the beam at depths below
  /// `sink.far()`, and possibly others. Returns false if the chunk does not support this; then the sink got
  /// nothing.
  virtual bool visit_primitives(const Beam& beam, PrimitiveSink& sink) const = 0;
  /// Finds the hits of camera rays that are known to meet one segment first. Stores one hit per ray in
  /// `hits`; the hit is empty if the ray misses the segment. If the ray meets no other segment before, its
  /// hit has the same bits as that of closest(). `segment`: the number that was passed to the sink. `rays`:
  /// at most kMaxRays, which start on no strand.
  static constexpr size_t kMaxRays = 16;
  virtual void closest_at(std::span<const Ray* const> rays, uint32_t segment, Hit* hits) const = 0;
  /// Adds the semi-transparent crossings of a ray to `crossings`. Returns false if an opaque crossing blocks
  /// the ray. If `crossings` counts strands, adds all crossings with strands, and returns false if there are
  /// too many.
  virtual bool collect(const Ray& ray, FurRays& rays, Crossings& crossings) const = 0;
  /// Whether a camera ray with the random number `random` stops at a hit with a segment at the parameter `u`.
  virtual bool stops(uint32_t random, uint32_t primitive, float u) const = 0;
  /// Whether every primitive stops every camera ray.
  virtual bool opaque() const = 0;

  /// Number of strands with at least one segment; 0 for a skin.
  virtual size_t strand_count() const = 0;
  virtual StrandKey strand_key(uint32_t index) const = 0;
  /// Copies strand `index` to `out`, replacing the contents of `out` but reusing its memory. The copy is the
  /// curve that rays hit, at all motion keys, in world space, with its id, root and attributes. Bit-identical
  /// to the strand that closest() stores in `hit_geometry`.
  virtual void strand(uint32_t index, Strands& out) const = 0;
  /// Returns Ray::start for a ray that leaves strand `index` at `place` (see StrandStart::place).
  virtual StrandStart start_on(uint32_t index, float place) const = 0;

  /// Bytes of memory in use, including this object.
  virtual size_t bytes() const = 0;
  /// Max bytes of memory in use while this chunk was made.
  virtual size_t build_peak_bytes() const = 0;
};

}  // namespace pelage
