// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "base/check.h"
#include "base/error.h"
#include "geom/io/obj_file.h"
#include "geom/limit_surface.h"
#include "tests/fuzz/fuzz_targets.h"

namespace pelage {

void fuzz_obj(std::span<const uint8_t> bytes) {
  const std::filesystem::path path = fuzz_file(bytes, ".obj");
  try {
    const ControlMesh mesh = read_obj(path);
    for (uint32_t vertex : mesh.face_vertices) PELAGE_CHECK(vertex < mesh.positions.size());
    for (uint32_t uv : mesh.face_uv) PELAGE_CHECK(uv < mesh.uv.size());
    for (const V3f& p : mesh.positions) {
      PELAGE_CHECK(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    }
    // A cage that was read must be refused or refined.
    SurfaceTopology::create(mesh, SubdivisionScheme::kCatmullClark, BoundaryRule::kEdgeAndCorner,
                            path.string());
  } catch (const Error& error) {
    PELAGE_CHECK(error.kind() == ErrorKind::kInput);
  }
}

}  // namespace pelage
