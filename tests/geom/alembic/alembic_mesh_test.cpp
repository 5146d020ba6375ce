// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/file.h"
#include "base/temporary_folder.h"
#include "geom/alembic/alembic_mesh_file.h"
#include "geom/interchange/mesh_joiner.h"
#include "geom/io/mesh_file.h"
#include "geom/usd/usd_mesh_file.h"
#include "tests/geom/alembic/ogawa_bytes.h"
#include "tests/support/allocation_meter.h"

namespace pelage::alembic_mesh_test {
namespace {

using namespace ogawa_bytes;

MeshFile read(const std::string& bytes, const MeshReserve& reserve = {}) {
  const TemporaryFolder folder;
  write_file(folder.path() / "a.abc", bytes);
  return read_alembic_mesh(folder.path() / "a.abc", reserve);
}
std::string refusal(const std::string& bytes) {
  try {
    read(bytes);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_EQ(error.problems().size(), 1u);
    return error.what();
  }
  return "accepted";
}

/// A quad and a triangle over five points.
std::vector<Part> faces(OgawaBytes& b, const std::vector<int32_t>& indices = {0, 1, 2, 3, 3, 2, 4},
                        const std::vector<int32_t>& counts = {4, 3}) {
  return {b.array("P", kFloat, 3, {raw<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 2, 0})}),
          b.array(".faceIndices", kInt32, 1, {raw(indices)}),
          b.array(".faceCounts", kInt32, 1, {raw(counts)})};
}

TEST(AlembicMesh, SubdivisionMeshesAreThoseOfUsd) {
  OgawaBytes b;
  std::vector<Part> geometry = faces(b);
  const std::vector<Part> tags{
      b.array(".creaseIndices", kInt32, 1, {raw<int32_t>({0, 1, 2, 3, 2})}),
      b.array(".creaseLengths", kInt32, 1, {raw<int32_t>({3, 2})}),
      b.array(".creaseSharpnesses", kFloat, 1, {raw<float>({2, 1.5f})}),
      b.array(".cornerIndices", kInt32, 1, {raw<int32_t>({4})}),
      b.array(".cornerSharpnesses", kFloat, 1, {raw<float>({3})}),
      b.array(".holes", kInt32, 1, {raw<int32_t>({1})}),
      b.scalar(".interpolateBoundary", kInt32, 1, {raw<int32_t>({2})}),
      b.compound("uv",
                 {b.array(".vals", kFloat, 2, {raw<float>({0, 0, 1, 0, 1, 1, 0, 1})}, "geoScope=fvr"),
                  b.array(".indices", kUint32, 1, {raw<uint32_t>({0, 1, 2, 3, 3, 2, 1})})},
                 "geoScope=fvr"),
      b.compound(".arbGeomParams",
                 {b.array("Cd", kFloat, 3, {raw<float>({0, 0, 0, 0, 0, 0, 1, 0.5f, 0, 0, 0, 0, 0, 0, 0})},
                          "geoScope=vtx")})};
  geometry.insert(geometry.end(), tags.begin(), tags.end());
  const Part set = b.object("ear", "AbcGeom_FaceSet_v1",
                            {b.compound(".faceset", {b.array(".faces", kInt32, 1, {raw<int32_t>({1})})})});
  const Part mesh = b.object("m", "AbcGeom_SubD_v1", {b.compound(".geom", geometry)}, {set});
  std::vector<int64_t> charges;
  const MeshFile file = read(b.file({mesh}), [&](int64_t bytes) { charges.push_back(bytes); });
  EXPECT_EQ(file.warnings, std::vector<std::string>());
  ASSERT_EQ(charges.size(), 1u);
  EXPECT_GE(charges[0], static_cast<int64_t>(file.mesh.bytes()));
  const MeshFile usd = read_usd_mesh({"a.usda", R"(#usda 1.0
def Mesh "m" {
  uniform token orientation = "leftHanded"
  uniform token interpolateBoundary = "edgeOnly"
  int[] faceVertexCounts = [4, 3]
  int[] faceVertexIndices = [0, 1, 2, 3, 3, 2, 4]
  point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 2, 0)]
  int[] creaseIndices = [0, 1, 2, 3, 2]
  int[] creaseLengths = [3, 2]
  float[] creaseSharpnesses = [2, 1.5]
  int[] cornerIndices = [4]
  float[] cornerSharpnesses = [3]
  int[] holeIndices = [1]
  texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)] (interpolation = "faceVarying")
  int[] primvars:st:indices = [0, 1, 2, 3, 3, 2, 1]
  color3f[] primvars:displayColor = [(0,0,0),(0,0,0),(1,0.5,0),(0,0,0),(0,0,0)] (interpolation = "vertex")
  def GeomSubset "ear" { int[] indices = [1] }
})"});
  const ControlMesh &a = file.mesh, &c = usd.mesh;
  EXPECT_EQ(a.positions, c.positions);
  EXPECT_EQ(a.face_sizes, c.face_sizes);
  EXPECT_EQ(a.face_vertices, c.face_vertices);
  EXPECT_EQ(a.face_vertices, (std::vector<uint32_t>{3, 2, 1, 0, 4, 2, 3}));
  EXPECT_EQ(a.uv, c.uv);
  EXPECT_EQ(a.face_uv, c.face_uv);
  EXPECT_EQ(a.holes, c.holes);
  EXPECT_EQ(a.colors, c.colors);
  EXPECT_EQ(a.groups, c.groups);
  EXPECT_EQ(a.face_groups, c.face_groups);
  EXPECT_EQ(a.objects.names, c.objects.names);
  EXPECT_EQ(a.boundary_tag, c.boundary_tag);
  ASSERT_EQ(a.creases.size(), 3u);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(a.creases[i].a, c.creases[i].a);
    EXPECT_EQ(a.creases[i].b, c.creases[i].b);
    EXPECT_EQ(a.creases[i].sharpness, c.creases[i].sharpness);
  }
  ASSERT_EQ(a.corners.size(), 1u);
  EXPECT_EQ(a.corners[0].sharpness, 3);
}

TEST(AlembicMesh, SeveralMeshesAreJoined) {
  OgawaBytes b;
  const Part plain = b.object("plain", "AbcGeom_PolyMesh_v1", {b.compound(".geom", faces(b))});
  std::vector<Part> geometry = faces(b);
  geometry.push_back(b.array("uv", kFloat, 2, {raw<float>({0, 0, 1, 0, 1, 1, 0, 1, 0, 2})}, "geoScope=vtx"));
  const Part mirrored = b.object("mirrored", "AbcGeom_PolyMesh_v1", {b.compound(".geom", geometry)});
  const std::vector<Part> xform{b.scalar(".ops", kUint8, 1, {std::string(1, '\0')}),
                                b.scalar(".vals", kDouble, 3, {raw<double>({-1, 1, 1})})};
  const Part parent = b.object("x", "AbcGeom_Xform_v3", {b.compound(".xform", xform)}, {mirrored});
  const ControlMesh mesh = read(b.file({plain, parent})).mesh;
  EXPECT_EQ(mesh.positions.size(), 10u);
  EXPECT_EQ(mesh.positions[6], V3f(-1, 0, 0));
  // Mirrored faces keep their order, which is clockwise before they are mirrored.
  EXPECT_EQ(mesh.face_vertices, (std::vector<uint32_t>{3, 2, 1, 0, 4, 2, 3, 5, 6, 7, 8, 8, 7, 9}));
  EXPECT_EQ(mesh.face_uv.size(), 14u);
  EXPECT_EQ(mesh.uv[mesh.face_uv[0]], V2f(0));
  EXPECT_EQ(mesh.uv[mesh.face_uv[13]], V2f(0, 2));
  EXPECT_EQ(mesh.objects.names, (std::vector<std::string>{"plain", "mirrored"}));
}

/// A strip of quads with creases, corners, holes, indexed uv and wide colours, and face sets.
Part strip(OgawaBytes& b, const std::string& name, int32_t quads, bool colors) {
  std::vector<float> points;
  std::vector<int32_t> indices, set;
  std::vector<uint32_t> uv;
  for (int32_t i = 0; i <= quads; ++i) {
    const auto x = static_cast<float>(i);
    points.insert(points.end(), {x, 0, 0, x, 1, 0});
  }
  for (int32_t i = 0; i < quads; ++i) {
    indices.insert(indices.end(), {2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2});
    uv.insert(uv.end(), 4, 0);
    set.push_back(i);
  }
  const auto n = static_cast<size_t>(quads);
  std::vector<Part> geometry{b.array("P", kFloat, 3, {raw(points)}),
                             b.array(".faceIndices", kInt32, 1, {raw(indices)}),
                             b.array(".faceCounts", kInt32, 1, {raw(std::vector<int32_t>(n, 4))}),
                             b.array(".holes", kInt32, 1, {raw(set)}),
                             b.array(".cornerIndices", kInt32, 1, {raw(set)}),
                             b.array(".cornerSharpnesses", kFloat, 1, {raw(std::vector<float>(n, 1))}),
                             b.array(".creaseIndices", kInt32, 1, {raw(set)}),
                             b.array(".creaseLengths", kInt32, 1, {raw<int32_t>({quads})}),
                             b.array(".creaseSharpnesses", kFloat, 1, {raw<float>({1})}),
                             b.compound("uv",
                                        {b.array(".vals", kFloat, 2, {raw<float>({0, 0})}, "geoScope=fvr"),
                                         b.array(".indices", kUint32, 1, {raw(uv)})},
                                        "geoScope=fvr")};
  if (colors) {
    geometry.push_back(b.compound(
        ".arbGeomParams",
        {b.compound("Cd",
                    {b.array(".vals", kFloat, 16, {raw(std::vector<float>(16, 1))}, "geoScope=vtx"),
                     b.array(".indices", kUint32, 1, {raw(std::vector<uint32_t>(points.size() / 3, 0))})},
                    "geoScope=vtx")}));
  }
  std::vector<Part> sets;
  for (const char* one : {"a", "b"}) {
    sets.push_back(b.object(one, "AbcGeom_FaceSet_v1",
                            {b.compound(".faceset", {b.array(".faces", kInt32, 1, {raw(set)})})}));
  }
  return b.object(name, "AbcGeom_SubD_v1", {b.compound(".geom", geometry)}, sets);
}

TEST(AlembicMesh, MemoryIsReservedBeforeItIsTaken) {
  const TemporaryFolder folder;
  // Sizes just above powers of two waste most when arrays double.
  const std::vector<std::vector<std::pair<int32_t, bool>>> files{{{8200, true}},
                                                                 {{8200, false}},
                                                                 {{8200, true}, {8200, false}},
                                                                 {{8200, false}, {10, true}, {5000, false}}};
  for (const auto& meshes : files) {
    OgawaBytes b;
    std::vector<Part> objects;
    for (const auto& [quads, colors] : meshes)
      objects.push_back(strip(b, "m" + std::to_string(objects.size()), quads, colors));
    write_file(folder.path() / "a.abc", b.file(objects));
    reset_peak();
    const size_t before = live_bytes();
    int64_t reserved = 0;
    const MeshFile file = read_alembic_mesh(folder.path() / "a.abc", [&](int64_t bytes) {
      // What is held now was reserved before; 64 KiB: paths and headers.
      const size_t taken = reserved > 0 ? peak_bytes() - before : 0;
      EXPECT_LE(taken, static_cast<size_t>(reserved) + (1 << 16));
      reserved = bytes;
    });
    EXPECT_LE(peak_bytes() - before, static_cast<size_t>(reserved) + (1 << 16));
    EXPECT_GE(static_cast<size_t>(reserved), file.mesh.bytes());
  }
}

TEST(AlembicMesh, ColoursOfAnotherSizeAreSkipped) {
  OgawaBytes b;
  std::vector<Part> geometry = faces(b);
  geometry.push_back(b.compound(".arbGeomParams",
                                {b.array("Cd", kFloat, 3, {raw(std::vector<float>(9, 1))}, "geoScope=vtx")}));
  const MeshFile file = read(b.file({b.object("m", "AbcGeom_PolyMesh_v1", {b.compound(".geom", geometry)})}));
  EXPECT_TRUE(file.mesh.colors.empty());
  ASSERT_EQ(file.warnings.size(), 1u);
  EXPECT_NE(file.warnings[0].find("'Cd' has 3 values"), std::string::npos);
}

TEST(AlembicMesh, BadMeshesAreRefused) {
  const auto with = [](const std::vector<int32_t>& indices, const std::vector<int32_t>& counts,
                       const char* tag = nullptr, const std::vector<int32_t>& values = {}) {
    OgawaBytes b;
    std::vector<Part> geometry = faces(b, indices, counts);
    if (tag) geometry.push_back(b.array(tag, kInt32, 1, {raw(values)}));
    return refusal(b.file({b.object("m", "AbcGeom_SubD_v1", {b.compound(".geom", geometry)})}));
  };
  EXPECT_NE(with({0, 1, 5}, {3}).find("a.abc: </m>: the index 5 is not one of 5 points"), std::string::npos);
  EXPECT_NE(with({0, 1, -7}, {3}).find("</m>: .faceIndices has the number -7"), std::string::npos);
  EXPECT_NE(with({0, 1, 2}, {-3}).find("</m>: .faceCounts has the number -3"), std::string::npos);
  EXPECT_NE(with({0, 1, 1}, {3}).find("face 0 has fewer than 3 different points"), std::string::npos);
  EXPECT_NE(with({0, 1, 2}, {4}).find("need more indices"), std::string::npos);
  EXPECT_NE(with({0, 1, 2}, {1'000'000'000}).find("need more indices"), std::string::npos);
  EXPECT_NE(with({0, 1, 2, 3}, {3}).find("need fewer indices"), std::string::npos);
  EXPECT_NE(with({0, 1, 2}, {3}, ".holes", {1}).find("a hole is not one"), std::string::npos);
  EXPECT_NE(with({0, 1, 2}, {3}, ".creaseLengths", {2}).find("creases need more"), std::string::npos);
  EXPECT_NE(with({0, 1, 2}, {3}, ".cornerIndices", {1}).find("too few sharpnesses"), std::string::npos);
  OgawaBytes large;
  std::vector<Part> geometry = faces(large);
  geometry[1] = large.array(".faceIndices", Pod(8), 1, {raw<int64_t>({0, 1, 5'000'000'000})});
  geometry[2] = large.array(".faceCounts", kInt32, 1, {raw<int32_t>({3})});
  EXPECT_NE(
      refusal(large.file({large.object("m", "AbcGeom_PolyMesh_v1", {large.compound(".geom", geometry)})}))
          .find("has the number 5000000000"),
      std::string::npos);
  OgawaBytes b;
  const Part curves = b.curves("c", {3}, linear_form());
  EXPECT_NE(refusal(b.file({curves})).find("has no mesh"), std::string::npos);
  const Part hidden =
      b.object("m", "AbcGeom_PolyMesh_v1",
               {b.compound(".geom", faces(b)), b.scalar("visible", kInt8, 1, {std::string(1, '\0')})});
  EXPECT_NE(refusal(b.file({hidden})).find("a.abc: has no mesh; hidden objects are skipped"),
            std::string::npos);
}

TEST(AlembicMesh, TooManyFacesAreRefusedWithTheFile) {
  ControlMesh mesh;
  MeshJoiner joiner(mesh, "a.abc", 4);
  MeshPart part;
  part.name = "m";
  part.points = {V3f(0, 0, 0), V3f(1, 0, 0), V3f(0, 1, 0)};
  part.face_sizes = {3};
  part.face_vertices = {0, 1, 2};
  joiner.add(part);
  try {
    joiner.add(part);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), "a.abc: the meshes up to 'm' have too many points or faces");
  }
}

}  // namespace
}  // namespace pelage::alembic_mesh_test
