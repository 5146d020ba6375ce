// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "base/vector.h"
#include "geom/strands.h"
#include "geom/tessellation.h"
#include "render/accel/trace_counts.h"

namespace pelage {

/// The strand that a ray starts from, in terms of the accelerator that met it (Hit::start): near the place
/// where the ray begins it is not met again.
struct StrandStart {
  static constexpr uint32_t kNone = ~0u;

  uint32_t chunk = kNone;      ///< which holds the strand; kNone: the ray starts elsewhere
  uint32_t first_segment = 0;  ///< of the strand in the chunk
  uint32_t segment_count = 0;
  float place = 0;  ///< segment of the strand + parameter in it
};

struct Ray {
  V3f origin{0};
  float near = 0;
  V3f direction{0, 0, 1};  ///< unit
  float far = std::numeric_limits<float>::infinity();
  float time = 0;  ///< in [0, 1] of the shutter
  uint32_t random =
      0;  ///< decides at which semi-transparent crossings closest() stops; unused when all is opaque
  StrandStart start = {};
};

enum class HitKind : uint8_t { kNone, kStrand, kSkin };

/// Where a ray meets geometry, by value: nothing of the accelerator is held by it.
struct Hit {
  HitKind kind = HitKind::kNone;
  float distance = std::numeric_limits<float>::infinity();
  uint32_t part = 0;       ///< which coat of which character, or which skin
  uint64_t strand_id = 0;  ///< within the part
  uint32_t segment = 0;    ///< of the strand
  float u = 0;  ///< curve parameter in the segment, or barycentric weight of the triangle's corner 1
  float v = 0;  ///< offset h in [-1, 1] across the strand, or barycentric weight of corner 2
  StrandStart start = {};  ///< for rays that go on from here

  explicit operator bool() const { return kind != HitKind::kNone; }
};

/// What a hit met, copied out of geometry that may be gone by the time the hit is shaded: the one strand with
/// its attributes, or the one triangle, each over all motion keys.
struct HitGeometry {
  Strands strand;
  SkinMesh triangle;
};

/// What one thread needs while it traces.
struct TraceThread {
  int worker = 0;   ///< no two threads that trace at once have the same
  HitGeometry met;  ///< of the last hit that closest() gave this thread
  TraceCounts counts;
};

/// Rays against all strands and skins of a frame.
///
/// A hit is a function of the ray and of what it meets alone: equal distances are decided by strand id (then
/// by part and segment), so that neither the number of threads nor the shape of the tree reaches a pixel (law
/// 1). h is that of the fibre frame: with T the tangent and ez = normalize(T x -direction), the hit lies at
/// axis - h * radius * ez. Rays that are not finite meet nothing.
/// Thread safety: const members may be called from many threads at once, each inside a FlushDenormals scope.
class Accel {
 public:
  virtual ~Accel() = default;
  /// The nearest hit in (near, far). Semi-transparent crossings are passed with probability 1 - opacity, each
  /// crossing deciding once by a hash of `ray.random`, the strand and the place on it.
  /// What is hit is left in `thread.met`.
  virtual Hit closest(const Ray& ray, TraceThread& thread) const = 0;
  /// The part of light that comes through between near and far: the product of 1 - opacity over all
  /// crossings.
  virtual float transmittance(const Ray& ray, TraceThread& thread) const = 0;
  /// Whether everything is opaque; then transmittance() is 0 or 1.
  virtual bool opaque() const = 0;
  virtual Box3f bounds() const = 0;
};

}  // namespace pelage
