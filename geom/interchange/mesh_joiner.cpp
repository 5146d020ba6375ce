// SPDX-License-Identifier: Apache-2.0
#include "geom/interchange/mesh_joiner.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "base/error.h"

namespace pelage {
namespace {

uint16_t index_of_name(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  const auto index = static_cast<size_t>(found - names.begin());
  if (found == names.end() && names.size() < UINT16_MAX) names.push_back(name);
  return static_cast<uint16_t>(std::min(index, names.size() - 1));
}

bool all_below(const std::vector<uint32_t>& indices, size_t limit) {
  return std::all_of(indices.begin(), indices.end(), [&](uint32_t index) { return index < limit; });
}

size_t crease_edges(const std::vector<uint32_t>& lengths) {
  size_t edges = 0;
  for (const uint32_t length : lengths) edges += length > 0 ? length - 1 : 0;
  return edges;
}

}  // namespace

std::string MeshPart::problem() const {
  for (size_t i = 0; i < points.size(); ++i) {
    const V3f& p = points[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      return fmt::format("point {} is not finite", i);
  }
  for (const uint32_t vertex : face_vertices) {
    if (vertex >= points.size())
      return fmt::format("the index {} is not one of {} points", vertex, points.size());
  }
  size_t corner = 0;
  for (size_t face = 0; face < face_sizes.size(); ++face) {
    const size_t size = face_sizes[face];
    if (size > face_vertices.size() - corner) return "the faces need more indices than there are";
    if (size < 3 || distinct_corners({&face_vertices[corner], size}) < 3)
      return fmt::format("face {} has fewer than 3 different points", face);
    corner += size;
  }
  if (corner != face_vertices.size()) return "the faces need fewer indices than there are";
  if (!all_below(holes, face_sizes.size())) return "a hole is not one of the faces";
  if (!all_below(corners, points.size())) return "a corner is not one of the points";
  if (!all_below(crease_vertices, points.size()))
    return "a crease has an index that is not one of the points";
  const size_t ends = std::accumulate(crease_lengths.begin(), crease_lengths.end(), size_t{0});
  if (ends > crease_vertices.size()) return "the creases need more indices than there are";
  if (crease_sharpness.size() < crease_lengths.size() &&
      crease_sharpness.size() != crease_edges(crease_lengths))
    return "the creases have too few sharpnesses";
  if (corner_sharpness.size() < corners.size()) return "the corners have too few sharpnesses";
  return {};
}

void MeshJoiner::add(const MeshPart& part) {
  if (mesh_.positions.size() + part.points.size() >= UINT32_MAX ||
      mesh_.face_vertices.size() + part.face_vertices.size() > max_corners_) {
    throw Error(ErrorKind::kInput, {path_.string(), 0, 0},
                fmt::format("the meshes up to '{}' have too many points or faces", part.name));
  }
  first_vertex_ = static_cast<uint32_t>(mesh_.positions.size());
  first_face_ = static_cast<uint32_t>(mesh_.face_count());
  first_corner_ = static_cast<uint32_t>(mesh_.face_vertices.size());
  mesh_.positions.insert(mesh_.positions.end(), part.points.begin(), part.points.end());
  for (const uint32_t vertex : part.face_vertices) mesh_.face_vertices.push_back(first_vertex_ + vertex);
  mesh_.face_sizes.insert(mesh_.face_sizes.end(), part.face_sizes.begin(), part.face_sizes.end());
  add_tags(part);
  add_uv(part);
  add_colors(part);
  if (part.reversed) reverse_faces();
  mesh_.objects.faces.resize(mesh_.face_count(), index_of_name(mesh_.objects.names, part.name));
  mesh_.face_groups.resize(mesh_.face_count(), index_of_name(mesh_.groups, part.name));
}

void MeshJoiner::add_group(const std::string& name, const std::vector<uint32_t>& faces) {
  const uint16_t group = index_of_name(mesh_.groups, name);
  for (const uint32_t face : faces) mesh_.face_groups[first_face_ + face] = group;
}

void MeshJoiner::finish() {
  if (!mesh_.colors.empty()) mesh_.colors.resize(mesh_.positions.size(), Rgb(1));
  if (mesh_.face_uv.empty()) mesh_.uv.clear();
  mesh_.face_groups.resize(mesh_.face_count());
  if (mesh_.groups.empty()) mesh_.groups = {"default"};
}

void MeshJoiner::add_tags(const MeshPart& part) {
  for (const uint32_t hole : part.holes) mesh_.holes.push_back(first_face_ + hole);
  const auto sharpness = [](float stated) { return stated >= 0 ? stated : 0; };
  for (size_t i = 0; i < part.corners.size(); ++i)
    mesh_.corners.push_back({first_vertex_ + part.corners[i], sharpness(part.corner_sharpness[i])});
  const bool per_edge = part.crease_sharpness.size() == crease_edges(part.crease_lengths);
  size_t vertex = 0, edge = 0;
  for (size_t crease = 0; crease < part.crease_lengths.size(); ++crease) {
    for (uint32_t i = 0; i + 1 < part.crease_lengths[crease]; ++i, ++edge) {
      const uint32_t* ends = &part.crease_vertices[vertex + i];
      mesh_.creases.push_back({first_vertex_ + ends[0], first_vertex_ + ends[1],
                               sharpness(part.crease_sharpness[per_edge ? edge : crease])});
    }
    vertex += part.crease_lengths[crease];
  }
}

void MeshJoiner::add_uv(const MeshPart& part) {
  if (!part.uv) {
    if (!mesh_.uv.empty()) mesh_.face_uv.resize(mesh_.face_vertices.size());
    return;
  }
  const Primvar& uv = *part.uv;
  if (mesh_.uv.empty()) mesh_.uv.push_back(V2f(0));  // of faces without coordinates
  mesh_.face_uv.resize(first_corner_);
  const auto first = static_cast<uint32_t>(mesh_.uv.size());
  for (size_t i = 0; i + 1 < uv.values.size(); i += 2) {
    const V2f at(uv.values[i], uv.values[i + 1]);
    mesh_.uv.push_back(std::isfinite(at.x) && std::isfinite(at.y) ? at : V2f(0));
  }
  uint32_t corner = 0;
  for (uint32_t face = 0; face < part.face_sizes.size(); ++face) {
    for (uint32_t i = 0; i < part.face_sizes[face]; ++i, ++corner) {
      uint32_t at = 0;
      if (uv.interpolation == "faceVarying") at = corner;
      if (uv.interpolation == "uniform") at = face;
      if (uv.interpolation == "vertex" || uv.interpolation == "varying") at = part.face_vertices[corner];
      mesh_.face_uv.push_back(first + at);
    }
  }
}

void MeshJoiner::add_colors(const MeshPart& part) {
  if (!part.colors || part.colors->components < 3) return;
  if (part.colors->interpolation != "vertex" && part.colors->interpolation != "varying") return;
  mesh_.colors.resize(first_vertex_, Rgb(1));
  const size_t step = part.colors->components;
  for (size_t i = 0; i + 2 < part.colors->values.size(); i += step) {
    const float* v = &part.colors->values[i];
    Rgb c(v[0], v[1], v[2]);
    for (int k = 0; k < 3; ++k) c[k] = std::isfinite(c[k]) ? c[k] : 0;
    mesh_.colors.push_back(c);
  }
}

void MeshJoiner::reverse_faces() {
  size_t corner = first_corner_;
  for (size_t face = first_face_; face < mesh_.face_count(); ++face) {
    const auto first = static_cast<ptrdiff_t>(corner);
    corner += mesh_.face_sizes[face];
    const auto end = static_cast<ptrdiff_t>(corner);
    std::reverse(mesh_.face_vertices.begin() + first, mesh_.face_vertices.begin() + end);
    if (mesh_.face_uv.size() >= corner)
      std::reverse(mesh_.face_uv.begin() + first, mesh_.face_uv.begin() + end);
  }
}

}  // namespace pelage
