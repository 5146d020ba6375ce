// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geom/interchange/primvar.h"
#include "geom/mesh.h"

namespace pelage {

/// A mesh of a scene file, in world space. Indices are those of this mesh alone.
struct MeshPart {
  std::string name;
  std::vector<V3f> points;
  std::vector<uint32_t> face_sizes, face_vertices;
  std::vector<uint32_t> holes, corners, crease_vertices, crease_lengths;
  std::vector<float> corner_sharpness;  ///< one per corner
  std::vector<float> crease_sharpness;  ///< one per crease or one per edge of creases
  std::optional<Primvar> uv;            ///< with 2 components
  std::optional<Primvar> colors;        ///< of vertices
  bool reversed = false;                ///< whether the corners of faces are clockwise, seen from outside

  PrimvarCounts counts() const {
    return {face_sizes.size(), points.size(), points.size(), face_vertices.size()};
  }
  /// Checks that all points are finite and that sizes and indices fit each other. Returns a message about the
  /// first mistake, or an empty text.
  std::string problem() const;
};

/// Joins the meshes of a scene file to one cage, in which each is an object and a group.
class MeshJoiner {
 public:
  static constexpr size_t kMaxCorners = size_t(1) << 31;
  /// `path`: the file, for errors.
  MeshJoiner(ControlMesh& mesh, std::filesystem::path path, size_t max_corners = kMaxCorners)
      : mesh_(mesh), path_(std::move(path)), max_corners_(max_corners) {}

  /// Adds a mesh, whose problem() must be empty. Throws Error (kInput) with the file and the mesh if the cage
  /// gets more than `max_corners` corners of faces, or 2^32 - 1 points.
  void add(const MeshPart& part);
  /// Puts faces of the last added mesh into the group of this name. The faces must exist.
  void add_group(const std::string& name, const std::vector<uint32_t>& faces);
  /// Fills the arrays for which only some meshes have values. Call it once, after the last add().
  void finish();

 private:
  void add_tags(const MeshPart& part);
  void add_uv(const MeshPart& part);
  void add_colors(const MeshPart& part);
  void reverse_faces();

  ControlMesh& mesh_;
  const std::filesystem::path path_;
  const size_t max_corners_;
  uint32_t first_vertex_ = 0, first_face_ = 0, first_corner_ = 0;  // of the mesh that was added last
};

}  // namespace pelage
