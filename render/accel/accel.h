// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "base/vector.h"
#include "geom/strands.h"
#include "geom/tessellation.h"
#include "render/accel/crossings.h"
#include "render/accel/strand_handle.h"
#include "render/accel/trace_counts.h"
#include "render/light/part_set.h"

namespace pelage {

/// The strand from which a ray starts, as identified by the accelerator (Hit::start). Near its start, the ray
/// does not hit this strand again.
struct StrandStart {
  static constexpr uint32_t kNone = StrandHandle::kNone;

  uint32_t chunk = kNone;      ///< chunk that holds the strand; kNone: the ray does not start on a strand
  uint32_t first_segment = 0;  ///< index of the strand's first segment in the chunk
  uint32_t segment_count = 0;
  float place = 0;  ///< index of the segment in the strand + curve parameter in that segment
};

struct Ray {
  V3f origin{0};
  float near = 0;
  V3f direction{0, 0, 1};  ///< unit
  float far = std::numeric_limits<float>::infinity();
  float time = 0;       ///< shutter time: 0 at shutter open, 1 at shutter close
  uint32_t random = 0;  ///< determines at which semi-transparent crossings closest() stops; unused when
                        ///< everything is opaque
  StrandStart start = {};
  /// Whether this is a shadow ray or an indirect ray, for which an accelerator may simplify strands
  /// (ResidentChunksOptions). Rays that decide what the camera sees are not secondary.
  bool secondary = false;
  /// The coats and skins that block a shadow ray; null: all. closest() ignores it.
  const PartSet* casters = nullptr;
};

enum class HitKind : uint8_t { kNone, kStrand, kSkin };

/// Intersection of a ray with geometry. A value that holds no reference to the accelerator.
struct Hit {
  HitKind kind = HitKind::kNone;
  float distance = std::numeric_limits<float>::infinity();
  uint32_t part = 0;       ///< index of the coat or of the skin in the frame
  uint64_t strand_id = 0;  ///< unique within the part
  uint32_t segment = 0;    ///< index of the segment in the strand
  float u = 0;  ///< curve parameter in the segment, or barycentric weight of the triangle's corner 1
  float v = 0;  ///< offset h in [-1, 1] across the strand, or barycentric weight of corner 2
  StrandStart start = {};     ///< value of Ray::start for rays that continue from this hit
  uint32_t strand_index = 0;  ///< index of the strand in the chunk `start.chunk`

  explicit operator bool() const { return kind != HitKind::kNone; }
  /// Locates the strand that was hit. Empty for a skin, or if the accelerator has no chunks.
  StrandHandle handle() const { return {start.chunk, strand_index}; }
  /// Identifies the strand that was hit. Meaningless for a skin.
  StrandKey key() const { return {part, strand_id}; }
};

/// The geometry that was hit, copied because its chunk may be evicted before the hit is shaded: one strand
/// with its attributes, or one triangle, with all motion keys.
struct HitGeometry {
  Strands strand;
  SkinMesh triangle;
};

/// Per-thread state of tracing.
struct TraceThread {
  int worker = 0;            ///< unique among the threads that trace concurrently
  HitGeometry hit_geometry;  ///< geometry of the last hit that closest() found for this thread
  TraceCounts counts;
};

/// Intersection of rays with all strands and skins of a frame.
///
/// A hit is a function of the ray and the geometry only. Of two strands at the same distance, the strand with
/// the smaller id is hit; ties of the id are broken by part, then by segment. A strand precedes a skin. So
/// neither the number of threads nor the shape of the tree affects a pixel (law 1). h is defined in the fibre
/// frame: with the tangent T and ez = normalize(T x -direction), the hit point is axis - h * radius * ez.
/// Non-finite rays hit nothing. Thread safety: const members may be called from many threads at once, each
/// inside a FlushDenormals scope.
class Accel {
 public:
  virtual ~Accel() = default;
  /// Returns the nearest hit in (near, far), or an empty hit. Skips a semi-transparent crossing with
  /// probability 1 - opacity. The decision is a hash of `ray.random` and the crossing (see CrossingPlace), so
  /// it is the same whenever the crossing is tested. Stores the geometry of the hit in `thread.hit_geometry`.
  virtual Hit closest(const Ray& ray, TraceThread& thread) const = 0;
  /// Returns the fraction of light transmitted between near and far: the product of 1 - opacity over all
  /// crossings.
  virtual float transmittance(const Ray& ray, TraceThread& thread) const = 0;
  /// Returns the strands between near and far, with opacity instead of a screen door. The ray ends at a skin,
  /// and where the sum of opacities exceeds `max` (at least 1) and less than 3 % of the light meets no
  /// strand: StrandCount::strands is then infinite.
  virtual StrandCount strands_crossed(const Ray& ray, uint32_t max, TraceThread& thread) const = 0;
  /// Whether everything is opaque; then transmittance() is 0 or 1.
  virtual bool opaque() const = 0;
  virtual Box3f bounds() const = 0;
};

}  // namespace pelage
