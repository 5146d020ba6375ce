// SPDX-License-Identifier: Apache-2.0
#include "geom/skin_memory.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <vector>

#include "geom/flat_topology.h"
#include "geom/manifold.h"
#include "geom/surface_levels.h"

namespace pelage {

namespace {

// Bytes per ptex face, measured on meshes of all kinds (tests/geom/skin_memory_test.cpp): by the number of
// levels that isolate extraordinary vertices, and for regular quads.
struct FaceBytes {
  double making, held;
};
constexpr FaceBytes kPolygonPart[] = {{3100, 1800}, {6900, 3900}, {13900, 5600}};
constexpr FaceBytes kIrregularQuad[] = {{4700, 2850}, {9500, 5000}, {21000, 7500}};
constexpr double kOfSeveral = 1.45;  // for quads with several irregular vertices
constexpr FaceBytes kIrregularLoop[] = {{6300, 4300}, {10200, 5500}, {27500, 9900}};
constexpr FaceBytes kRegular = {560, 330}, kRegularLoop = {750, 330}, kBilinear = {700, 320};
// The same for faces with a non-manifold vertex, by the number of sharp levels.
constexpr FaceBytes kTangledPart[] = {{3100, 1800},  {6900, 3900},   {13900, 5600},
                                      {31000, 9800}, {60000, 16000}, {116000, 29000}};
constexpr FaceBytes kTangledQuad[] = {{5200, 2500},    {11500, 5400},   {38000, 12000},
                                      {140000, 33000}, {310000, 72000}, {660000, 155000}};
constexpr FaceBytes kTangledLoop[] = {{6300, 4300},   {10200, 5500},   {27500, 9900},
                                      {79000, 22000}, {190000, 44000}, {410000, 90000}};
// For each vertex in excess of one per four corners of faces, such as unused ones.
constexpr FaceBytes kLooseVertex = {150, 30};
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

/// Numbers of faces that subdivision treats alike, by the worst of their vertices.
struct FaceCounts {
  double regular = 0, irregular = 0, tangled = 0;  // quads, or triangles of the Loop scheme
  double parts = 0, tangled_parts = 0;             // ptex faces of other polygons
  double all = 0;                                  // of the scheme: whole ones, and parts of other polygons
  double squares = 0;
  size_t tangled_faces = 0;  // all of them, of any size
};

FaceCounts count_faces(const ControlMesh& mesh, bool is_loop) {
  FaceCounts counts;
  const std::vector<uint32_t> valence = valences(mesh);
  const std::vector<VertexFan> fans = vertex_fans(mesh);
  const auto is_tangled = [&](uint32_t v) { return v < fans.size() && fans[v] == VertexFan::kTangled; };
  const auto is_regular = [&](uint32_t v) {
    if (v >= fans.size()) return false;
    if (fans[v] == VertexFan::kClosed) return valence[v] == (is_loop ? 6 : 4);
    return is_loop ? valence[v] == 3 : valence[v] <= 2;
  };
  const uint32_t whole = is_loop ? 3 : 4;
  size_t first = 0;
  for (const uint32_t size : mesh.face_sizes) {
    if (first + size > mesh.face_vertices.size()) break;
    const auto vertices = std::span(mesh.face_vertices).subspan(first, size);
    first += size;
    counts.all += size == whole ? 1 : size;
    const bool tangled = std::any_of(vertices.begin(), vertices.end(), is_tangled);
    counts.tangled_faces += tangled;
    if (size != whole) {
      (tangled ? counts.tangled_parts : counts.parts) += size;
    } else if (tangled) {
      ++counts.tangled;
    } else {
      const auto regular = std::count_if(vertices.begin(), vertices.end(), is_regular);
      if (regular == whole) ++counts.regular;
      if (regular < whole) counts.irregular += regular + 1 < whole && !is_loop ? kOfSeveral : 1;
    }
    if (size > 16) counts.squares += double(size) * size;
  }
  for (const uint32_t n : valence) counts.squares += n > 16 ? double(n) * n : 0;
  return counts;
}

FaceBytes loose_bytes(const ControlMesh& mesh) {
  const double loose = std::max(0.0, double(mesh.positions.size()) - double(mesh.face_vertices.size()) / 4);
  return {loose * kLooseVertex.making, loose * kLooseVertex.held};
}

/// Bytes of sharp edges and corners, of unusual valences and of loose vertices.
FaceBytes special_bytes(const ControlMesh& mesh, const FaceCounts& counts) {
  FaceBytes sum = loose_bytes(mesh);
  sum.making += counts.squares * kSquare.making;
  sum.held += counts.squares * kSquare.held;
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
  const bool is_loop = scheme == SubdivisionScheme::kLoop;
  const FaceCounts n = count_faces(mesh, is_loop);
  const auto smooth = static_cast<size_t>(smooth_levels(mesh) - 1);
  const auto sharp = static_cast<size_t>(sharp_levels(mesh, n.tangled_faces) - 1);
  FaceBytes sum = special_bytes(mesh, n);
  const auto add = [&sum](double count, const FaceBytes& each) {
    sum.making += count * each.making;
    sum.held += count * each.held;
  };
  if (scheme == SubdivisionScheme::kBilinear) {
    sum = loose_bytes(mesh);
    add(n.all, kBilinear);
  } else {
    add(n.regular, is_loop ? kRegularLoop : kRegular);
    add(n.irregular, is_loop ? kIrregularLoop[smooth] : kIrregularQuad[smooth]);
    add(n.tangled, is_loop ? kTangledLoop[sharp] : kTangledQuad[sharp]);
    add(n.parts, kPolygonPart[smooth]);
    add(n.tangled_parts, kTangledPart[sharp]);
  }
  if (!mesh.face_uv.empty()) add(n.all, {4 * sizeof(V2f), 4 * sizeof(V2f)});
  const double triangles = is_loop ? n.all : 2 * n.all;
  return {bytes(sum.making), bytes(sum.held), bytes(triangles * kOfTriangle)};
}

}  // namespace pelage
