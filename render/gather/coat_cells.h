// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "lod/lod_view.h"
#include "render/accel/accel.h"
#include "render/scene/render_scene.h"

namespace pelage {

/// Returns the least level at which 2^level parts of `length` are no longer than `spacing`, but at most 20.
inline int level_of(float length, float spacing) {
  constexpr int kMaxLevel = 20;
  if (!(length > spacing)) return 0;
  return std::min(static_cast<int>(std::ceil(std::log2(length / spacing))), kMaxLevel);
}

/// Chooses one of the two gather points around `place`. There are 2^level + 1 gather points in [0, 1]. The
/// nearer one is more likely. `random`: in [0, 1).
inline uint32_t gather_point_near(float place, int level, float random) {
  const float scaled = std::clamp(place, 0.0f, 1.0f) * static_cast<float>(1 << level);
  const float before = std::floor(scaled);
  return static_cast<uint32_t>(before) + (random < scaled - before ? 1 : 0);
}

/// Returns a number that identifies a gather point among the gather points of all levels.
inline uint64_t pack(int level, uint32_t gather_point) {
  return static_cast<uint64_t>(level) << 32 | gather_point;
}

/// Assigns hits on thin strands to cells of the coat. Neighbouring strands in the same cell share light.
///
/// A cell belongs to one coat. It is a cube of a grid over the skin at rest, which contains the roots of the
/// strands, for one of six directions of the skin's normal, and a part of the length of these strands. In the
/// rest pose, parts of a skin that touch when posed are far apart, and the two sides of an ear have opposite
/// normals. So cells do not join strands that are close in space but not on the skin.
///
/// The side of a cube is a power of two, and so is the number of parts of a strand. Cubes and parts are at
/// most kPixels pixels long in the picture. Like gather points, cells overlap by half: a hit is assigned at
/// random to one of the cells around it, so that on average, light is interpolated linearly.
///
/// A key depends only on the camera, the hit and the random number. Thread safety: const members may be
/// called from any thread.
class CoatCells {
 public:
  static constexpr float kPixels = 2;
  static constexpr float kPatchPixels = 4;

  /// Keeps a reference to `fur`. `samples`: samples per pixel that share light.
  CoatCells(const Camera& camera, const std::vector<FurPart>& fur, float samples);

  /// Returns the expected number of samples that would see a part of the strand, `length` pixels long, if
  /// nothing hid it. Uses the mean width of the strand.
  float samples_on(const Strands& strand, float length) const;
  /// Returns the key of a cell. `length`: of the strand in the picture, in pixels. `place`: of the hit on the
  /// strand, in [0, 1].
  uint64_t key(const Hit& hit, const Strands& strand, float length, float place, uint64_t random) const;
  /// Returns the key of the patch of a strand. Patches are cubes of the skin at rest, like the cubes of
  /// cells, but up to kPatchPixels large. They overlap by half: a random number of the strand chooses one of
  /// the cubes around its root.
  uint64_t patch(const Hit& hit, const Strands& strand) const;

 private:
  uint64_t cube(const Hit& hit, const Strands& strand, float side, uint64_t random) const;

  const std::vector<FurPart>& fur_;
  LodView view_;
  float samples_;
};

}  // namespace pelage
