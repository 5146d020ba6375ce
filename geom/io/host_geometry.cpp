// SPDX-License-Identifier: Apache-2.0
#include "geom/io/host_geometry.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "base/error.h"
#include "base/hash.h"
#include "geom/io/strand_formats.h"

namespace pelage {
namespace {

void require(bool holds, const std::string& message) {
  if (!holds) throw Error(ErrorKind::kInput, message);
}

bool is_finite(const V3f& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

void check_faces(const ControlMesh& mesh) {
  size_t corner = 0;
  for (size_t face = 0; face < mesh.face_count(); ++face) {
    const size_t size = mesh.face_sizes[face];
    const auto corners = std::span(mesh.face_vertices).subspan(corner, size);
    for (size_t i = 0; i < size; ++i, ++corner) {
      const uint32_t vertex = mesh.face_vertices[corner];
      require(vertex < mesh.positions.size(), fmt::format("face {}: there is no vertex {}; the mesh has {}",
                                                          face, vertex, mesh.positions.size()));
      require(mesh.face_uv.empty() || mesh.face_uv[corner] < mesh.uv.size(),
              fmt::format("face {}: a texture coordinate is out of range", face));
    }
    require(distinct_corners(corners) >= 3, fmt::format("face {} needs 3 different vertices", face));
  }
}

void check_references(const ControlMesh& mesh) {
  const size_t vertices = mesh.positions.size();
  const auto good_sharpness = [](float s) { return s >= 0 && std::isfinite(s); };
  for (const ControlMesh::Crease& crease : mesh.creases) {
    require(crease.a < vertices && crease.b < vertices && good_sharpness(crease.sharpness),
            "a crease needs two vertices of the mesh and a sharpness of at least 0");
  }
  for (const ControlMesh::Corner& corner : mesh.corners) {
    require(corner.vertex < vertices && good_sharpness(corner.sharpness),
            "a corner needs a vertex of the mesh and a sharpness of at least 0");
  }
  for (const uint32_t hole : mesh.holes)
    require(hole < mesh.face_count(), "a hole is not a face of the mesh");
  require(mesh.colors.empty() || mesh.colors.size() == vertices, "colours: expected one per vertex");
}

void check_mesh(const ControlMesh& mesh) {
  require(!mesh.face_sizes.empty(), "the mesh has no faces");
  require(std::all_of(mesh.positions.begin(), mesh.positions.end(), is_finite),
          "a vertex of the mesh is not finite");
  const size_t corners = std::accumulate(mesh.face_sizes.begin(), mesh.face_sizes.end(), size_t(0));
  require(corners == mesh.face_vertices.size(),
          fmt::format("the faces need {} corners, got {}", corners, mesh.face_vertices.size()));
  require(mesh.face_uv.empty() || mesh.face_uv.size() == corners,
          fmt::format("texture coordinates: expected {} corners, got {}", corners, mesh.face_uv.size()));
  require(std::all_of(mesh.uv.begin(), mesh.uv.end(),
                      [](const V2f& uv) { return std::isfinite(uv.x) && std::isfinite(uv.y); }),
          "a texture coordinate is not finite");
  check_faces(mesh);
  check_references(mesh);
}

template <class T>
void add_bytes(const std::vector<T>& values, ContentHasher& hasher) {
  hasher.add(values.size()).add_bytes(std::as_bytes(std::span(values)));
}

template <class T>
std::span<const T> all_of(const std::vector<T>& values) {
  return values;
}

class MemoryStrands final : public HeldStrands {
 public:
  explicit MemoryStrands(const HostStrands& data) : HeldStrands(data.name(), "memory", data.strands()) {}
  size_t bytes() const override { return 0; }  // the host holds them
};

}  // namespace

std::shared_ptr<const HostMesh> share_mesh(ControlMesh mesh) {
  check_mesh(mesh);
  if (mesh.groups.empty()) {
    mesh.groups = {"default"};
    mesh.face_groups.assign(mesh.face_count(), 0);
  }
  ContentHasher hasher;
  const auto add = [&](const auto& values) { add_bytes(values, hasher); };
  add(mesh.positions), add(mesh.face_sizes), add(mesh.face_vertices), add(mesh.uv), add(mesh.face_uv);
  add(mesh.creases), add(mesh.corners), add(mesh.holes), add(mesh.face_groups), add(mesh.colors);
  for (const std::string& group : mesh.groups) hasher.add(group);
  return std::make_shared<HostMesh>("mesh:" + to_string(hasher.digest()), std::move(mesh));
}

std::shared_ptr<const HostStrands> share_strands(std::shared_ptr<const Strands> strands) {
  require(strands->motion_keys() == 1,
          "a groom takes strands with one motion key, got " + std::to_string(strands->motion_keys()));
  require(strands->strand_count() > 0, "there are no strands");
  const StrandArrays& arrays = strands->arrays();
  ContentHasher hasher;
  hasher.add(arrays.basis).add(all_of(arrays.points)).add(all_of(arrays.first_point));
  for (const StrandAttribute& a : arrays.attributes)
    hasher.add(a.name).add(a.frequency).add(a.components).add(all_of(a.values));
  return std::make_shared<HostStrands>("strands:" + to_string(hasher.digest()), std::move(strands));
}

std::shared_ptr<const HostPoses> share_poses(std::vector<HostPoses::Pose> poses) {
  require(!poses.empty() && !poses.front().empty(), "there are no poses");
  ContentHasher hasher;
  for (const HostPoses::Pose& pose : poses) {
    require(pose.size() == poses.front().size(), "the poses have different numbers of vertices");
    require(std::all_of(pose.begin(), pose.end(), is_finite), "a vertex of a pose is not finite");
    add_bytes(pose, hasher);
  }
  return std::make_shared<HostPoses>("poses:" + to_string(hasher.digest()), std::move(poses));
}

std::shared_ptr<const HostPoses> host_poses(const AssetPath& asset, size_t count, size_t vertices) {
  const auto poses = std::dynamic_pointer_cast<const HostPoses>(asset.data);
  if (!poses) throw Error(ErrorKind::kInput, asset.position, "expected poses, got " + asset.data->name());
  const size_t given = poses->poses().size(), size = poses->poses().front().size();
  if (given == count && size == vertices) return poses;
  throw Error(ErrorKind::kInput, asset.position,
              fmt::format("expected {} poses of {} vertices, got {} of {}", count, vertices, given, size));
}

const ControlMesh& host_mesh(const AssetPath& asset) {
  if (const auto* mesh = dynamic_cast<const HostMesh*>(asset.data.get())) return mesh->mesh();
  throw Error(ErrorKind::kInput, asset.position, "expected a mesh, got " + asset.data->name());
}

std::unique_ptr<RawStrands> open_raw_strands(const AssetPath& asset, const StrandReadOptions& options) {
  if (!asset.data) return open_raw_strands(asset.path, options);
  if (const auto* strands = dynamic_cast<const HostStrands*>(asset.data.get()))
    return std::make_unique<MemoryStrands>(*strands);
  throw Error(ErrorKind::kInput, asset.position, "expected strands, got " + asset.data->name());
}

}  // namespace pelage
