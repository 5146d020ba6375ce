// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/job.h"
#include "geom/limit_surface.h"
#include "image/field.h"
#include "rib/host/coat_rib.h"
#include "rib/host/rib_file.h"
#include "world/assets.h"
#include "world/scene_schema.h"

namespace pelage {

struct SceneRibOptions {
  RibFormat format;
  RibCoats coats = RibCoats::kProcedurals;
  /// Whether archives and Curves have only the strands that level of detail keeps. Procedurals always follow
  /// `render.lod`.
  bool lod = false;
};

/// A scene to be written: its file and overrides, which procedurals refer to, and what load_scene() and
/// load_assets() make of them.
struct SceneRibSource {
  std::filesystem::path path;
  std::vector<Override> overrides;
  const SceneDescription& scene;
  const Assets& assets;
};

/// Writes the frames of a scene as RIB (docs/RENDERMAN.md): one file per frame if the name of `output` has a
/// placeholder for the frame number, otherwise one file with all frames. Every file appears completely or not
/// at all; archives appear before the file that names them. Returns the names of the files, without archives.
///
/// Throws Error: kFailed if a file cannot be written, kMemory if something does not fit the memory limit,
/// kStopped when the job is stopped.
std::vector<std::filesystem::path> write_scene_rib(const std::filesystem::path& output,
                                                   const SceneRibSource& source,
                                                   const SceneRibOptions& options, const Job& job);

/// Returns the mean colour of a field on a skin at rest, for renderers that cannot evaluate the field: the
/// mean of the colours at the middles of the faces, weighted by the areas of the faces. Maps must have been
/// loaded. A skin without area has the mean of its faces.
Rgb mean_color(const Field& color, const LimitSurface& rest);

}  // namespace pelage
