// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/job.h"
#include "base/ledger.h"
#include "geom/limit_surface.h"
#include "rib/scene/rib_scene.h"
#include "world/scene_schema.h"

namespace pelage {

struct World;
struct ArchiveProcedurals;

/// The contents of a RIB file in one frame, in world space relative to an origin.
struct Archive {
  ContentHash key;  ///< of everything from which it is made
  std::shared_ptr<const RibScene> rib;
  std::vector<std::shared_ptr<const LimitSurface>> surfaces;  ///< of the skins: RibSkin::cage
  std::shared_ptr<const ArchiveProcedurals> procedurals;      ///< own procedurals; null without any
  MemoryCharge charge;
};

/// Makes `archive` the contents of a file at a frame, relative to `origin` (RenderScene::origin), unless it
/// already is. Throws Error: kInput for mistakes
/// in the file, kMemory when its strands and skins do not fit `render.memory`, kStopped when the job is
/// stopped.
void load_archive(const SceneDescription& scene, const std::string& name, const ArchiveParams& params,
                  double frame, const Job& job, const V3f& origin, Archive& archive);

/// Adds the coats and skins of an archive to a world, as "ARCHIVE.NAME". Throws Error (kInput) if a surface
/// has no material, or one of the wrong kind.
void add_archive(const SceneDescription& scene, const std::string& name, const ArchiveParams& params,
                 const Archive& archive, const Job& job, World& world);

}  // namespace pelage
