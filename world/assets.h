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

/// Data that all frames of a scene share: cages with shared topologies, grooms, materials with their
/// textures.
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
  /// Poses that belong to a single part of a character, by the character's name and the part's index.
  std::map<std::pair<std::string, size_t>, PoseSequence> part_poses;
  std::vector<std::vector<CrowdMember>> crowds;  ///< in the order of the scene
  std::vector<MaterialParams> materials;         ///< in the order of the scene
  std::vector<MemoryCharge> charges;
};

/// Reads every file that the scene names and makes all data that does not change from frame to frame: rest
/// surfaces, follicles, prepared operators, coats (from their cache if they have one), positions of crowds.
/// Sets the limit of the ledger. Throws Error: kInput, kMemory before making anything that does not fit
/// `render.memory`, kStopped when the job is stopped.
std::unique_ptr<Assets> load_assets(const SceneDescription& scene, const Job& job);

}  // namespace pelage
