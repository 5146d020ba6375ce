// SPDX-License-Identifier: Apache-2.0
#include "rib/scene/rib_surfaces.h"

#include <map>

#include <gtest/gtest.h>

#include "tests/rib/syntax/rib_bytes_of.h"

namespace pelage::rib_surfaces_test {
namespace {

using namespace rib_test;

RibMesh quadric(const std::string& text) {
  std::vector<RibStatement> all = statements_of(text);
  return read_quadric(all);
}

RibMesh patches(const std::string& text, const char* basis = "bezier") {
  std::vector<RibStatement> all = statements_of(text);
  return read_patches(all, RibDeclarations(), *RibBasis::named(basis), *RibBasis::named(basis));
}

/// Number of edges that belong to one face only.
size_t open_edges(const ControlMesh& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, int> faces;
  size_t corner = 0;
  for (const uint32_t size : mesh.face_sizes) {
    for (uint32_t i = 0; i < size; ++i) {
      const uint32_t a = mesh.face_vertices[corner + i], b = mesh.face_vertices[corner + (i + 1) % size];
      ++faces[std::minmax(a, b)];
    }
    corner += size;
  }
  return static_cast<size_t>(
      std::count_if(faces.begin(), faces.end(), [](auto& e) { return e.second == 1; }));
}

Box3f box_of(const ControlMesh& mesh) {
  Box3f box;
  for (const V3f& p : mesh.positions) box.extendBy(p);
  return box;
}

TEST(RibSurfaces, QuadricsHaveTheirExtentAndCloseTheirSeams) {
  struct Case {
    const char* text;
    V3f low, high;
    size_t open;
  };
  for (const Case& c :
       {Case{"Sphere 2 -2 2 360", V3f(-2), V3f(2), 0}, Case{"Sphere 2 -2 0 360", V3f(-2), V3f(2, 2, 0), 48},
        Case{"Sphere 2 -9 9 90", V3f(0, 0, -2), V3f(2), 48},
        Case{"Cone 3 1 360", V3f(-1, -1, 0), V3f(1, 1, 3), 48},
        Case{"Cylinder 1 -1 2 360", V3f(-1), V3f(1, 1, 2), 96},
        Case{"Disk 5 1 360", V3f(-1, -1, 5), V3f(1, 1, 5), 48},
        Case{"Paraboloid 2 0 3 360", V3f(-2, -2, 0), V3f(2, 2, 3), 48},
        Case{"Torus 3 1 0 360 360", V3f(-4, -4, -1), V3f(4, 4, 1), 0},
        Case{"Hyperboloid 1 0 0 1 0 2 360", V3f(-1, -1, 0), V3f(1, 1, 2), 96}}) {
    const ControlMesh mesh = quadric(c.text).cage;
    EXPECT_EQ(open_edges(mesh), c.open) << c.text;
    EXPECT_LT((box_of(mesh).min - c.low).length() + (box_of(mesh).max - c.high).length(), 1e-5f) << c.text;
  }
  for (const V3f& p : quadric("Sphere [2 -2 2 360]").cage.positions) EXPECT_NEAR(p.length(), 2, 1e-6f);
}

TEST(RibSurfaces, QuadricsMove) {
  const RibMesh mesh = quadric("Sphere 1 -1 1 360\nSphere 2 -2 2 360");
  ASSERT_EQ(mesh.samples.size(), 2u);
  EXPECT_NEAR(mesh.samples[1][100].length(), 2, 1e-6f);
}

const std::string kFlat =
    "\"P\" [0 0 0 1 0 0 2 0 0 3 0 0 0 1 0 1 1 0 2 1 0 3 1 0 0 2 0 1 2 0 2 2 0 3 2 0 0 3 0 1 3 0 2 3 0 3 3 0]";

TEST(RibSurfaces, VerticesAreThoseOfAllSamples) {
  // A sphere that closes while the shutter is open.
  const RibMesh closing = quadric("Sphere 1 -1 1 350 Sphere 1 -1 1 360");
  EXPECT_EQ(closing.samples[0].size(), closing.samples[1].size());
  EXPECT_EQ(closing.cage.positions.size(), quadric("Sphere 1 -1 1 350").cage.positions.size());
  // Different corners meet at the two times: no vertex has both positions of another.
  const RibMesh patch = patches(
      "Patch \"bilinear\" \"P\" [0 0 0 0 0 0 0 1 0 1 1 0] Patch \"bilinear\" \"P\" [0 0 0 1 0 0 1 1 0 1 1 "
      "0]");
  ASSERT_EQ(patch.samples[0].size(), 4u);
  EXPECT_EQ(patch.samples[1], (std::vector<V3f>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 0}}));
}

TEST(RibSurfaces, PatchesInterpolateTheirBasis) {
  const Box3f bezier = box_of(patches("Patch \"bicubic\" " + kFlat).cage);
  EXPECT_EQ(bezier.min, V3f(0));
  EXPECT_EQ(bezier.max, V3f(3, 3, 0));
  const Box3f spline = box_of(patches("Patch \"bicubic\" " + kFlat, "b-spline").cage);
  EXPECT_LT((spline.min - V3f(1, 1, 0)).length() + (spline.max - V3f(2, 2, 0)).length(), 1e-6f);
  const ControlMesh sheet = patches(
                                "PatchMesh \"bilinear\" 3 \"periodic\" 2 \"nonperiodic\" \"P\" [0 0 0 1 0 0 "
                                "0 1 0 0 0 1 1 0 1 0 1 1]")
                                .cage;
  EXPECT_EQ(sheet.face_count(), 3u);
  EXPECT_EQ(sheet.positions.size(), 6u);
  EXPECT_EQ(open_edges(sheet), 6u);
}

TEST(RibSurfaces, HeightsRiseAboveTheUnitSquare) {
  const ControlMesh field =
      patches("PatchMesh \"bilinear\" 3 \"nonperiodic\" 2 \"nonperiodic\" \"Pz\" [0 1 2 3 4 5]").cage;
  EXPECT_EQ(field.face_count(), 2u);
  EXPECT_NE(std::find(field.positions.begin(), field.positions.end(), V3f(.5f, 1, 4)), field.positions.end());
  EXPECT_EQ(box_of(field).min, V3f(0));
  EXPECT_EQ(box_of(field).max, V3f(1, 1, 5));
}

// A rational quarter of a circle, swept along z.
TEST(RibSurfaces, NurbsMayBeRational) {
  const ControlMesh mesh = patches(
                               "NuPatch 3 3 [0 0 0 1 1 1] 0 1 2 2 [0 0 1 1] 0 1 \"Pw\" [1 0 0 1 .70710678 "
                               ".70710678 0 .70710678 0 1 0 1 1 0 2 1 "
                               ".70710678 .70710678 1.41421356 .70710678 0 1 2 1]")
                               .cage;
  for (const V3f& p : mesh.positions) EXPECT_NEAR(std::hypot(p.x, p.y), 1, 1e-6f);
  EXPECT_LT((box_of(mesh).max - V3f(1, 1, 2)).length(), 1e-6f);
}

TEST(RibSurfaces, MistakesHavePositions) {
  const auto failure = [](const std::string& text) { return error_of([&] { patches(text); }); };
  EXPECT_EQ(failure("Patch \"biquadric\" " + kFlat),
            "a.rib:1:7: Patch: unknown type 'biquadric'; expected \"bilinear\" or \"bicubic\"");
  EXPECT_EQ(failure("Patch \"bicubic\" \"P\" [0 0 0]"),
            "a.rib:1:1: Patch: parameter \"P\", \"Pw\" or \"Pz\" must have 16 points");
  EXPECT_EQ(failure("PatchMesh \"bicubic\" 5 \"nonperiodic\" 4 \"nonperiodic\" " + kFlat),
            "a.rib:1:1: PatchMesh: 5 points do not form whole segments of a bicubic patch");
  EXPECT_NE(failure("NuPatch 3 9 [0 1] 0 1 2 2 [0 0 1 1] 0 1 " + kFlat).find("3 points of order 9 need"),
            std::string::npos);
  EXPECT_EQ(error_of([] { quadric("Sphere 1 2"); }), "a.rib:1:1: Sphere: expected 4 numbers, got 2");
  EXPECT_NE(failure("NuPatch").find("argument 1 is missing"), std::string::npos);
}

}  // namespace
}  // namespace pelage::rib_surfaces_test
