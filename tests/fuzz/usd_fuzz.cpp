// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "base/check.h"
#include "base/error.h"
#include "geom/alembic/alembic_validation.h"
#include "geom/curve_bounds.h"
#include "geom/io/mesh_file.h"
#include "geom/io/strand_file.h"
#include "geom/usd/usd_validation.h"
#include "tests/fuzz/fuzz_targets.h"

namespace pelage {
namespace {

void feed_strands(const std::filesystem::path& path) {
  StrandReadOptions options;
  options.max_bytes = 8 << 20;
  const Strands strands = read_strands(path, options).strands;
  if (strands.strand_count() == 0) return;
  const Box3f box = exact_bounds(strands);
  for (int axis = 0; axis < 3; ++axis) {
    PELAGE_CHECK(std::isfinite(box.min[axis]) && std::isfinite(box.max[axis]));
    PELAGE_CHECK(box.min[axis] <= box.max[axis]);
  }
}

void feed_mesh(const std::filesystem::path& path) {
  const ControlMesh mesh = read_mesh_file(path);
  PELAGE_CHECK(mesh.face_uv.empty() || mesh.face_uv.size() == mesh.face_vertices.size());
  PELAGE_CHECK(mesh.face_groups.size() == mesh.face_count());
  for (const uint32_t vertex : mesh.face_vertices) PELAGE_CHECK(vertex < mesh.positions.size());
  for (const uint32_t uv : mesh.face_uv) PELAGE_CHECK(uv < mesh.uv.size());
  for (const uint32_t hole : mesh.holes) PELAGE_CHECK(hole < mesh.face_count());
  for (const V3f& p : mesh.positions) {
    PELAGE_CHECK(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  }
}

void feed_scene(const std::filesystem::path& path,
                ValidationReport (*validate)(const std::filesystem::path&)) {
  for (const int reader : {0, 1, 2}) {
    try {
      if (reader == 0) feed_strands(path);
      if (reader == 1) feed_mesh(path);
      if (reader == 2) validate(path);
    } catch (const Error& error) {
      PELAGE_CHECK(error.kind() == ErrorKind::kInput || error.kind() == ErrorKind::kMemory);
      PELAGE_CHECK(error.problems().size() == 1);
    }
  }
}

}  // namespace

void fuzz_usd(std::span<const uint8_t> bytes) { feed_scene(fuzz_file(bytes, ".usda"), validate_usd); }
void fuzz_alembic(std::span<const uint8_t> bytes) { feed_scene(fuzz_file(bytes, ".abc"), validate_alembic); }

}  // namespace pelage
