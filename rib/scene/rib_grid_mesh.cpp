// SPDX-License-Identifier: Apache-2.0
#include "rib/scene/rib_grid_mesh.h"

#include <map>

namespace pelage {
namespace {

/// Fills the positions of `mesh`, and returns the vertex of each point of the grid.
std::vector<uint32_t> merge_points(const std::vector<RibGrid>& samples, RibMesh& mesh) {
  std::map<std::vector<float>, uint32_t> known;  // by the coordinates in all samples
  std::vector<uint32_t> vertices;
  mesh.samples.resize(samples.size());
  std::vector<float> place;
  for (size_t i = 0; i < samples.front().points.size(); ++i) {
    place.clear();
    for (const RibGrid& sample : samples) {
      const V3f p = sample.points[i] + V3f(0);  // -0 becomes 0
      place.insert(place.end(), {p.x, p.y, p.z});
    }
    const auto next = static_cast<uint32_t>(mesh.samples.front().size());
    const auto [found, is_new] = known.try_emplace(place, next);
    for (size_t s = 0; is_new && s < samples.size(); ++s) mesh.samples[s].push_back(samples[s].points[i]);
    vertices.push_back(found->second);
  }
  mesh.cage.positions = mesh.samples.front();
  return vertices;
}

}  // namespace

RibGrid::RibGrid(int column_count, int row_count, const std::function<V3f(int column, int row)>& point)
    : columns(column_count), rows(row_count) {
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= columns; ++column) points.push_back(point(column, row));
  }
}

RibMesh grid_mesh(const std::vector<RibGrid>& samples) {
  RibMesh result;
  ControlMesh& mesh = result.cage;
  const std::vector<uint32_t> vertices = merge_points(samples, result);
  const int columns = samples.front().columns, rows = samples.front().rows;
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= columns; ++column)
      mesh.uv.emplace_back(static_cast<float>(column) / static_cast<float>(columns),
                           static_cast<float>(row) / static_cast<float>(rows));
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
  return result;
}

}  // namespace pelage
