// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lod/simplification.h"
#include "procedurals/bounds/procedural.h"
#include "procedurals/skin/deferred_skin.h"
#include "render/camera/camera.h"
#include "render/film/film_layers.h"
#include "render/light/light_set.h"
#include "render/light/magnet_set.h"
#include "render/material/material.h"
#include "render/scene/render_params.h"

namespace pelage {

/// Fur of one groom on one character: procedurals that share a fibre material.
struct FurPart {
  std::string name;  ///< "rat.under"
  std::vector<std::unique_ptr<Procedural>> procedurals;
  size_t material = 0;
  /// Rest pose of the skin that the strands grow on. Material fields that depend on the rest position use it.
  /// If null, they use the roots of the posed strands as rest positions.
  std::shared_ptr<const LimitSurface> rest;
  Rgb tint{1};                             ///< multiplies the colour of the strands
  std::optional<Simplification> lod = {};  ///< reduction of detail; empty: not reduced
  float scale = 1;                         ///< size of the posed skin relative to `rest`
  std::optional<uint32_t> skin = {};       ///< index in RenderScene::skins of the skin below the strands
  /// The skin whose motion from frame to frame the strands follow; null: only their motion keys are known.
  std::shared_ptr<const DeferredSkin> follows = {};
  /// Name of the coat that this one copies, such as "rat.under" for "colony.17.under"; its own otherwise.
  std::string prototype = {};
};

/// A skin. `rest` provides the rest positions of hits; its topology provides the texture coordinates of hits.
/// If `rest` is null, rest positions and texture coordinates are zero.
struct SkinPart {
  std::string name;
  std::shared_ptr<const DeferredSkin> skin;
  std::shared_ptr<const LimitSurface> rest;
  size_t material = 0;
  Rgb tint{1};                             ///< multiplies the colour of the skin
  std::optional<Simplification> lod = {};  ///< of the densest coat on the skin; empty: not reduced
  std::string prototype = {};              ///< as FurPart::prototype
};

/// Everything that a renderer needs for one frame. Positions are in world space, relative to `origin`.
struct RenderScene {
  std::vector<FurPart> fur;
  std::vector<SkinPart> skins;
  std::vector<MaterialParams> materials;  ///< with their textures loaded
  LightSet lights;
  Camera camera;
  ImageParams image;
  RenderParams render;
  /// World position of the point (0, 0, 0). Near the coats if these are so far from the world's origin that
  /// floats would not resolve their strands; otherwise 0.
  V3f origin{0};
  MagnetSet magnets = {};
};

}  // namespace pelage
