// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/job.h"
#include "base/value_readers.h"
#include "world/assets.h"
#include "world/scene_schema.h"

namespace pelage {

enum class ExportFormat { kUsd, kPbrt, kMitsuba, kAlembic };
template <>
struct EnumNames<ExportFormat> {
  static constexpr const char* names[] = {"usd", "pbrt", "mitsuba", "alembic"};
};

/// A scene to be exported, as load_scene() and load_assets() make it. Level of detail is not applied: all
/// strands are exported.
struct ExportSource {
  std::filesystem::path path;  ///< of the scene file; its stem names the exported scene
  const SceneDescription& scene;
  const Assets& assets;
};

/// Writes the frames of a scene for other programs into a folder (docs/EXCHANGE.md), with a README.md of what
/// the format cannot express. The files appear when all of them are made, and files that are named by others
/// appear before these. Files of the folder with other names stay. Returns the files to open.
///
/// Throws Error: kArguments before anything is replaced if a file of the scene would be, or a file in a
/// folder without a README.md of an earlier export (ExportFolder); kInput for missing or damaged poses,
/// kFailed if a file cannot be written, kMemory if a leaf does not fit the memory limit, kStopped when the
/// job is stopped.
std::vector<std::filesystem::path> export_scene(const std::filesystem::path& folder, ExportFormat format,
                                                const ExportSource& source, const Job& job);

}  // namespace pelage
