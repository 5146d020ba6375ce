// SPDX-License-Identifier: Apache-2.0
#include "rib/scene/rib_grid_mesh.h"

#include <array>
#include <map>

namespace pelage {

ControlMesh grid_mesh(int columns, int rows, const std::function<V3f(int column, int row)>& point) {
  ControlMesh mesh;
  std::map<std::array<float, 3>, uint32_t> known;
  std::vector<uint32_t> vertices;  // of each corner of the grid, row by row
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= columns; ++column) {
      const V3f p = point(column, row) + V3f(0);  // -0 becomes 0
      const auto [found, is_new] =
          known.try_emplace({p.x, p.y, p.z}, static_cast<uint32_t>(mesh.positions.size()));
      if (is_new) mesh.positions.push_back(p);
      vertices.push_back(found->second);
      mesh.uv.emplace_back(static_cast<float>(column) / static_cast<float>(columns),
                           static_cast<float>(row) / static_cast<float>(rows));
    }
  }
  const auto at = [&](int column, int row) { return static_cast<uint32_t>(row * (columns + 1) + column); };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const uint32_t corners[] = {at(column, row), at(column + 1, row), at(column + 1, row + 1),
                                  at(column, row + 1)};
      const size_t first = mesh.face_vertices.size();
      for (size_t i = 0; i < 4; ++i) {
        const uint32_t vertex = vertices[corners[i]];
        if (vertex == vertices[corners[(i + 3) % 4]]) continue;  // an edge without length
        mesh.face_vertices.push_back(vertex);
        mesh.face_uv.push_back(corners[i]);
      }
      const size_t size = mesh.face_vertices.size() - first;
      if (distinct_corners(std::span(mesh.face_vertices).subspan(first)) < 3) {
        mesh.face_vertices.resize(first);
        mesh.face_uv.resize(first);
      } else {
        mesh.face_sizes.push_back(static_cast<uint32_t>(size));
      }
    }
  }
  return mesh;
}

}  // namespace pelage
