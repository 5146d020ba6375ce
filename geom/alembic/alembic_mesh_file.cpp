// SPDX-License-Identifier: Apache-2.0
#include "geom/alembic/alembic_mesh_file.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "geom/alembic/alembic_param.h"
#include "geom/alembic/alembic_values.h"
#include "geom/interchange/mesh_joiner.h"

namespace pelage {
namespace {

constexpr const char* kColorNames[] = {"Cd", "color"};
constexpr std::string_view kFaceSet = "AbcGeom_FaceSet_";
// An array that grows by doubling is in memory three times for a moment: once as it was, and once with room
// for twice as much.
constexpr size_t kGrown = 3;

/// Bytes per number of a property in the part, as it is read, and in the cage.
struct MeshNumbers {
  const char* name;
  size_t bytes;
};
constexpr MeshNumbers kMeshNumbers[] = {
    {"P", 2 * sizeof(float) + kGrown * sizeof(float)},
    {".faceIndices", 12 + kGrown * sizeof(uint32_t)},
    {".faceCounts", 12 + kGrown*(sizeof(uint32_t) + 2 * sizeof(uint16_t))},
    {".holes", 12 + kGrown * sizeof(uint32_t)},
    {".cornerIndices", 12 + kGrown * 2 * sizeof(uint32_t)},
    {".cornerSharpnesses", sizeof(float)},
    {".creaseIndices", 12 + kGrown * 3 * sizeof(uint32_t)},
    {".creaseLengths", 12},
    {".creaseSharpnesses", sizeof(float)}};

class AlembicMeshReader {
 public:
  AlembicMeshReader(ControlMesh& mesh, const std::filesystem::path& path, ReadWarnings& warnings)
      : mesh_(mesh), joiner_(mesh, path), place_{path.string(), 0, 0}, warnings_(warnings) {}

  /// The memory that the cage and a mesh need until the mesh is in the cage.
  size_t bytes(const AlembicNode& node) const {
    const AlembicArchive& archive = node.archive;
    const auto count = [&](const char* name) {
      const AlembicProperty* property = node.geometry.find(name);
      return property ? alembic_count(archive, *property) : 0;
    };
    size_t bytes = 2 * mesh_.bytes() + sizeof(V3f) * mesh_.positions.size() + set_bytes(node);
    for (const MeshNumbers& numbers : kMeshNumbers) bytes += count(numbers.name) * numbers.bytes;
    if (const AlembicProperty* uv = node.geometry.find("uv"))
      bytes += (1 + kGrown) * alembic_param_bytes(archive, *uv);
    if (node.geometry.find("uv") || !mesh_.uv.empty())
      bytes += kGrown * sizeof(uint32_t) * (count(".faceIndices") + mesh_.face_vertices.size());
    const AlembicProperty* arbitrary = node.geometry.find(".arbGeomParams");
    const AlembicCompound params = arbitrary ? archive.compound(*arbitrary) : AlembicCompound();
    bool colors = !mesh_.colors.empty();
    for (const char* name : kColorNames) {
      const AlembicProperty* property = params.find(name);
      if (!property) continue;
      colors = true;
      bytes += alembic_param_bytes(archive, *property);
    }
    if (colors) bytes += kGrown * sizeof(Rgb) * (count("P") / 3 + mesh_.positions.size());
    return bytes;
  }

  void add(const AlembicNode& node) {
    node.note_unreadable(warnings_);
    if (!node.is_mesh()) return;
    MeshPart part;
    part.name = node.path.substr(node.path.rfind('/') + 1);
    add_points(node, part);
    part.face_vertices = indices(node, ".faceIndices", true);
    part.face_sizes = indices(node, ".faceCounts", true);
    add_tags(node, part);
    if (const std::string problem = part.problem(); !problem.empty()) node.fail(problem);
    add_params(node, part);
    part.reversed = !(node.to_world.determinant() < 0);  // corners are clockwise in the file
    joiner_.add(part);
    add_groups(node, part);
    set_boundary(node);
  }

  void finish() { joiner_.finish(); }

 private:
  void add_points(const AlembicNode& node, MeshPart& part) {
    const AlembicProperty* points = node.geometry.find("P");
    if (!points || points->extent != 3) node.fail("the mesh has no points (P)");
    if (points->stored > 1) warnings_.add("time samples after the first are skipped", place_);
    const std::vector<float> numbers = alembic_floats(node.archive, *points);
    part.points.reserve(numbers.size() / 3);
    for (size_t i = 0; i + 2 < numbers.size(); i += 3)
      part.points.push_back(V3f(numbers[i], numbers[i + 1], numbers[i + 2]) * node.to_world);
  }

  static std::vector<uint32_t> indices(const AlembicNode& node, const char* name, bool required = false) {
    const AlembicProperty* property = node.geometry.find(name);
    if (!property && required) node.fail(fmt::format("the mesh has no {}", name));
    std::vector<uint32_t> result;
    if (!property) return result;
    const std::vector<int64_t> numbers = alembic_integers(node.archive, *property);
    result.reserve(numbers.size());
    for (const int64_t number : numbers) {
      // The part checks numbers that are too large for the mesh.
      if (number < 0 || number > UINT32_MAX) node.fail(fmt::format("{} has the number {}", name, number));
      result.push_back(static_cast<uint32_t>(number));
    }
    return result;
  }
  static std::vector<float> floats(const AlembicNode& node, const char* name) {
    const AlembicProperty* property = node.geometry.find(name);
    return property ? alembic_floats(node.archive, *property) : std::vector<float>();
  }

  static void add_tags(const AlembicNode& node, MeshPart& part) {
    part.holes = indices(node, ".holes");
    part.corners = indices(node, ".cornerIndices");
    part.corner_sharpness = floats(node, ".cornerSharpnesses");
    part.crease_vertices = indices(node, ".creaseIndices");
    part.crease_lengths = indices(node, ".creaseLengths");
    part.crease_sharpness = floats(node, ".creaseSharpnesses");
  }

  void add_params(const AlembicNode& node, MeshPart& part) {
    if (const AlembicProperty* uv = node.geometry.find("uv")) {
      part.uv = alembic_param(node, *uv, part.counts(), warnings_, true);
      if (part.uv && part.uv->components != 2) part.uv.reset();
    }
    const AlembicProperty* arbitrary = node.geometry.find(".arbGeomParams");
    if (!arbitrary) return;
    const AlembicCompound params = node.archive.compound(*arbitrary);
    for (const char* name : kColorNames) {
      const AlembicProperty* colors = params.find(name);
      if (colors && !part.colors) part.colors = alembic_param(node, *colors, part.counts(), warnings_);
    }
  }

  /// Face sets are objects within the mesh.
  static void visit_sets(const AlembicNode& node,
                         const std::function<void(std::string_view, const AlembicProperty&)>& use) {
    for (const AlembicObject& child : node.archive.children(node.object)) {
      if (!alembic_metadata(child.metadata, "schema").starts_with(kFaceSet)) continue;
      const AlembicCompound properties = node.archive.properties(child);
      const AlembicProperty* set = properties.find(".faceset");
      if (!set) continue;
      const AlembicCompound compound = node.archive.compound(*set);
      if (const AlembicProperty* faces = compound.find(".faces")) use(child.name, *faces);
    }
  }

  /// The largest set, and the names of all, which the cage keeps.
  static size_t set_bytes(const AlembicNode& node) {
    size_t largest = 0, names = 0;
    visit_sets(node, [&](std::string_view name, const AlembicProperty& faces) {
      largest = std::max(largest, alembic_count(node.archive, faces));
      names += kGrown * sizeof(std::string) + name.size() + 1;
    });
    return largest * (sizeof(int64_t) + sizeof(uint32_t)) + names;
  }

  void add_groups(const AlembicNode& node, const MeshPart& part) {
    visit_sets(node, [&](std::string_view name, const AlembicProperty& faces) {
      std::vector<uint32_t> group;
      group.reserve(alembic_count(node.archive, faces));
      for (const int64_t face : alembic_integers(node.archive, faces)) {
        if (face < 0 || static_cast<size_t>(face) >= part.face_sizes.size()) {
          node.fail(fmt::format("the face set '{}' has the face {}; there are {}", name, face,
                                part.face_sizes.size()));
        }
        group.push_back(static_cast<uint32_t>(face));
      }
      joiner_.add_group(std::string(name), group);
    });
  }

  /// The rule of the first mesh. Many programs state none, or 0, for meshes that they draw with sharp corners
  /// and with the faces at their boundaries, which the rule 0 would drop.
  void set_boundary(const AlembicNode& node) {
    if (mesh_.boundary_tag >= 0) return;
    mesh_.boundary_tag = 1;
    const AlembicProperty* rule = node.geometry.find(".interpolateBoundary");
    if (rule && alembic_first_integer(node.archive, *rule) == 2) mesh_.boundary_tag = 2;
  }

  ControlMesh& mesh_;
  MeshJoiner joiner_;
  const SourcePosition place_;
  ReadWarnings& warnings_;
};

}  // namespace

MeshFile read_alembic_mesh(const std::filesystem::path& path, const MeshReserve& reserve) {
  ReadWarnings warnings;
  AlembicScene scene(path, warnings);
  MeshFile file;
  AlembicMeshReader reader(file.mesh, path, warnings);
  scene.visit([&](const AlembicNode& node) {
    if (reserve && node.is_mesh()) reserve(static_cast<int64_t>(reader.bytes(node)));
    reader.add(node);
  });
  if (file.mesh.face_count() == 0) fail_without(scene, "has no mesh", warnings);
  reader.finish();
  file.warnings = warnings.lines();
  return file;
}

}  // namespace pelage
