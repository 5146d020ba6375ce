// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "lod/lod_view.h"
#include "render/accel/accel.h"
#include "render/scene/frame_scene.h"

namespace pelage {

/// The cells of the reflection cache that contain a hit, from the smallest to the largest.
using CellPath = std::array<uint64_t, 3>;

/// Assigns hits to cells of the reflection cache.
///
/// A cell belongs to one coat or skin. It is a cube of a grid over the skin at rest, for one of six
/// directions of the skin's normal, a part of the length of the strands that grow there, and an octant of the
/// directions from which rays arrive. In the rest pose, parts of a skin that touch when posed are far apart,
/// and the two sides of an ear have opposite normals; the inside of a skin has cells of its own. So cells do
/// not join surfaces that are close in space but not on the skin. The sides of the cubes are powers of two;
/// the smallest cubes are at most kPixels pixels large in the picture, and the next sizes are two and eight
/// times as large. Larger cells also have longer parts of strands, so that hair that passes from light into
/// the dark is divided finely where there are many paths.
///
/// A key depends only on the camera, the ray and its hit. Thread safety: const members may be called from any
/// thread.
class CellKeys {
 public:
  static constexpr float kPixels = 8;
  /// A strand has at least this many parts, and at most 128. No part is longer than kPartPixels in the
  /// smallest cells, twice this length in the next larger cells, and four times this length in the largest
  /// cells.
  static constexpr uint32_t kMinParts = 4;
  static constexpr float kPartPixels = 4;

  /// Keeps a reference to `scene`.
  explicit CellKeys(const FrameScene& scene) : scene_(scene), view_(scene.camera.lod_view()) {}

  /// Returns the cells of the hit of a ray. `hit_geometry`: the geometry that was hit. Empty where a cell
  /// cannot hold the reflected light: on glossy skins, which scatter too narrow a lobe.
  std::optional<CellPath> of(const Ray& ray, const Hit& hit, const HitGeometry& hit_geometry) const;

 private:
  const FrameScene scene_;
  const LodView view_;
};

/// A slice of the cells of the reflection cache: those whose largest cell has a key in a range. A cell and
/// the larger cells around it are always in the same slice. Keys are hashes, so a quarter of all keys has
/// about a quarter of all cells. A range is counted in units of 2^32 keys.
class CellRange {
 public:
  static constexpr uint64_t kAll = uint64_t{1} << 32;

  /// Makes the first range. `length`: max length of each range, 1 to kAll.
  explicit CellRange(uint64_t length = kAll) : length_(length), most_(length) {}

  bool contains(const CellPath& cells) const {
    const uint64_t at = cells.back() >> 32;
    return at >= first_ && at - first_ < length_;
  }
  bool is_all() const { return first_ == 0 && length_ >= kAll; }
  /// Returns whether no keys are left: advance() has passed the last one.
  bool is_over() const { return first_ >= kAll; }
  /// Returns the part of all keys that is before this range.
  double share_before() const { return static_cast<double>(first_) / static_cast<double>(kAll); }
  /// Returns the part of all keys that is before the end of this range, at most 1.
  double share_done() const {
    const uint64_t end = first_ + length_;
    return end < kAll ? static_cast<double>(end) / static_cast<double>(kAll) : 1.0;
  }
  /// Returns whether halve() can be called: not where a range is so short that few largest cells are left.
  bool can_halve() const { return length_ > kAll >> 12; }
  void halve() { length_ = (length_ + 1) / 2; }
  /// Moves on to the keys after this range. If this range was halved, the next range is twice as long.
  void advance() {
    first_ += length_;
    length_ = length_ < most_ / 2 ? 2 * length_ : most_;
  }

 private:
  uint64_t first_ = 0, length_, most_;
};

}  // namespace pelage
