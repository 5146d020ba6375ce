// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/hash.h"
#include "base/job.h"
#include "base/ledger.h"
#include "geom/limit_surface.h"
#include "geom/pose_sequence.h"
#include "groom/groom.h"
#include "image/texture_library.h"
#include "world/archives.h"
#include "world/scene_schema.h"

namespace pelage {

/// Data that all frames of a scene share: skins, grooms, crowds, and materials with their textures. Skins
/// with the same topology share one SurfaceTopology.
struct Assets {
  struct Skin {
    std::shared_ptr<const LimitSurface> rest;  ///< surface at rest, in object space
    ControlMesh cage;                          ///< control cage at rest, in object space, without equal faces
    MeshOrder order;                           ///< of the mesh file, for poses
    std::optional<PoseSequence> poses;         ///< empty: always at rest
    ContentHash key;                           ///< skin_key()
    MemoryCharge charge;
  };

  explicit Assets(MemoryLedger& ledger, Progress* progress = nullptr) : textures(ledger, progress) {}

  TextureLibrary textures;
  std::map<std::string, Skin> skins;
  std::map<std::string, std::shared_ptr<const Groom>> grooms;
  std::map<std::string, ContentHash> groom_keys;  ///< groom_key(), by the name of the groom
  /// Poses of a part of a character that replace the poses of its skin. The key is the name of the character
  /// and the index of the part (CharacterParams::parts).
  std::map<std::pair<std::string, size_t>, PoseSequence> part_poses;
  std::map<std::string, Archive> archives;       ///< by name, of the frame that was composed last
  std::vector<std::vector<CrowdMember>> crowds;  ///< the animals of each crowd, in the order of the scene
  std::vector<MaterialParams> materials;         ///< in the order of the scene
  std::vector<MemoryCharge> charges;             ///< of topologies and crowds
};

/// Makes all data that is the same in all frames: surfaces at rest, follicles, prepared operators, positions
/// of crowds, materials. Reads the files that this data needs. Reads coats from their caches where the scene
/// has any. Sets the limit of the ledger to `render.memory`. Throws Error: kInput for mistakes in files,
/// kMemory when an object does not fit `render.memory` (before the object is made), kStopped when the job is
/// stopped.
std::unique_ptr<Assets> load_assets(const SceneDescription& scene, const Job& job);

/// Brings assets to the state that load_assets() would make for this scene. Skins and grooms that do not
/// change are kept. For a groom of which only operators change, the follicles are kept. No world of these
/// assets may exist. Throws the same errors as load_assets(). `assets` is then incomplete, but this function
/// can be called again, for any scene.
void update_assets(const SceneDescription& scene, const Job& job, Assets& assets);

/// Returns the materials of a scene, in its order, with their textures and tables. Throws Error: kInput for
/// missing or damaged images, kStopped when the job is stopped. Fields that need a skin are loaded for the
/// skin on which the material is used, if there is only one.
std::vector<MaterialParams> load_materials(const SceneDescription& scene, Assets& assets, const Job& job);

}  // namespace pelage
