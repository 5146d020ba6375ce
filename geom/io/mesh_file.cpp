// SPDX-License-Identifier: Apache-2.0
#include "geom/io/mesh_file.h"

#include "base/file.h"
#include "base/job.h"
#include "base/memory_budget.h"
#include "base/progress.h"
#include "geom/alembic/alembic_mesh_file.h"
#include "geom/io/obj_file.h"
#include "geom/usd/usd_mesh_file.h"

namespace pelage {

bool is_alembic_file(const std::filesystem::path& path) { return lower_extension(path) == ".abc"; }

ControlMesh read_mesh_file(const std::filesystem::path& path) {
  if (is_alembic_file(path)) return read_alembic_mesh(path).mesh;
  return is_usd_file(path) ? read_usd_mesh(path).mesh : read_obj(path);
}

ControlMesh read_mesh_file(const std::filesystem::path& path, const Job& job) {
  if (!is_usd_file(path) && !is_alembic_file(path)) return read_obj(path, job);
  MemoryCharge reading;
  const MeshReserve charge = [&](int64_t bytes) {
    job.check_stop();
    reading = {};
    reading = reserve(job.ledger, MemoryTag::kSkins, bytes, "reading " + path.filename().string());
  };
  MeshFile file = is_alembic_file(path) ? read_alembic_mesh(path, charge) : read_usd_mesh(path, charge);
  for (const std::string& warning : file.warnings) job.progress.warn(warning);
  job.check_stop();
  return std::move(file.mesh);
}

}  // namespace pelage
