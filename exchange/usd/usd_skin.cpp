// SPDX-License-Identifier: Apache-2.0
#include "exchange/usd/usd_skin.h"

#include "geom/interchange/unique_names.h"

namespace pelage {
namespace {

const char* usd_scheme(SubdivisionScheme scheme) {
  constexpr const char* kNames[] = {"catmullClark", "loop", "bilinear", "none"};
  return kNames[static_cast<size_t>(scheme)];
}

std::span<const float> floats_of(std::span<const V3f> points) {
  return points.empty() ? std::span<const float>() : std::span(&points[0].x, 3 * points.size());
}

Box3f box_of(std::span<const V3f> points) {
  Box3f box;
  for (const V3f& p : points) box.extendBy(p);
  return box.isEmpty() ? Box3f(V3f(0), V3f(0)) : box;
}

void write_tags(UsdWriter& usd, const ControlMesh& mesh, BoundaryRule boundary) {
  usd.line(fmt::format("uniform token interpolateBoundary = \"{}\"",
                       boundary == BoundaryRule::kEdgeAndCorner ? "edgeAndCorner" : "edgeOnly"));
  // OpenSubdiv's FVAR_LINEAR_CORNERS_ONLY is the default of USD; ours interpolates linearly everywhere.
  usd.line("uniform token faceVaryingLinearInterpolation = \"all\"");
  if (mesh.smooth_triangles) usd.line("uniform token triangleSubdivisionRule = \"smooth\"");
  if (!mesh.creases.empty()) {
    std::vector<uint32_t> ends, lengths;
    std::vector<float> sharpness;
    for (const ControlMesh::Crease& crease : mesh.creases) {
      ends.insert(ends.end(), {crease.a, crease.b});
      lengths.push_back(2);
      sharpness.push_back(crease.sharpness);
    }
    usd.array("int[] creaseIndices = ", std::span<const uint32_t>(ends));
    usd.array("int[] creaseLengths = ", std::span<const uint32_t>(lengths));
    usd.array("float[] creaseSharpnesses = ", sharpness);
  }
  if (!mesh.corners.empty()) {
    std::vector<uint32_t> vertices;
    std::vector<float> sharpness;
    for (const ControlMesh::Corner& corner : mesh.corners) {
      vertices.push_back(corner.vertex);
      sharpness.push_back(corner.sharpness);
    }
    usd.array("int[] cornerIndices = ", std::span<const uint32_t>(vertices));
    usd.array("float[] cornerSharpnesses = ", sharpness);
  }
  if (!mesh.holes.empty()) usd.array("int[] holeIndices = ", std::span<const uint32_t>(mesh.holes));
}

void write_subsets(UsdWriter& usd, const ControlMesh& mesh) {
  if (mesh.groups.size() < 2 || mesh.face_groups.empty()) return;
  UniqueNames names;
  for (size_t group = 0; group < mesh.groups.size(); ++group) {
    std::vector<uint32_t> faces;
    for (uint32_t face = 0; face < mesh.face_groups.size(); ++face) {
      if (mesh.face_groups[face] == group) faces.push_back(face);
    }
    if (faces.empty()) continue;
    usd.open(fmt::format("def GeomSubset {}", usd_string(names.unique(mesh.groups[group]))));
    usd.line("uniform token elementType = \"face\"");
    usd.line("uniform token familyName = \"groups\"");
    usd.array("int[] indices = ", std::span<const uint32_t>(faces));
    usd.close();
  }
}

}  // namespace

void open_usd_mesh(UsdWriter& usd, const std::string& name, const std::string& schemas,
                   const ControlMesh& mesh, SubdivisionScheme scheme, BoundaryRule boundary,
                   std::span<const UsdMeshSample> samples) {
  const std::string apis = schemas.empty() ? "" : fmt::format(" (prepend apiSchemas = [{}])", schemas);
  usd.open(fmt::format("def Mesh {}{}", usd_string(name), apis));
  usd.line(fmt::format("uniform token subdivisionScheme = \"{}\"", usd_scheme(scheme)));
  usd.array("int[] faceVertexCounts = ", std::span<const uint32_t>(mesh.face_sizes));
  usd.array("int[] faceVertexIndices = ", std::span<const uint32_t>(mesh.face_vertices));
  if (samples.size() == 1) {
    usd.array("point3f[] points = ", floats_of(samples[0].points), {3, 3});
    usd.box("float3[] extent = ", box_of(samples[0].points));
  } else {
    usd.open_samples("point3f[] points");
    for (const UsdMeshSample& sample : samples)
      usd.array(fmt::format("{}: ", sample.time), floats_of(sample.points), {3, 3}, ",");
    usd.close();
    usd.open_samples("float3[] extent");
    for (const UsdMeshSample& sample : samples)
      usd.box(fmt::format("{}: ", sample.time), box_of(sample.points), ",");
    usd.close();
  }
  write_tags(usd, mesh, boundary);
  if (!mesh.face_uv.empty()) {
    usd.array("texCoord2f[] primvars:st = ", std::span(&mesh.uv[0].x, 2 * mesh.uv.size()), {2, 2},
              " (interpolation = \"faceVarying\")");
    usd.array("int[] primvars:st:indices = ", std::span<const uint32_t>(mesh.face_uv));
  }
  if (!mesh.colors.empty()) {
    usd.array("color3f[] primvars:displayColor = ", std::span(&mesh.colors[0].x, 3 * mesh.colors.size()),
              {3, 3}, " (interpolation = \"vertex\")");
  }
  write_subsets(usd, mesh);
}

}  // namespace pelage
