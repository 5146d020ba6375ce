// SPDX-License-Identifier: Apache-2.0
#include "geom/usd/usd_mesh_file.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "geom/interchange/mesh_joiner.h"
#include "geom/usd/usd_primvar.h"
#include "geom/usd/usd_values.h"

namespace pelage {
namespace {

class UsdMeshReader {
 public:
  UsdMeshReader(ControlMesh& mesh, const std::filesystem::path& path, ReadWarnings& warnings)
      : mesh_(mesh), joiner_(mesh, path), warnings_(warnings) {}

  void add(const UsdPrim& prim) {
    if (prim.type == "GeomSubset") return add_subset(prim);
    if (prim.type != "Mesh") return note_other(prim);
    MeshPart part;
    part.name = last_name(prim.path);
    add_points(prim, part);
    add_faces(prim, part);
    add_tags(prim, part);
    if (const std::string problem = part.problem(); !problem.empty()) prim.fail(problem);
    add_uv(prim, part);
    if (prim.find("primvars:displayColor"))
      part.colors = usd_primvar(prim, "primvars:displayColor", "constant", part.counts(), warnings_);
    const bool mirrored = prim.to_world.determinant() < 0;
    part.reversed = (prim.token("orientation", "rightHanded") == "leftHanded") != mirrored;
    joiner_.add(part);
    mesh_path_ = prim.path;
    faces_ = part.face_sizes.size();
    if (mesh_.boundary_tag < 0) {
      const std::string rule = prim.token("interpolateBoundary", "edgeAndCorner");
      mesh_.boundary_tag = rule == "edgeOnly" ? 2 : rule == "none" ? 0 : 1;
    }
    mesh_.smooth_triangles |= prim.token("triangleSubdivisionRule", "catmullClark") == "smooth";
  }

  void finish() { joiner_.finish(); }

 private:
  void note_other(const UsdPrim& prim) {
    constexpr std::string_view kShapes[] = {"Cube",  "Sphere",     "Cylinder",       "Cone",   "Capsule",
                                            "Plane", "NurbsPatch", "PointInstancer", "Points", "TetMesh"};
    for (const std::string_view shape : kShapes) {
      if (prim.type == shape) warnings_.add(prim.type + " prims are skipped", prim.position());
    }
  }

  std::optional<UsdValue> required(const UsdPrim& prim, const char* attribute) {
    std::optional<UsdValue> value = prim.find(attribute);
    if (!value) prim.fail(fmt::format("the mesh has no {}", attribute));
    if (value->attribute->times.size() > 1)
      warnings_.add("time samples after the first are skipped", prim.position());
    return value;
  }

  void add_points(const UsdPrim& prim, MeshPart& part) {
    const std::optional<UsdValue> value = required(prim, "points");
    const std::vector<float> points = usd_floats(*value->layer, value->text, 3);
    part.points.reserve(points.size() / 3);
    for (size_t i = 0; i + 2 < points.size(); i += 3) {
      const V3f p = V3f(points[i], points[i + 1], points[i + 2]) * prim.to_world;
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        value->layer->fail(value->attribute->place, fmt::format("point {} is not finite", i / 3));
      part.points.push_back(p);
    }
  }

  void add_faces(const UsdPrim& prim, MeshPart& part) {
    const std::optional<UsdValue> counts = required(prim, "faceVertexCounts"),
                                  indices = required(prim, "faceVertexIndices");
    part.face_vertices = indices_of(*indices, part.points.size(), "points");
    size_t corner = 0;
    for (const int64_t size : usd_integers(*counts->layer, counts->text)) {
      const bool fits = size >= 3 && static_cast<size_t>(size) <= part.face_vertices.size() - corner;
      if (!fits || distinct_corners({&part.face_vertices[corner], static_cast<size_t>(size)}) < 3) {
        counts->layer->fail(
            counts->attribute->place,
            fits || size < 3
                ? fmt::format("face {} has fewer than 3 different points", part.face_sizes.size())
                : std::string("faceVertexCounts need more indices than there are"));
      }
      part.face_sizes.push_back(static_cast<uint32_t>(size));
      corner += static_cast<size_t>(size);
    }
    if (corner != part.face_vertices.size())
      counts->layer->fail(counts->attribute->place, "faceVertexCounts need fewer indices than there are");
  }

  static std::vector<uint32_t> indices_of(const UsdValue& value, size_t limit, const char* what) {
    std::vector<uint32_t> result;
    for (const int64_t index : usd_integers(*value.layer, value.text)) {
      if (index < 0 || static_cast<size_t>(index) >= limit) {
        value.layer->fail(value.attribute->place,
                          fmt::format("the index {} is not one of {} {}", index, limit, what));
      }
      result.push_back(static_cast<uint32_t>(index));
    }
    return result;
  }
  static std::vector<uint32_t> indices_of(const UsdPrim& prim, const char* attribute, size_t limit,
                                          const char* what) {
    const std::optional<UsdValue> value = prim.find(attribute);
    return value ? indices_of(*value, limit, what) : std::vector<uint32_t>();
  }
  static std::vector<float> floats_of(const UsdPrim& prim, const char* attribute) {
    const std::optional<UsdValue> value = prim.find(attribute);
    return value ? usd_floats(*value->layer, value->text, 1) : std::vector<float>();
  }

  static void add_tags(const UsdPrim& prim, MeshPart& part) {
    part.holes = indices_of(prim, "holeIndices", part.face_sizes.size(), "faces");
    part.corners = indices_of(prim, "cornerIndices", part.points.size(), "points");
    part.corner_sharpness = floats_of(prim, "cornerSharpnesses");
    part.corners.resize(std::min(part.corners.size(), part.corner_sharpness.size()));
    part.crease_vertices = indices_of(prim, "creaseIndices", part.points.size(), "points");
    part.crease_lengths =
        indices_of(prim, "creaseLengths", part.crease_vertices.size() + 1, "possible lengths");
    part.crease_sharpness = floats_of(prim, "creaseSharpnesses");
  }

  void add_uv(const UsdPrim& prim, MeshPart& part) {
    if (prim.find("primvars:st"))
      part.uv = usd_primvar(prim, "primvars:st", "faceVarying", part.counts(), warnings_);
    for (const std::string& name : prim.attribute_names()) {
      if (part.uv || !name.starts_with("primvars:") || name.ends_with(":indices")) continue;
      const std::optional<UsdValue> value = prim.find(name);
      if (value && value->attribute->type.starts_with("texCoord2"))
        part.uv = usd_primvar(prim, name, "faceVarying", part.counts(), warnings_);
    }
    if (part.uv && part.uv->components != 2) part.uv.reset();
  }

  static std::string last_name(const std::string& path) { return path.substr(path.rfind('/') + 1); }

  void add_subset(const UsdPrim& prim) {
    if (mesh_path_.empty() || !prim.path.starts_with(mesh_path_ + "/")) return;
    if (prim.token("elementType", "face") != "face") return;
    joiner_.add_group(last_name(prim.path), indices_of(prim, "indices", faces_, "faces"));
  }

  ControlMesh& mesh_;
  MeshJoiner joiner_;
  ReadWarnings& warnings_;
  std::string mesh_path_;
  size_t faces_ = 0;  // of the mesh that was added last
};

/// Bytes of memory per byte of text: numbers have two to ten characters, are in memory twice, and arrays grow
/// by doubling.
constexpr size_t kMeshMemoryPerText = 6;

/// Bytes of the values of a prim.
size_t text_of(const UsdPrim& prim) {
  size_t text = 0;
  for (const std::string& name : prim.attribute_names()) {
    if (const std::optional<UsdValue> value = prim.find(name)) text += value->text.end - value->text.begin;
  }
  return text;
}

}  // namespace

MeshFile read_usd_mesh(const UsdSource& source, const MeshReserve& reserve) {
  ReadWarnings warnings;
  MeshFile file;
  int64_t text_bytes = 0;
  const auto reserve_with_text = [&](size_t bytes) {
    if (reserve) reserve(text_bytes + static_cast<int64_t>(bytes));
  };
  UsdStage stage(source, warnings, [&](int64_t bytes) {
    text_bytes = bytes;
    reserve_with_text(file.mesh.bytes());
  });
  UsdMeshReader reader(file.mesh, source.path, warnings);
  stage.visit([&](const UsdPrim& prim) {
    if (prim.type == "Mesh") reserve_with_text(file.mesh.bytes() + kMeshMemoryPerText * text_of(prim));
    reader.add(prim);
  });
  if (file.mesh.face_count() == 0)
    throw Error(ErrorKind::kInput, {source.path.string(), 0, 0}, "has no mesh");
  reader.finish();
  file.warnings = warnings.lines();
  return file;
}

}  // namespace pelage
