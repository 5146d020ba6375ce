// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "render/accel/accel.h"
#include "render/film/film.h"
#include "render/path/frame_geometry.h"
#include "render/path/scatter_point.h"

namespace pelage {

/// Turns hits into what the materials of a scene make of them. Refers to both for as long as it lives.
/// Thread safety: const members may be called from any thread.
class FrameShading {
 public:
  FrameShading(const RenderScene& scene, const FrameGeometry& geometry);

  ScatterPoint scatter_point(const Ray& ray, const Hit& hit) const;
  /// What the film keeps of the first surface of a path.
  VisibleSurface visible_surface(const Ray& ray, const Hit& hit) const;

 private:
  struct Fibre {
    ConeShellMaterial shells;
    Field color;
    std::optional<Rgb> constant_color;
  };
  struct Skin {
    Field color;
    std::optional<Rgb> constant_color;
    std::optional<GlossyParams> coat;  // none: Lambert
  };

  ScatterPoint fibre_point(const Ray& ray, const Hit& hit) const;
  ScatterPoint skin_point(const Ray& ray, const Hit& hit) const;
  Rgb fibre_color(const Fibre& fibre, const FurBatch& batch, const Hit& hit, float v) const;
  Rgb skin_color(const SkinPart& part, const Skin& skin, const Hit& hit) const;
  V2f motion_in_image(const V3f& position, const V3f& shutter_motion, float time) const;

  const RenderScene& scene_;
  const FrameGeometry& geometry_;
  std::vector<std::optional<Fibre>> fibres_;  // by material
  std::vector<std::optional<Skin>> skins_;    // by material
};

}  // namespace pelage
