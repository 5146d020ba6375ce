// SPDX-License-Identifier: Apache-2.0
#include "rib/host/skin_rib.h"

#include <gtest/gtest.h>

#include "tests/rib/syntax/rib_tokens.h"

namespace pelage {
namespace {

ControlMesh two_faces() {
  ControlMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}};
  mesh.face_sizes = {4, 3};
  mesh.face_vertices = {0, 1, 2, 3, 1, 4, 2};
  mesh.uv = {{0, 0}, {0.5f, 1}};
  mesh.face_uv = {0, 1, 0, 1, 0, 0, 1};
  mesh.creases = {{1, 2, 2.5f}};
  mesh.corners = {{3, 4.0f}};
  mesh.holes = {1};
  mesh.chaikin_creases = true;
  return mesh;
}

std::vector<RibRequest> written(SubdivisionScheme scheme, BoundaryRule boundary, size_t keys) {
  const ControlMesh mesh = two_faces();
  const std::vector<std::vector<V3f>> cages(keys, mesh.positions);
  const std::vector<float> times{0, 0.5f};
  RibText text;
  RibWriter rib(text, RibEncoding::kBinary);
  write_skin(rib, mesh, scheme, boundary, cages, times);
  rib.flush();
  return rib_requests(text.text());
}

TEST(SkinRib, HasFacesTagsAndTextureCoordinates) {
  const auto requests = written(SubdivisionScheme::kCatmullClark, BoundaryRule::kEdgeOnly, 1);
  ASSERT_EQ(requests.size(), 2u);
  EXPECT_EQ(requests[0].parameter("integer chaikin").numbers, std::vector<double>{1});
  const auto& a = requests[1].arguments;
  EXPECT_EQ(requests[1].name, "SubdivisionMesh");
  EXPECT_EQ(a[0].texts[0], "catmull-clark");
  EXPECT_EQ(a[1].numbers, (std::vector<double>{4, 3}));
  EXPECT_EQ(a[2].numbers, (std::vector<double>{0, 1, 2, 3, 1, 4, 2}));
  EXPECT_EQ(a[3].texts, (std::vector<std::string>{"interpolateboundary", "crease", "corner", "hole"}));
  EXPECT_EQ(a[4].numbers, (std::vector<double>{1, 0, 2, 1, 1, 1, 1, 0}));
  EXPECT_EQ(a[5].numbers, (std::vector<double>{2, 1, 2, 3, 1}));
  EXPECT_EQ(a[6].numbers, (std::vector<double>{2.5, 4}));
  EXPECT_EQ(requests[1].parameter("P").numbers.size(), 15u);
  EXPECT_EQ(requests[1].parameter("facevarying float[2] st").numbers,
            (std::vector<double>{0, 0, 0.5, 1, 0, 0, 0.5, 1, 0, 0, 0, 0, 0.5, 1}));
}

TEST(SkinRib, EdgesAndCornersNeedNoArgument) {
  const auto requests = written(SubdivisionScheme::kLoop, BoundaryRule::kEdgeAndCorner, 1);
  EXPECT_EQ(requests[1].arguments[4].numbers[0], 0);
}

TEST(SkinRib, MotionAndPolygons) {
  const auto requests = written(SubdivisionScheme::kNone, BoundaryRule::kEdgeAndCorner, 2);
  std::vector<std::string> names;
  for (const RibRequest& request : requests) names.push_back(request.name);
  EXPECT_EQ(names, (std::vector<std::string>{"Attribute", "MotionBegin", "PointsGeneralPolygons",
                                             "PointsGeneralPolygons", "MotionEnd"}));
  EXPECT_EQ(requests[1].arguments[0].numbers, (std::vector<double>{0, 0.5}));
  EXPECT_EQ(requests[2].arguments[0].numbers, (std::vector<double>{1}));
  EXPECT_EQ(requests[2].arguments[2].numbers, (std::vector<double>{0, 1, 2, 3})) << "without the hole";
}

// Aqsis and others refuse SubdivisionMesh "bilinear".
TEST(SkinRib, BilinearSurfacesArePolygons) {
  const auto requests = written(SubdivisionScheme::kBilinear, BoundaryRule::kEdgeAndCorner, 1);
  EXPECT_EQ(requests[0].parameter("string scheme").texts, (std::vector<std::string>{"bilinear"}));
  EXPECT_EQ(requests[2].name, "PointsGeneralPolygons");
  EXPECT_EQ(requests[2].parameter("facevarying float[2] st").numbers.size(), 8u);
}

TEST(SkinRib, ThePoseAtRestIsWrittenOnlyForOtherPoses) {
  EXPECT_FALSE(written(SubdivisionScheme::kLoop, BoundaryRule::kEdgeOnly, 1)[1].has("vertex point Pref"));
  const ControlMesh mesh = two_faces();
  std::vector<std::vector<V3f>> cages(2, mesh.positions);
  cages[1][4].z = 1;
  RibText text;
  RibWriter rib(text, RibEncoding::kAscii);
  write_skin(rib, mesh, SubdivisionScheme::kLoop, BoundaryRule::kEdgeOnly, cages, std::vector<float>{0, 1});
  rib.flush();
  for (const RibRequest& request : rib_requests(text.text())) {
    if (request.name != "SubdivisionMesh") continue;
    EXPECT_EQ(request.parameter("vertex point Pref").numbers,
              (std::vector<double>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0}));
  }
}

}  // namespace
}  // namespace pelage
