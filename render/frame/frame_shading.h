// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/accel/accel.h"
#include "render/fibre/fibre_material.h"
#include "render/film/film.h"
#include "render/light/scatter_point.h"
#include "render/scene/frame_scene.h"

namespace pelage {

class SkinShadows;

/// Evaluates the materials of a scene at hits. The scene must outlive this object. In all members,
/// `hit_geometry` is the geometry of the hit, which the accelerator has copied. Thread safety: const members
/// may be called from any thread.
class FrameShading {
 public:
  /// `balls`: inside the skins, for the points of scatter_point(); null: none. Must outlive this object.
  explicit FrameShading(const FrameScene& scene, const SkinShadows* balls = nullptr);

  /// Returns position and scattering at a hit, as the next vertex of a path.
  ScatterPoint scatter_point(const Ray& ray, const Hit& hit, const HitGeometry& hit_geometry) const;
  /// Returns the colour of the material at a hit.
  Rgb color(const Hit& hit, const HitGeometry& hit_geometry) const;
  /// Returns VisibleSurface::depth of a hit of a camera ray.
  float depth(const Ray& ray, const Hit& hit) const;
  /// Returns the film data of a hit of a camera ray.
  VisibleSurface visible_surface(const Ray& ray, const Hit& hit, const HitGeometry& hit_geometry) const;

 private:
  struct Fibre {
    FibreMaterial material;
    std::optional<FibreAverageTable> averages;  // for `indirect: dual`
    Field color;
    std::optional<Rgb> constant_color;    // empty: `color` varies
    std::vector<std::string> attributes;  // names of the attributes that `color` reads
  };
  struct Skin {
    Field color;
    std::optional<Rgb> constant_color;
    std::optional<GlossyParams> coat;  // empty: Lambert
  };

  /// Returns the fraction of strands that level of detail keeps where this strand grows; 1 without level of
  /// detail.
  float kept_share(const Hit& hit, const Strands& strand) const;
  ScatterPoint fibre_point(const Ray& ray, const Hit& hit, const Strands& strand) const;
  void set_skin(const Ray& ray, const Hit& hit, const Strands& strand, ScatterPoint& point) const;
  ScatterPoint skin_point(const Ray& ray, const Hit& hit, const SkinMesh& triangle) const;
  Rgb fibre_color(const Fibre& fibre, const Strands& strand, const Hit& hit, float v) const;
  Rgb skin_color(const SkinPart& part, const Skin& skin, const Hit& hit, const SkinMesh& triangle) const;
  template <class Next>
  V2f motion_in_image(const V3f& position, const V3f& shutter_motion, float time, const Next& next) const;

  const FrameScene scene_;
  const SkinShadows* const balls_;
  std::vector<std::optional<Fibre>> fibres_;  // by material
  std::vector<std::optional<Skin>> skins_;    // by material
};

}  // namespace pelage
