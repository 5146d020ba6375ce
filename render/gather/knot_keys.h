// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "geom/strands.h"
#include "geom/tessellation.h"
#include "render/accel/accel.h"
#include "render/camera/camera.h"
#include "render/scene/gather_params.h"

namespace pelage {

/// Identifies a knot: a place on a strand or skin whose light is shared by the samples that see its
/// surroundings.
struct KnotKey {
  uint64_t knot = 0;
  uint64_t layer = 0;  ///< the knots of one coat at about the same distance from the root, or of one skin
};

/// Knots of the hits of a frame.
///
/// A strand has 2^level + 1 knots at equal distances of its parameter. The level follows from the length of
/// the strand in the picture when the shutter opens. Each face of a skin has a grid of knots, whose levels
/// follow from its size in the picture. A hit between knots belongs to one of them, chosen with the
/// probability of its linear weight: on average, light is interpolated linearly.
///
/// A key is a function of the camera and the hit only. Thread safety: const members from any thread.
class KnotKeys {
 public:
  /// References are kept.
  KnotKeys(const Camera& camera, const GatherParams& params) : camera_(camera), params_(params) {}

  /// `random`: two random numbers in [0, 1), which select among neighbouring knots.
  KnotKey of(const Hit& hit, const HitGeometry& met, const V2f& random) const;

 private:
  KnotKey on_strand(const Hit& hit, const Strands& strand, float random) const;
  KnotKey on_skin(const Hit& hit, const SkinMesh& triangle, const V2f& random) const;
  float length_in_picture(const Strands& strand) const;

  const Camera& camera_;
  const GatherParams& params_;
};

}  // namespace pelage
