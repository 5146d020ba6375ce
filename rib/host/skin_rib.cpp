// SPDX-License-Identifier: Apache-2.0
#include "rib/host/skin_rib.h"

#include <string_view>

namespace pelage {
namespace {

/// The tags of a SubdivisionMesh with their arguments.
struct Tags {
  std::vector<std::string_view> names;
  std::vector<int32_t> counts, integers;
  std::vector<float> numbers;

  void add(std::string_view name, std::initializer_list<uint32_t> ints, std::initializer_list<float> floats) {
    names.push_back(name);
    counts.insert(counts.end(), {static_cast<int32_t>(ints.size()), static_cast<int32_t>(floats.size())});
    for (const uint32_t value : ints) integers.push_back(static_cast<int32_t>(value));
    numbers.insert(numbers.end(), floats);
  }
};

Tags tags_of(const ControlMesh& mesh, BoundaryRule boundary) {
  Tags tags;
  // Without an argument, all renderers take it for 1: edges and corners.
  if (boundary == BoundaryRule::kEdgeAndCorner) {
    tags.add("interpolateboundary", {}, {});
  } else {
    tags.add("interpolateboundary", {2}, {});
  }
  if (mesh.smooth_triangles) tags.add("smoothtriangles", {1}, {});
  for (const ControlMesh::Crease& crease : mesh.creases)
    tags.add("crease", {crease.a, crease.b}, {crease.sharpness});
  for (const ControlMesh::Corner& corner : mesh.corners)
    tags.add("corner", {corner.vertex}, {corner.sharpness});
  for (const uint32_t hole : mesh.holes) tags.add("hole", {hole}, {});
  return tags;
}

std::vector<float> numbers_of(std::span<const V3f> points) {
  std::vector<float> numbers;
  numbers.reserve(3 * points.size());
  for (const V3f& p : points) numbers.insert(numbers.end(), {p.x, p.y, p.z});
  return numbers;
}

std::vector<int32_t> signed_of(std::span<const uint32_t> values) { return {values.begin(), values.end()}; }

/// Only subdivision has tags for holes. Polygons are written without them.
ControlMesh without_holes(const ControlMesh& mesh) {
  ControlMesh kept = mesh;
  kept.face_sizes.clear(), kept.face_vertices.clear(), kept.face_uv.clear(), kept.holes.clear();
  std::vector<bool> hole(mesh.face_count());
  for (const uint32_t face : mesh.holes) hole[face] = true;
  ptrdiff_t corner = 0;
  for (size_t face = 0; face < hole.size(); ++face) {
    const ptrdiff_t first = corner;
    corner += mesh.face_sizes[face];
    if (hole[face]) continue;
    kept.face_sizes.push_back(mesh.face_sizes[face]);
    kept.face_vertices.insert(kept.face_vertices.end(), mesh.face_vertices.begin() + first,
                              mesh.face_vertices.begin() + corner);
    if (!mesh.face_uv.empty())
      kept.face_uv.insert(kept.face_uv.end(), mesh.face_uv.begin() + first, mesh.face_uv.begin() + corner);
  }
  return kept;
}

/// One key of a skin, from its sizes on. All keys have the same arguments but for the points.
struct SkinWriter {
  const ControlMesh& mesh;
  const char* scheme;
  std::vector<int32_t> sizes = signed_of(mesh.face_sizes), vertices = signed_of(mesh.face_vertices);
  std::vector<float> st;
  std::vector<float> rest;  // empty at rest
  Tags tags;

  void write(RibWriter& rib, std::span<const V3f> cage) const {
    if (scheme) {
      rib.request("SubdivisionMesh").text(scheme).integers(sizes).integers(vertices);
      rib.texts(tags.names).integers(tags.counts).integers(tags.integers).numbers(tags.numbers);
    } else {
      const std::vector<int32_t> loops(sizes.size(), 1);
      rib.request("PointsGeneralPolygons").integers(loops).integers(sizes).integers(vertices);
    }
    rib.parameter("P").numbers(numbers_of(cage));
    if (!rest.empty()) rib.parameter("vertex point Pref").numbers(rest);
    if (!st.empty()) rib.parameter("facevarying float[2] st").numbers(st);
  }
};

}  // namespace

void write_skin(RibWriter& rib, const ControlMesh& mesh, SubdivisionScheme scheme, BoundaryRule boundary,
                std::span<const std::vector<V3f>> cages, std::span<const float> times) {
  // Few renderers know bilinear subdivision, whose surfaces are polygons.
  const bool bilinear = scheme == SubdivisionScheme::kBilinear;
  const bool flat = bilinear || scheme == SubdivisionScheme::kNone;
  if (flat && !mesh.holes.empty()) {
    write_skin(rib, without_holes(mesh), scheme, boundary, cages, times);
    return;
  }
  SkinWriter skin{.mesh = mesh,
                  .scheme = flat ? nullptr : EnumNames<SubdivisionScheme>::names[static_cast<int>(scheme)],
                  .st = {},
                  .rest = {},
                  .tags = tags_of(mesh, boundary)};
  for (const uint32_t index : mesh.face_uv)
    skin.st.insert(skin.st.end(), {mesh.uv[index].x, mesh.uv[index].y});
  for (const std::vector<V3f>& cage : cages) {
    if (cage != mesh.positions) skin.rest = numbers_of(mesh.positions);
  }
  if (bilinear) rib.request("Attribute").text("pelage").parameter("string scheme").texts({"bilinear"});
  if (mesh.chaikin_creases)
    rib.request("Attribute").text("pelage").parameter("integer chaikin").integers({1});
  if (cages.size() > 1) rib.request("MotionBegin").numbers(times);
  for (const std::vector<V3f>& cage : cages) skin.write(rib, cage);
  if (cages.size() > 1) rib.request("MotionEnd");
}

}  // namespace pelage
