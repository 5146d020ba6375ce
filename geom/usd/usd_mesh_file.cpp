// SPDX-License-Identifier: Apache-2.0
#include "geom/usd/usd_mesh_file.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/visible_text.h"
#include "geom/usd/usd_primvar.h"
#include "geom/usd/usd_values.h"

namespace pelage {
namespace {

constexpr size_t kMaxMeshCorners = size_t(1) << 31;

class UsdMeshReader {
 public:
  UsdMeshReader(ControlMesh& mesh, UsdWarnings& warnings) : mesh_(mesh), warnings_(warnings) {}

  void add(const UsdPrim& prim) {
    if (prim.type == "GeomSubset") return add_subset(prim);
    if (prim.type != "Mesh") return note_other(prim);
    first_vertex_ = static_cast<uint32_t>(mesh_.positions.size());
    first_face_ = static_cast<uint32_t>(mesh_.face_count());
    first_corner_ = static_cast<uint32_t>(mesh_.face_vertices.size());
    add_points(prim);
    add_faces(prim);
    add_tags(prim);
    add_uv(prim);
    add_colors(prim);
    const bool mirrored = prim.to_world.determinant() < 0;
    if ((prim.token("orientation", "rightHanded") == "leftHanded") != mirrored) reverse_faces();
    name_faces(prim);
    mesh_path_ = prim.path;
    if (mesh_.boundary_tag < 0) {
      const std::string rule = prim.token("interpolateBoundary", "edgeAndCorner");
      mesh_.boundary_tag = rule == "edgeOnly" ? 2 : rule == "none" ? 0 : 1;
    }
    mesh_.smooth_triangles |= prim.token("triangleSubdivisionRule", "catmullClark") == "smooth";
  }

  /// Completes arrays of which only some prims have values.
  void finish() {
    if (!mesh_.colors.empty()) mesh_.colors.resize(mesh_.positions.size(), Rgb(1));
    if (mesh_.face_uv.empty()) mesh_.uv.clear();
    mesh_.face_groups.resize(mesh_.face_count());
    if (mesh_.groups.empty()) mesh_.groups = {"default"};
  }

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

  void add_points(const UsdPrim& prim) {
    const std::optional<UsdValue> value = required(prim, "points");
    const std::vector<float> points = usd_floats(*value->layer, value->text, 3);
    if (mesh_.positions.size() + points.size() / 3 >= UINT32_MAX) prim.fail("the mesh has too many points");
    for (size_t i = 0; i + 2 < points.size(); i += 3) {
      const V3f p = V3f(points[i], points[i + 1], points[i + 2]) * prim.to_world;
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        value->layer->fail(value->attribute->place, fmt::format("point {} is not finite", i / 3));
      mesh_.positions.push_back(p);
    }
  }

  void add_faces(const UsdPrim& prim) {
    const std::optional<UsdValue> counts = required(prim, "faceVertexCounts"),
                                  indices = required(prim, "faceVertexIndices");
    const size_t vertices = mesh_.positions.size() - first_vertex_;
    for (const int64_t index : usd_integers(*indices->layer, indices->text)) {
      if (index < 0 || static_cast<size_t>(index) >= vertices) {
        indices->layer->fail(indices->attribute->place,
                             fmt::format("the index {} is not one of {} points", index, vertices));
      }
      mesh_.face_vertices.push_back(first_vertex_ + static_cast<uint32_t>(index));
    }
    if (mesh_.face_vertices.size() > kMaxMeshCorners) prim.fail("the mesh has too many faces");
    size_t corner = first_corner_, face = 0;
    for (const int64_t size : usd_integers(*counts->layer, counts->text)) {
      const bool fits = size >= 3 && static_cast<size_t>(size) <= mesh_.face_vertices.size() - corner;
      if (!fits || distinct_corners({&mesh_.face_vertices[corner], static_cast<size_t>(size)}) < 3) {
        counts->layer->fail(counts->attribute->place,
                            fits || size < 3
                                ? fmt::format("face {} has fewer than 3 different points", face)
                                : std::string("faceVertexCounts need more indices than there are"));
      }
      mesh_.face_sizes.push_back(static_cast<uint32_t>(size));
      corner += static_cast<size_t>(size);
      ++face;
    }
    if (corner != mesh_.face_vertices.size()) {
      counts->layer->fail(counts->attribute->place, "faceVertexCounts need fewer indices than there are");
    }
  }

  std::vector<uint32_t> indices_of(const UsdPrim& prim, const char* attribute, size_t limit) {
    std::vector<uint32_t> result;
    const std::optional<UsdValue> value = prim.find(attribute);
    if (!value) return result;
    for (const int64_t index : usd_integers(*value->layer, value->text)) {
      if (index < 0 || static_cast<size_t>(index) >= limit) {
        value->layer->fail(value->attribute->place,
                           fmt::format("the index {} is not below {}", index, limit));
      }
      result.push_back(static_cast<uint32_t>(index));
    }
    return result;
  }
  std::vector<float> sharpness_of(const UsdPrim& prim, const char* attribute) {
    const std::optional<UsdValue> value = prim.find(attribute);
    std::vector<float> result = value ? usd_floats(*value->layer, value->text, 1) : std::vector<float>();
    for (float& sharpness : result) {
      if (!(sharpness >= 0)) sharpness = 0;
    }
    return result;
  }

  void add_tags(const UsdPrim& prim) {
    const size_t vertices = mesh_.positions.size() - first_vertex_;
    for (const uint32_t hole : indices_of(prim, "holeIndices", mesh_.face_count() - first_face_))
      mesh_.holes.push_back(first_face_ + hole);
    const std::vector<uint32_t> corners = indices_of(prim, "cornerIndices", vertices);
    const std::vector<float> corner_sharpness = sharpness_of(prim, "cornerSharpnesses");
    for (size_t i = 0; i < std::min(corners.size(), corner_sharpness.size()); ++i)
      mesh_.corners.push_back({first_vertex_ + corners[i], corner_sharpness[i]});
    const std::vector<uint32_t> ends = indices_of(prim, "creaseIndices", vertices),
                                lengths = indices_of(prim, "creaseLengths", ends.size() + 1);
    const std::vector<float> sharpness = sharpness_of(prim, "creaseSharpnesses");
    size_t edges = 0, vertex = 0, edge = 0;
    for (const uint32_t length : lengths) edges += length > 0 ? length - 1 : 0;
    for (size_t crease = 0; crease < lengths.size(); ++crease) {
      for (uint32_t i = 0; i + 1 < lengths[crease] && vertex + i + 1 < ends.size(); ++i, ++edge) {
        const size_t at = sharpness.size() == edges ? edge : crease;
        if (at >= sharpness.size()) prim.fail("creaseSharpnesses has too few values");
        mesh_.creases.push_back(
            {first_vertex_ + ends[vertex + i], first_vertex_ + ends[vertex + i + 1], sharpness[at]});
      }
      vertex += lengths[crease];
    }
  }

  UsdPrimvarCounts counts() const {
    const size_t vertices = mesh_.positions.size() - first_vertex_;
    return {mesh_.face_count() - first_face_, vertices, vertices, mesh_.face_vertices.size() - first_corner_};
  }

  void add_uv(const UsdPrim& prim) {
    std::optional<UsdPrimvar> uv;
    if (prim.find("primvars:st")) uv = usd_primvar(prim, "primvars:st", "faceVarying", counts(), warnings_);
    for (const std::string& name : prim.attribute_names()) {
      if (uv || !name.starts_with("primvars:") || name.ends_with(":indices")) continue;
      const std::optional<UsdValue> value = prim.find(name);
      if (value && value->attribute->type.starts_with("texCoord2"))
        uv = usd_primvar(prim, name, "faceVarying", counts(), warnings_);
    }
    if (!uv || uv->components != 2) {
      if (!mesh_.uv.empty()) pad_uv();
      return;
    }
    if (mesh_.uv.empty()) mesh_.uv.push_back(V2f(0));  // of faces without coordinates
    mesh_.face_uv.resize(first_corner_);
    const auto first = static_cast<uint32_t>(mesh_.uv.size());
    for (size_t i = 0; i + 1 < uv->values.size(); i += 2) {
      const V2f at(uv->values[i], uv->values[i + 1]);
      mesh_.uv.push_back(std::isfinite(at.x) && std::isfinite(at.y) ? at : V2f(0));
    }
    size_t corner = first_corner_;
    for (size_t face = first_face_; face < mesh_.face_count(); ++face) {
      for (uint32_t i = 0; i < mesh_.face_sizes[face]; ++i, ++corner) {
        uint32_t at = 0;
        if (uv->interpolation == "faceVarying") at = static_cast<uint32_t>(corner - first_corner_);
        if (uv->interpolation == "uniform") at = static_cast<uint32_t>(face - first_face_);
        if (uv->interpolation == "vertex" || uv->interpolation == "varying")
          at = mesh_.face_vertices[corner] - first_vertex_;
        mesh_.face_uv.push_back(first + at);
      }
    }
  }
  void pad_uv() { mesh_.face_uv.resize(mesh_.face_vertices.size()); }

  void add_colors(const UsdPrim& prim) {
    if (!prim.find("primvars:displayColor")) return;
    const auto color = usd_primvar(prim, "primvars:displayColor", "constant", counts(), warnings_);
    if (!color || color->components != 3) return;
    if (color->interpolation != "vertex" && color->interpolation != "varying") return;
    mesh_.colors.resize(first_vertex_, Rgb(1));
    for (size_t i = 0; i + 2 < color->values.size(); i += 3) {
      Rgb c(color->values[i], color->values[i + 1], color->values[i + 2]);
      for (int k = 0; k < 3; ++k) c[k] = std::isfinite(c[k]) ? c[k] : 0;
      mesh_.colors.push_back(c);
    }
  }

  void reverse_faces() {
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

  static uint16_t index_of(std::vector<std::string>& names, const std::string& name) {
    const auto found = std::find(names.begin(), names.end(), name);
    const auto index = static_cast<size_t>(found - names.begin());
    if (found == names.end() && names.size() < UINT16_MAX) names.push_back(name);
    return static_cast<uint16_t>(std::min(index, names.size() - 1));
  }
  static std::string last_name(const std::string& path) { return path.substr(path.rfind('/') + 1); }

  void name_faces(const UsdPrim& prim) {
    const std::string name = last_name(prim.path);
    mesh_.objects.faces.resize(mesh_.face_count(), index_of(mesh_.objects.names, name));
    mesh_.face_groups.resize(mesh_.face_count(), index_of(mesh_.groups, name));
  }

  void add_subset(const UsdPrim& prim) {
    if (mesh_path_.empty() || !prim.path.starts_with(mesh_path_ + "/")) return;
    if (prim.token("elementType", "face") != "face") return;
    const uint16_t group = index_of(mesh_.groups, last_name(prim.path));
    for (const uint32_t face : indices_of(prim, "indices", mesh_.face_count() - first_face_))
      mesh_.face_groups[first_face_ + face] = group;
  }

  ControlMesh& mesh_;
  UsdWarnings& warnings_;
  uint32_t first_vertex_ = 0, first_face_ = 0, first_corner_ = 0;
  std::string mesh_path_;
};

/// Bytes of memory per byte of text: numbers have about ten characters, and arrays grow by doubling.
constexpr size_t kMeshMemoryPerText = 4;

UsdMeshFile read_meshes(UsdStage& stage, const std::filesystem::path& path, const UsdMeshReserve& reserve,
                        UsdWarnings& warnings) {
  UsdMeshFile file;
  UsdMeshReader reader(file.mesh, warnings);
  stage.visit([&](const UsdPrim& prim) {
    if (reserve) {
      size_t text = 0;
      for (const std::string& name :
           prim.type == "Mesh" ? prim.attribute_names() : std::vector<std::string>()) {
        if (const std::optional<UsdValue> value = prim.find(name))
          text += value->text.end - value->text.begin;
      }
      reserve(static_cast<int64_t>(file.mesh.bytes() + kMeshMemoryPerText * text));
    }
    reader.add(prim);
  });
  if (file.mesh.face_count() == 0) throw Error(ErrorKind::kInput, {path.string(), 0, 0}, "has no mesh");
  reader.finish();
  file.warnings = warnings.lines();
  return file;
}

}  // namespace

UsdMeshFile read_usd_mesh(const std::filesystem::path& path, const UsdMeshReserve& reserve) {
  UsdWarnings warnings;
  UsdStage stage(path, warnings);
  return read_meshes(stage, path, reserve, warnings);
}

UsdMeshFile read_usd_mesh(const std::filesystem::path& path, std::string_view text,
                          const UsdMeshReserve& reserve) {
  UsdWarnings warnings;
  UsdStage stage(path, text, warnings);
  return read_meshes(stage, path, reserve, warnings);
}

}  // namespace pelage
