// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/job.h"
#include "base/ledger.h"
#include "geom/limit_surface.h"
#include "geom/pose_sequence.h"
#include "groom/groom.h"
#include "image/texture_library.h"
#include "world/scene_schema.h"

namespace pelage {

/// What all frames of a scene share: cages on shared topologies, grooms, materials with their textures.
struct Assets {
  struct Skin {
    std::shared_ptr<const LimitSurface> rest;  ///< object space
    ControlMesh cage;                          ///< at rest
    std::optional<PoseSequence> poses;
  };

  explicit Assets(MemoryLedger& ledger, Progress* progress = nullptr) : textures(ledger, progress) {}

  TextureLibrary textures;
  std::map<std::string, Skin> skins;
  std::map<std::string, std::shared_ptr<const Groom>> grooms;
  /// Poses that a character's part has of its own, by the name of the character and the index of the part.
  std::map<std::pair<std::string, size_t>, PoseSequence> part_poses;
  std::vector<std::vector<CrowdMember>> crowds;  ///< in the order of the scene
  std::vector<MaterialParams> materials;         ///< in the order of the scene
  std::vector<MemoryCharge> charges;
};

/// Reads every file that the scene names and makes what does not move: rest surfaces, follicles, prepared
/// operators, coats with a cache from there; who stands where. Sets the limit of the ledger. Throws Error
/// (kInput), Error (kMemory) before anything is made that `render.memory` has no room for, Error (kStopped).
std::unique_ptr<Assets> load_assets(const SceneDescription& scene, const Job& job);

}  // namespace pelage
