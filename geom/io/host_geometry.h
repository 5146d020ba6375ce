// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "base/host_data.h"
#include "base/value_readers.h"
#include "geom/mesh.h"
#include "geom/strands.h"

namespace pelage {

/// A cage that a host made, for `skins.NAME.mesh`.
class HostMesh final : public HostData {
 public:
  HostMesh(std::string name, ControlMesh mesh) : HostData(std::move(name)), mesh_(std::move(mesh)) {}
  const ControlMesh& mesh() const { return mesh_; }

 private:
  ControlMesh mesh_;
};

/// Strands that a host made, for `grooms.NAME.strands_file`.
class HostStrands final : public HostData {
 public:
  HostStrands(std::string name, std::shared_ptr<const Strands> strands)
      : HostData(std::move(name)), strands_(std::move(strands)) {}
  const std::shared_ptr<const Strands>& strands() const { return strands_; }

 private:
  std::shared_ptr<const Strands> strands_;
};

/// Posed positions of the vertices of a cage, for `poses.files`. Each pose has as many positions as the
/// others.
class HostPoses final : public HostData {
 public:
  using Pose = std::vector<V3f>;
  HostPoses(std::string name, std::vector<Pose> poses)
      : HostData(std::move(name)), poses_(std::move(poses)) {}
  const std::vector<Pose>& poses() const { return poses_; }

 private:
  std::vector<Pose> poses_;
};

/// Makes a mesh known to scenes, as if a file had it. `mesh` needs `positions`, `face_sizes` and
/// `face_vertices`; without `groups`, all faces are in the group "default". Throws Error (kInput) with the
/// first mistake: numbers that are not finite, arrays that do not fit each other, indices out of range, faces
/// with fewer than 3 different vertices, no faces.
std::shared_ptr<const HostMesh> share_mesh(ControlMesh mesh);

/// Makes strands known to scenes, as if a file had them: their ids become their indices, and repairs are
/// those of read_strands(). Attributes are kept, roots are not. Throws Error (kInput) if the strands have
/// more than one motion key, or if there are none.
std::shared_ptr<const HostStrands> share_strands(std::shared_ptr<const Strands> strands);

/// Makes poses known to scenes, as if files had them. Throws Error (kInput) if there are none, if they differ
/// in size, or if a position is not finite.
std::shared_ptr<const HostPoses> share_poses(std::vector<HostPoses::Pose> poses);

/// Returns the poses that an asset names. Throws Error (kInput) if its data is not `count` poses of a mesh
/// with so many vertices.
std::shared_ptr<const HostPoses> host_poses(const AssetPath& asset, size_t count, size_t vertices);

/// Returns the mesh that an asset names. Throws Error (kInput) if its data is not a mesh.
const ControlMesh& host_mesh(const AssetPath& asset);

}  // namespace pelage
