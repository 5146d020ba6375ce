// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "geom/strands.h"
#include "geom/tessellation.h"
#include "render/accel/accel.h"
#include "render/camera/camera.h"
#include "render/scene/gather_params.h"

namespace pelage {

/// Identifies a knot: a position on a strand or skin. Samples that see the strand or skin near a knot share
/// light.
struct KnotKey {
  uint64_t knot = 0;
  uint64_t zone = 0;  ///< the part of a coat or the skin that the knot lies in: see KnotKeys
};

/// Knots of the hits of a frame.
///
/// A strand has 2^level + 1 knots at equal distances of its parameter. The level follows from the length of
/// the strand in the picture when the shutter opens. Each face of a skin has a grid of knots, whose levels
/// follow from its size in the picture. A hit between knots belongs to one of them, chosen with a probability
/// equal to its linear interpolation weight: on average, light is interpolated linearly.
///
/// Each coat has eight zones, from the roots to the tips; a skin is one zone. About the same fraction of a
/// light arrives at all knots of a zone in the same small part of the picture.
///
/// A key is a function of the camera and the hit only. Thread safety: const members from any thread.
class KnotKeys {
 public:
  /// Keeps references to its arguments.
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
