// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "geom/strands.h"
#include "geom/tessellation.h"
#include "render/accel/accel.h"
#include "render/camera/camera.h"
#include "render/gather/coat_cells.h"
#include "render/gather/strand_knots.h"
#include "render/scene/frame_scene.h"

namespace pelage {

/// Identifies a knot, its patch and its zone. A knot is a position on a strand or skin, or a cell of a coat
/// (see CoatCells). Samples that see the surroundings of the same knot share light. A patch is a part of a
/// coat, a few pixels long and wide, or a single knot of a skin; about the same indirect light arrives at its
/// knots. A zone is one of eight depth ranges of a coat, or a whole skin.
struct KnotKey {
  uint64_t knot = 0;
  uint64_t patch = 0;
  uint64_t zone = 0;
};

/// Assigns the hits of a frame to knots.
///
/// A strand has 2^level + 1 knots, at equal distances of its parameter. The level follows from the length of
/// the strand in the picture when the shutter opens. Each face of a skin has a grid of knots; the levels
/// along its two parameters follow from the size of the face in the picture. A hit between knots is assigned
/// at random to one of the knots around it. The probability of a knot is its linear interpolation weight. On
/// average, light is therefore interpolated linearly between knots. Strands so thin that fewer
/// than four samples would see a knot are assigned to the cells of their coat instead.
///
/// The knots of a coat whose strands grow in the same cube of the skin (CoatCells::patch()) are in one patch
/// if they are at the same eighth of a strand or, on strands with more than 17 knots, at the
/// same pair of knots.
///
/// Each coat has eight zones, from the roots to the tips. Each skin is one zone. At the knots of one zone
/// within the same tile of the picture, about the same fraction of a light arrives.
///
/// A key depends only on the camera, the hit and the random numbers. Thread safety: const members may be
/// called from any thread.
class KnotKeys {
 public:
  /// Keeps a reference to `scene`. `samples`: max samples per pixel that are rendered at once.
  KnotKeys(const FrameScene& scene, uint32_t samples);

  /// Returns the knot that a hit is assigned to. `random`: two random numbers in [0, 1), which select one of
  /// the knots around the hit.
  /// `recent`: of the calling thread.
  KnotKey of(const Hit& hit, const HitGeometry& met, const V2f& random, RecentStrandKnots& recent) const;

 private:
  StrandKnots knots_of(const Hit& hit, const Strands& strand) const;
  KnotKey on_strand(const Hit& hit, const Strands& strand, const StrandKnots& knots, const V2f& random) const;
  KnotKey on_skin(const Hit& hit, const SkinMesh& triangle, const V2f& random) const;

  const Camera& camera_;
  const GatherParams& params_;
  CoatCells cells_;
};

}  // namespace pelage
