// SPDX-License-Identifier: Apache-2.0
#include "rib/scene/rib_mesh_reader.h"

#include <gtest/gtest.h>

#include "tests/rib/syntax/rib_bytes_of.h"

namespace pelage::rib_mesh_reader_test {
namespace {

using namespace rib_test;

RibMesh read(const std::string& text) {
  std::vector<RibStatement> all = statements_of(text);
  return read_mesh(all, RibDeclarations());
}

std::string failure(const std::string& text) {
  return error_of([&] { read(text); });
}

const std::string kSquare = " \"P\" [0 0 0 1 0 0 1 1 0 0 1 0]";

TEST(RibMeshReader, SubdivisionMeshesWithTags) {
  const RibMesh mesh = read(
      "SubdivisionMesh \"catmull-clark\" [4] [0 1 2 3] [\"interpolateboundary\" \"crease\" \"corner\" "
      "\"hole\" \"sharp\"] [1 0 3 1 1 1 1 0 0 0] [2 0 1 2 3 0] [2.5 4]" +
      kSquare + " \"facevarying float[2] st\" [0 0 1 0 1 1 0 1]");
  EXPECT_EQ(mesh.scheme, SubdivisionScheme::kCatmullClark);
  EXPECT_EQ(mesh.boundary, BoundaryRule::kEdgeOnly);
  ASSERT_EQ(mesh.cage.creases.size(), 2u);
  EXPECT_EQ(mesh.cage.creases[1].a, 1u);
  EXPECT_EQ(mesh.cage.creases[1].b, 2u);
  EXPECT_EQ(mesh.cage.creases[1].sharpness, 2.5f);
  ASSERT_EQ(mesh.cage.corners.size(), 1u);
  EXPECT_EQ(mesh.cage.corners[0].vertex, 3u);
  EXPECT_EQ(mesh.cage.corners[0].sharpness, 4);
  EXPECT_EQ(mesh.cage.holes, (std::vector<uint32_t>{0}));
  EXPECT_EQ(mesh.ignored, (std::vector<std::string>{"tag 'sharp'"}));
  EXPECT_EQ(mesh.cage.uv[mesh.cage.face_uv[2]], V2f(1, 1));
  EXPECT_EQ(read("SubdivisionMesh \"loop\" [3] [0 1 2]" + kSquare).scheme, SubdivisionScheme::kLoop)
      << "without tags";
}

TEST(RibMeshReader, PolygonsAreNotSubdivided) {
  const RibMesh mesh = read("PointsPolygons [3 3] [0 1 2 0 2 3]" + kSquare +
                            " \"vertex float s\" [0 1 1 0] \"vertex float t\" [0 0 1 1]");
  EXPECT_EQ(mesh.scheme, SubdivisionScheme::kNone);
  EXPECT_EQ(mesh.cage.face_count(), 2u);
  EXPECT_EQ(mesh.cage.uv[mesh.cage.face_uv[5]], V2f(0, 1));
  EXPECT_EQ(read("Polygon" + kSquare).cage.face_vertices, (std::vector<uint32_t>{0, 1, 2, 3}));
}

TEST(RibMeshReader, TheFirstLoopIsTheOutline) {
  const RibMesh mesh = read("PointsGeneralPolygons [2 1] [4 3 3] [0 1 2 3 0 1 2 1 2 3]" + kSquare +
                            " \"facevarying float[2] st\" [0 0 1 0 1 1 0 1 9 9 9 9 9 9 5 5 6 6 7 7]");
  EXPECT_EQ(mesh.cage.face_sizes, (std::vector<uint32_t>{4, 3}));
  EXPECT_EQ(mesh.cage.face_vertices, (std::vector<uint32_t>{0, 1, 2, 3, 1, 2, 3}));
  EXPECT_EQ(mesh.cage.uv[mesh.cage.face_uv[4]], V2f(5, 5));
  EXPECT_EQ(mesh.ignored.size(), 1u);
}

TEST(RibMeshReader, PointsMayHaveWeights) {
  EXPECT_EQ(read("Polygon \"Pw\" [0 0 0 1 2 0 0 2 2 2 0 2]").cage.positions,
            (std::vector<V3f>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}));
}

TEST(RibMeshReader, MotionHasPositionsPerSample) {
  const std::string one = "PointsPolygons [4] [0 1 2 3]";
  const RibMesh mesh = read(one + kSquare + "\n" + one + " \"P\" [0 0 1 1 0 1 1 1 1 0 1 1]");
  ASSERT_EQ(mesh.samples.size(), 2u);
  EXPECT_EQ(mesh.samples[1][2], V3f(1, 1, 1));
  EXPECT_NE(failure(one + kSquare + "\n" + one + " \"P\" [0 0 1]").find("same number of points"),
            std::string::npos);
}

TEST(RibMeshReader, PrefIsTheMeshAtRest) {
  const std::string square = "PointsPolygons [4] [0 1 2 3]" + kSquare;
  EXPECT_TRUE(read(square).rest.empty());
  const RibMesh mesh = read(square + " \"vertex point Pref\" [0 0 5 1 0 5 1 1 5 0 1 5]");
  ASSERT_EQ(mesh.rest.size(), 4u);
  EXPECT_EQ(mesh.rest[2], V3f(1, 1, 5));
  EXPECT_EQ(mesh.cage.positions[2], V3f(1, 1, 0));
  EXPECT_TRUE(read(square + " \"uniform point Pref\" [0 0 5]").rest.empty()) << "for shaders";
  EXPECT_NE(failure(square + " \"vertex point Pref\" [0 0 5]").find("needs 4 points"), std::string::npos);
}

TEST(RibMeshReader, HierarchicalMeshesHaveTagsWithTexts) {
  const RibMesh mesh = read(
      "HierarchicalSubdivisionMesh \"catmull-clark\" [4] [0 1 2 3] [\"creasemethod\" \"crease\" "
      "\"vertexedit\"] [0 0 1 "
      "2 1 0 1 0 2] [0 1 7] [3] [\"chaikin\" \"add\" \"P\"]" +
      kSquare);
  EXPECT_TRUE(mesh.cage.chaikin_creases);
  ASSERT_EQ(mesh.cage.creases.size(), 1u);
  EXPECT_EQ(mesh.cage.creases[0].sharpness, 3);
  EXPECT_EQ(mesh.ignored, (std::vector<std::string>{"tag 'vertexedit'"}));
  EXPECT_EQ(mesh.cage.positions.size(), 4u);
}

TEST(RibMeshReader, FlatFacesAreDropped) {
  const RibMesh mesh =
      read("SubdivisionMesh \"catmull-clark\" [3 4 2] [0 1 1 0 1 2 3 2 3] [\"hole\"] [1 0] [1] []" + kSquare +
           " \"facevarying float[2] st\" [9 9 9 9 9 9 0 0 1 0 1 1 0 1 9 9 9 9]");
  EXPECT_EQ(mesh.cage.face_sizes, (std::vector<uint32_t>{4}));
  EXPECT_EQ(mesh.cage.holes, (std::vector<uint32_t>{0}));
  EXPECT_EQ(mesh.cage.uv[mesh.cage.face_uv[2]], V2f(1, 1));
  EXPECT_EQ(mesh.ignored.size(), 1u);
  EXPECT_EQ(read("PointsPolygons [] [] \"P\" []").cage.face_count(), 0u);
}

TEST(RibMeshReader, GeneralPolygonsHaveAnOutline) {
  EXPECT_EQ(
      read("GeneralPolygon [4 3] \"P\" [0 0 0 1 0 0 1 1 0 0 1 0 .1 .1 0 .2 .1 0 .1 .2 0]").cage.face_vertices,
      (std::vector<uint32_t>{0, 1, 2, 3}));
}

TEST(RibMeshReader, MistakesHavePositions) {
  EXPECT_EQ(failure("PointsPolygons [3] [0 1 9]" + kSquare),
            "a.rib:1:1: PointsPolygons: face 0 has vertex 9, but there are only 4 points");
  EXPECT_EQ(failure("PointsPolygons [4] [0 1 2]" + kSquare),
            "a.rib:1:1: PointsPolygons: the faces have 4 vertices together, but 3 are given");
  EXPECT_EQ(failure("PointsPolygons [999999999] [0]" + kSquare),
            "a.rib:1:1: PointsPolygons: a face has 999999999 vertices");
  EXPECT_NE(failure("PointsGeneralPolygons [9] [3] [0 1 2]" + kSquare).find("do not agree"),
            std::string::npos);
  EXPECT_NE(failure("PointsGeneralPolygons [1] [9] [0 1 2]" + kSquare).find("fewer vertices"),
            std::string::npos);
  EXPECT_NE(failure("SubdivisionMesh \"butterfly\" [3] [0 1 2]" + kSquare).find("unknown scheme"),
            std::string::npos);
  EXPECT_NE(failure("SubdivisionMesh \"loop\" [3] [0 1 2] [\"crease\"] [5 1] [0 1] [1]" + kSquare)
                .find("more arguments"),
            std::string::npos);
  EXPECT_NE(failure("SubdivisionMesh \"loop\" [3] [0 1 2] [\"hole\"] [1 0] [7] []" + kSquare).find("index 7"),
            std::string::npos);
  EXPECT_NE(failure("PointsPolygons [3] [0 1 2]").find("\"P\" must be"), std::string::npos);
  EXPECT_NE(failure("HierarchicalSubdivisionMesh \"loop\" [3] [0 1 2] [\"hole\"] [1 0] [0] [] []" + kSquare)
                .find("each tag needs 3 counts"),
            std::string::npos);
}

}  // namespace
}  // namespace pelage::rib_mesh_reader_test
