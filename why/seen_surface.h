// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "render/accel/accel.h"
#include "render/scene/render_scene.h"

namespace pelage {

/// A surface that a camera sample of a pixel hits first.
struct SeenSurface {
  Ray ray;
  Hit hit;
  HitGeometry hit_geometry;  ///< the strand or the triangle of the hit
};

/// How many camera samples of a pixel see a strand, a skin, or nothing.
struct SeenCount {
  std::string name;                ///< of the coat or skin; empty for nothing
  std::optional<uint64_t> strand;  ///< id of the strand; empty for a skin and for nothing
  uint32_t samples = 0;
};

/// What the camera samples of a pixel see.
struct SeenSurfaces {
  /// The surface from which the picture takes the pixel's id, depth and normal (FrontSurface); empty if it
  /// takes them from a sample that hits nothing.
  std::optional<SeenSurface> front;
  std::vector<SeenCount> counts;  ///< the most frequent first
};

/// Traces the camera rays of the first `samples` samples of a pixel again. `splatted`: whether the samples
/// are splatted (FilmLayers::splat).
SeenSurfaces find_seen_surfaces(const RenderScene& scene, const Accel& accel, bool splatted, int x, int y,
                                uint32_t samples);

}  // namespace pelage
