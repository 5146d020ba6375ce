// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/hash.h"
#include "geom/strands.h"
#include "geom/tessellation.h"
#include "render/accel/accel.h"
#include "render/accel/strand_handle.h"
#include "render/camera/camera.h"
#include "render/gather/coat_cells.h"
#include "render/gather/zones.h"
#include "render/scene/frame_scene.h"

namespace pelage {

/// What the gather points of a strand depend on. The same for all hits on the strand.
struct StrandGatherPoints {
  float length = 0;       ///< of the control polygon in the picture when the shutter opens, in pixels
  int level = 0;          ///< the strand has 2^level + 1 gather points
  bool in_cells = false;  ///< whether its hits are assigned to the cells of the coat instead
  uint64_t patch = 0;     ///< CoatCells::patch()
};

/// Keeps the StrandGatherPoints of the strands that a thread looked up last, because samples of neighbouring
/// pixels often see the same strands. Belongs to one frame.
class RecentGatherPoints {
 public:
  /// Returns the gather points of a strand. Calls make() if they are not kept.
  template <class Make>
  const StrandGatherPoints& of(const StrandKey& strand, const Make& make) {
    Kept& kept = kept_[hash64(strand.part, strand.id) % kCount];
    if (!kept.is_used || kept.strand != strand) kept = {strand, make(), true};
    return kept.gather_points;
  }
  static constexpr size_t bytes() { return kCount * sizeof(Kept); }

 private:
  static constexpr size_t kCount = 1024;
  struct Kept {
    StrandKey strand;
    StrandGatherPoints gather_points;
    bool is_used = false;
  };

  std::vector<Kept> kept_ = std::vector<Kept>(kCount);
};

/// Identifies a gather point, its patch and its zone, and says how deep in the coat the hit is. A gather
/// point is a position on a strand or skin, or a cell of a coat (see CoatCells). Visible points near the same
/// gather point share light. A patch is a part of a coat, a few pixels long and wide, or a single gather
/// point of a skin. About the same indirect light arrives at all gather points of a patch. A zone is one of
/// eight depth ranges of a coat, or a whole skin.
struct GatherPointKey {
  uint64_t gather_point = 0;
  uint64_t patch = 0;
  uint64_t coat = 0;  ///< the coat or the skin
  uint32_t zone = 0;  ///< of the gather point, counted from the roots; 0 on skins
  /// Of the hit, from 0 at the root to 1 at the tip; the middle of zone 0 on skins.
  float depth = 0.5f / kZonesOfCoat;
};

/// Assigns the hits of a frame to gather points.
///
/// A strand has 2^level + 1 gather points, at equal distances of its parameter. The level follows from the
/// length of the strand in the picture when the shutter opens. Each face of a skin has a grid of gather
/// points; the levels along its two parameters follow from the size of the face in the picture, as it would
/// be if all of the face were as far from the camera as the hit. A hit is assigned at random to one of the
/// gather points around it, with its weight in linear interpolation as probability. On average, light is
/// therefore interpolated linearly between gather points. If a strand is so thin that fewer than four samples
/// would see one of its gather points, its hits are assigned to the cells of its coat instead.
///
/// Gather points on strands that grow in the same cube of the skin (CoatCells::patch()) are in one patch if
/// they lie in the same eighth of their strands. On strands with more than 17 gather points, each pair of
/// neighbouring gather points takes the place of an eighth.
///
/// Each coat has eight zones, from the roots to the tips. Each skin is one zone. At the gather points of one
/// zone within the same tile of the picture, about the same fraction of a light arrives.
///
/// A key depends only on the camera, the hit and the random numbers. Thread safety: const members may be
/// called from any thread.
class GatherPointKeys {
 public:
  /// Keeps a reference to `scene`. `samples`: max samples per pixel that are rendered at once.
  GatherPointKeys(const FrameScene& scene, uint32_t samples);

  /// Returns the gather point that a hit is assigned to. `random`: two random numbers in [0, 1), which select
  /// one of the gather points around the hit.
  /// `recent`: of the calling thread.
  GatherPointKey of(const Hit& hit, const HitGeometry& hit_geometry, const V2f& random,
                    RecentGatherPoints& recent) const;

 private:
  StrandGatherPoints gather_points_of(const Hit& hit, const Strands& strand) const;
  GatherPointKey on_strand(const Hit& hit, const Strands& strand, const StrandGatherPoints& gather_points,
                           const V2f& random) const;
  GatherPointKey on_skin(const Hit& hit, const SkinMesh& triangle, const V2f& random) const;

  const Camera& camera_;
  const LodView view_;
  const GatherParams& params_;
  CoatCells cells_;
};

}  // namespace pelage
