// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "lod/lod_view.h"
#include "render/accel/accel.h"
#include "render/scene/render_scene.h"

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
  explicit CellKeys(const RenderScene& scene) : scene_(scene), view_(scene.camera.lod_view()) {}

  /// Returns the cells of the hit of a ray. `met`: the geometry that was hit. Empty where a cell cannot hold
  /// the reflected light: on glossy skins, which scatter too narrow a lobe.
  std::optional<CellPath> of(const Ray& ray, const Hit& hit, const HitGeometry& met) const;

 private:
  const RenderScene& scene_;
  const LodView view_;
};

}  // namespace pelage
