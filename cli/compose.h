// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/ledger.h"
#include "base/parallel.h"
#include "cli/scene_schema.h"
#include "geom/limit_surface.h"
#include "geom/pose_sequence.h"
#include "groom/groom.h"
#include "image/texture.h"
#include "render/render_scene.h"

namespace pelage {

/// What all frames of a scene share: cages on shared topologies, grooms, materials with their textures.
struct Assets {
  struct Skin {
    std::shared_ptr<const LimitSurface> rest;  ///< object space
    std::vector<V3f> rest_positions;
    std::optional<PoseSequence> poses;
  };

  std::unique_ptr<TextureLibrary> textures;
  std::map<std::string, Skin> skins;
  std::map<std::string, std::shared_ptr<const Groom>> grooms;
  std::vector<MaterialParams> materials;  ///< in the order of the scene
  std::vector<MemoryCharge> charges;
};

/// One frame, ready to be rendered.
struct World {
  RenderScene scene;
  int64_t strands_described = 0;
  int64_t characters = 0;
  std::vector<MemoryCharge> charges;
};

/// Reads every file that the scene names and grows what does not move. Throws Error (kInput).
Assets load_assets(const SceneDescription& description, const Workers& workers, MemoryLedger& ledger);

/// Poses everything for a frame. Throws Error (kInput) for missing poses.
World compose(const SceneDescription& description, Assets& assets, double frame, const Workers& workers,
              MemoryLedger& ledger);

}  // namespace pelage
