// SPDX-License-Identifier: Apache-2.0
#include "geom/skin_memory.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <vector>

#include "geom/flat_topology.h"
#include "geom/surface_levels.h"

namespace pelage {

namespace {

// Bytes per ptex face, measured on meshes of all kinds (tests/geom/skin_memory_test.cpp): by the number of
// levels that isolate extraordinary vertices, and for regular quads.
struct FaceBytes {
  double making, held;
};
constexpr FaceBytes kPolygonPart[] = {{3100, 1800}, {6900, 3900}, {13900, 5600}};
constexpr FaceBytes kIrregularQuad[] = {{4200, 2300}, {9500, 5000}, {21000, 7500}};
constexpr FaceBytes kLoopTriangle[] = {{1100, 480}, {1500, 650}, {3000, 1000}};
constexpr FaceBytes kRegular = {560, 330}, kBilinear = {650, 280};
// Additional bytes: per square of each unusual valence and polygon size; per vertex where infinitely sharp
// edges end or branch, and per such edge; per semi-sharp edge, for each of its refined parts.
constexpr FaceBytes kSquare = {260, 115}, kSharpEnd = {62000, 20000}, kSharpEdge = {1200, 600},
                    kSharpPart = {7800, 3000};
// Per triangle: the lattice, the triangle and the tree over them.
constexpr double kOfTriangle = 300;
constexpr double kOfSkin = 1 << 16;

std::vector<uint32_t> valences(const ControlMesh& mesh) {
  std::vector<uint32_t> valence(mesh.positions.size());
  for (const uint32_t v : mesh.face_vertices) {
    if (v < valence.size()) ++valence[v];
  }
  return valence;
}

/// The usual case: four faces at a vertex, two or one at a border.
bool is_regular_quad(std::span<const uint32_t> vertices, const std::vector<uint32_t>& valence) {
  return vertices.size() == 4 && std::all_of(vertices.begin(), vertices.end(), [&](uint32_t v) {
           return v < valence.size() && (valence[v] == 4 || valence[v] <= 2);
         });
}

/// Numbers of ptex faces that subdivision treats alike.
struct FaceCounts {
  double regular = 0, parts = 0, irregular = 0, squares = 0;
};

FaceCounts count_faces(const ControlMesh& mesh) {
  FaceCounts counts;
  const std::vector<uint32_t> valence = valences(mesh);
  size_t first = 0;
  for (const uint32_t size : mesh.face_sizes) {
    if (first + size > mesh.face_vertices.size()) break;
    const auto vertices = std::span(mesh.face_vertices).subspan(first, size);
    first += size;
    if (size != 4) counts.parts += size;
    if (size == 4) ++(is_regular_quad(vertices, valence) ? counts.regular : counts.irregular);
    if (size > 16) counts.squares += double(size) * size;
  }
  for (const uint32_t n : valence) counts.squares += n > 16 ? double(n) * n : 0;
  return counts;
}

/// Bytes of sharp edges and corners, and of unusual valences.
FaceBytes special_bytes(const ControlMesh& mesh, const FaceCounts& counts) {
  FaceBytes sum = {counts.squares * kSquare.making, counts.squares * kSquare.held};
  const auto add = [&](const FaceBytes& each, double count) {
    sum.making += each.making * count;
    sum.held += each.held * count;
  };
  std::map<uint32_t, int> sharp_edges;  // at a vertex
  const auto parts = [](float sharpness) { return std::exp2(std::min(std::ceil(double(sharpness)), 6.0)); };
  for (const ControlMesh::Crease& crease : mesh.creases) {
    if (!(crease.sharpness > 0)) continue;
    const bool infinite = crease.sharpness >= 10;
    add(infinite ? kSharpEdge : kSharpPart, infinite ? 1 : parts(crease.sharpness));
    if (!infinite) continue;
    ++sharp_edges[crease.a];
    ++sharp_edges[crease.b];
  }
  for (const auto& [vertex, edges] : sharp_edges) add(kSharpEnd, edges == 2 ? 0 : 1);
  for (const ControlMesh::Corner& corner : mesh.corners) {
    if (corner.sharpness > 0) add(kSharpEnd, 1);
  }
  return sum;
}

}  // namespace

size_t SkinMemory::peak() const { return std::max(making, held + triangles); }

SkinMemory skin_memory(const ControlMesh& mesh, SubdivisionScheme scheme) {
  const auto bytes = [](double value) { return static_cast<size_t>(value + kOfSkin); };
  if (scheme == SubdivisionScheme::kNone) {
    const size_t triangles =
        mesh.face_vertices.size() - std::min(mesh.face_vertices.size(), 2 * mesh.face_sizes.size());
    const size_t vertices = mesh.positions.size();
    const bool has_uv = !mesh.face_uv.empty();
    return {
        bytes(static_cast<double>(flat_temporary_bytes(triangles, vertices, has_uv))),
        bytes(static_cast<double>(flat_bytes(triangles, vertices, has_uv) + vertices * 6 * sizeof(float))),
        bytes(static_cast<double>(triangles) * kOfTriangle)};
  }
  const FaceCounts n = count_faces(mesh);
  const auto level = static_cast<size_t>(smooth_levels(mesh) - 1);
  const double quads = n.regular + n.irregular;
  const FaceBytes special = special_bytes(mesh, n);
  if (scheme == SubdivisionScheme::kLoop) {
    const auto faces = static_cast<double>(mesh.face_count());
    return {bytes(faces * kLoopTriangle[level].making + special.making),
            bytes(faces * kLoopTriangle[level].held + special.held), bytes(faces * kOfTriangle)};
  }
  const double triangles = 2 * (quads + n.parts) * kOfTriangle;
  if (scheme == SubdivisionScheme::kBilinear) {
    return {bytes((quads + n.parts) * kBilinear.making), bytes((quads + n.parts) * kBilinear.held),
            bytes(triangles)};
  }
  const FaceBytes &part = kPolygonPart[level], &quad = kIrregularQuad[level];
  return {
      bytes(n.regular * kRegular.making + n.parts * part.making + n.irregular * quad.making + special.making),
      bytes(n.regular * kRegular.held + n.parts * part.held + n.irregular * quad.held + special.held),
      bytes(triangles)};
}

}  // namespace pelage
