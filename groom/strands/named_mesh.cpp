// SPDX-License-Identifier: Apache-2.0
#include "groom/strands/named_mesh.h"

#include "geom/io/mesh_file.h"
#include "groom/strands/named_strands.h"
#include "groom/strands/rotation.h"

namespace pelage {

SkinMesh read_named_mesh(const AssetPath& file, const Job& job) {
  std::error_code ignored;
  if (!std::filesystem::exists(file.path, ignored))
    throw Error(ErrorKind::kInput, file.position, "no such file " + file.path.string());
  const ControlMesh cage = with_errors_at_asset(file, [&] { return read_mesh_file(file.path, job); });
  SkinMesh mesh;
  for (const V3f& p : cage.positions) mesh.positions.insert(mesh.positions.end(), {p.x, p.y, p.z});
  std::vector<V3f> normals(cage.positions.size(), V3f(0));
  size_t first = 0;
  for (const uint32_t size : cage.face_sizes) {
    const uint32_t* face = &cage.face_vertices[first];
    for (uint32_t i = 2; i < size; ++i) {
      mesh.triangles.insert(mesh.triangles.end(), {face[0], face[i - 1], face[i]});
      const V3f& a = cage.positions[face[0]];
      const V3f area = (cage.positions[face[i - 1]] - a).cross(cage.positions[face[i]] - a);
      for (const uint32_t corner : {face[0], face[i - 1], face[i]}) normals[corner] += area;
    }
    first += size;
  }
  for (const V3f& normal : normals) {
    const V3f unit = normalised_or(normal, V3f(0));
    mesh.normals.insert(mesh.normals.end(), {unit.x, unit.y, unit.z});
  }
  return mesh;
}

}  // namespace pelage
