// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/job.h"
#include "render/scene/render_scene.h"
#include "rib/scene/rib_batches.h"
#include "rib/scene/rib_scene.h"
#include "world/frame_coats.h"
#include "world/hair_arguments.h"

namespace pelage {

/// A scene that procedurals of a RIB file name.
struct ArchiveScene {
  SceneDescription scene;
  std::unique_ptr<Assets> assets;
};
/// The scenes that the procedurals of a RIB file name, by path and overrides.
using ArchiveScenes = std::map<std::string, std::shared_ptr<const ArchiveScene>>;

/// A coat that a procedural of a RIB file stands for.
struct ArchiveCoat {
  size_t procedural = 0;  ///< index in RibScene::own_procedurals
  FrameCoat coat;         ///< in the world of its own scene; without level of detail if all strands are meant
  std::optional<LeafRange> leaves;  ///< empty: all
  std::string skin;                 ///< "rat.body", the name of its skin in the RIB file
  std::shared_ptr<const ArchiveScene> scene;
};

/// The own procedurals of a RIB file in one frame.
struct ArchiveProcedurals {
  ArchiveScenes scenes;
  std::vector<ArchiveCoat> coats;  ///< in the order of the file
};

/// Returns the coats of all own procedurals of a RIB file. `picture`: the scene that is rendered, whose
/// shutter and memory limit hold for the coats too. `before`: scenes of an earlier frame, which need not be
/// read again.
///
/// Level of detail is that of the arguments. With `camera=scene`, the strands are those of the picture of
/// the other scene. A procedural without such an argument has all its strands, as in a renderer whose detail
/// is infinite.
///
/// Throws Error: kInput for bad arguments, with the position of the request, and for mistakes in the other
/// scenes; kMemory when an asset does not fit the memory limit; kStopped when the job is stopped.
ArchiveProcedurals pose_procedurals(const RibScene& rib, const SceneDescription& picture, const Job& job,
                                    const ArchiveScenes& before);

/// Returns a coat as fur of the picture, deferred and grown as in its own scene. `request`: the procedural
/// that it belongs to.
FurPart archive_fur(const std::string& name, const ArchiveCoat& coat, const RibOwnProcedural& request,
                    size_t material, const RibShutter& shutter);

}  // namespace pelage
