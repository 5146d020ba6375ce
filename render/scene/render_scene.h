// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lod/simplification.h"
#include "procedurals/deferred_skin.h"
#include "procedurals/procedural.h"
#include "render/camera/camera.h"
#include "render/film/film_layers.h"
#include "render/light/light_set.h"
#include "render/material/material.h"
#include "render/scene/render_params.h"

namespace pelage {

/// Fur of one groom on one character: procedurals that share a fibre material.
struct FurPart {
  std::string name;  ///< "rat.under"
  std::vector<std::unique_ptr<Procedural>> procedurals;
  size_t material = 0;
  /// The rest pose of the skin that the strands grow on, for material fields that depend on the rest
  /// position; may be null: the roots are then used as rest positions.
  std::shared_ptr<const LimitSurface> rest;
  Rgb tint{1};                             ///< multiplies the colour of the strands
  std::optional<Simplification> lod = {};  ///< how detail was reduced; empty: it was not reduced
};

/// A skin. `rest` provides the rest positions of hits, and its topology provides their texture coordinates.
/// If `rest` is null, both are zero.
struct SkinPart {
  std::string name;
  std::shared_ptr<const DeferredSkin> skin;
  std::shared_ptr<const LimitSurface> rest;
  size_t material = 0;
  Rgb tint{1};                             ///< multiplies the colour of the skin
  std::optional<Simplification> lod = {};  ///< level of detail of the densest coat on the skin; empty: not
                                           ///< reduced
};

/// Everything that a renderer needs for one frame. World space.
struct RenderScene {
  std::vector<FurPart> fur;
  std::vector<SkinPart> skins;
  std::vector<MaterialParams> materials;  ///< with their textures loaded
  LightSet lights;
  Camera camera;
  ImageParams image;
  RenderParams render;
};

}  // namespace pelage
