// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "why/seen_surface.h"
#include "world/scene_schema.h"

namespace pelage {

/// The material of a visible surface.
struct MaterialWhy {
  std::string name;
  std::string model;
  std::vector<ParameterText> parameters;  ///< of the scene file
  Rgb color{0};                           ///< at the hit, tint of the character included
  float opacity = 1;                      ///< at the hit
};

/// Explains the material of a surface. `frame`: composed from `scene`.
MaterialWhy explain_material(const SceneDescription& scene, const RenderScene& frame,
                             const SeenSurface& surface);

}  // namespace pelage
