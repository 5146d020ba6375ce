// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "geom/mesh.h"
#include "geom/usd/usd_files.h"

namespace pelage {

struct Job;

/// Reads a cage from a file: .usda and the other extensions of USD (geom/usd/usd_mesh_file.h), .abc
/// (geom/alembic/alembic_mesh_file.h), or else OBJ (read_obj()). Throws their errors.
ControlMesh read_mesh_file(const std::filesystem::path& path);
/// Does the same. Passes warnings to the progress of the job. Throws Error: kStopped when the job is stopped,
/// kMemory when a mesh of USD or Alembic does not fit the memory limit, to which reading charges it.
ControlMesh read_mesh_file(const std::filesystem::path& path, const Job& job);

/// Returns whether the name of a file has the extension of Alembic, .abc.
bool is_alembic_file(const std::filesystem::path& path);

}  // namespace pelage
