// SPDX-License-Identifier: Apache-2.0
#include "starter/body_shape.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"

namespace pelage::body_shape_test {

/// Boxes, joined into one mesh.
class Blocks {
 public:
  Blocks& add(const V3f& low, const V3f& high) {
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (int i = 0; i < 8; ++i)
      mesh.positions.emplace_back(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
    for (const auto& face : {std::array<uint32_t, 4>{0, 2, 3, 1},
                             {4, 5, 7, 6},
                             {0, 1, 5, 4},
                             {2, 6, 7, 3},
                             {0, 4, 6, 2},
                             {1, 3, 7, 5}}) {
      mesh.face_sizes.push_back(4);
      for (const uint32_t corner : face) mesh.face_vertices.push_back(first + corner);
    }
    return *this;
  }
  ControlMesh mesh;
};

/// A quadruped that faces +z, with y up: 4 long, 3 high and 1 wide.
ControlMesh animal() {
  Blocks blocks;
  blocks.add({-0.5f, 1, 0}, {0.5f, 2, 3});                                             // trunk
  blocks.add({-0.3f, 2, 3}, {0.3f, 3, 4}).add({-0.2f, 2.8f, 3.2f}, {-0.1f, 3, 3.4f});  // head, ear
  blocks.add({0.1f, 2.8f, 3.2f}, {0.2f, 3, 3.4f});
  for (const float x : {-0.5f, 0.3f})
    for (const float z : {0.0f, 2.7f}) blocks.add({x, 0, z}, {x + 0.2f, 1, z + 0.3f});
  return blocks.mesh;
}

ControlMesh moved(ControlMesh mesh, const auto& move) {
  for (V3f& point : mesh.positions) point = move(point);
  return mesh;
}

std::string axes(const BodyShape& shape) { return shape.facing.name() + " " + shape.up.name(); }

TEST(BodyShape, FindsTheAxesOfAnAnimalThatIsTurnedMovedAndScaled) {
  EXPECT_EQ(axes(body_shape(animal(), "a")), "z y");
  EXPECT_EQ(axes(body_shape(moved(animal(), [](V3f p) { return V3f(-p.x, p.y, -p.z); }), "a")), "-z y");
  EXPECT_EQ(axes(body_shape(moved(animal(), [](V3f p) { return V3f(p.z, p.y, -p.x); }), "a")), "x y");
  EXPECT_EQ(axes(body_shape(moved(animal(), [](V3f p) { return V3f(-p.z, p.y, p.x); }), "a")), "-x y");
  EXPECT_EQ(axes(body_shape(moved(animal(), [](V3f p) { return V3f(p.x, -p.z, p.y); }), "a")), "-y z");
  EXPECT_EQ(axes(body_shape(moved(animal(), [](V3f p) { return p * 1e5f + V3f(3e6f, 0, 0); }), "a")), "z y");
  EXPECT_EQ(axes(body_shape(moved(animal(), [](V3f p) { return p * 1e-3f; }), "a")), "z y");
}

TEST(BodyShape, FlagsReplaceTheGuesses) {
  EXPECT_EQ(axes(body_shape(animal(), "a", {}, parse_axis("-x"))), "-x y");
  EXPECT_EQ(axes(body_shape(animal(), "a", parse_axis("z"), parse_axis("y"))), "y z");
  EXPECT_EQ(axes(body_shape(animal(), "a", {}, parse_axis("+y"))), "y z") << "y can no longer be up";
  EXPECT_FALSE(parse_axis("w"));
  EXPECT_FALSE(parse_axis("--x"));
  EXPECT_FALSE(parse_axis(""));
}

TEST(BodyShape, DoubledFacesAndUnusedVerticesDoNotCount) {
  ControlMesh mesh = animal();
  const BodyShape single = body_shape(mesh, "a");
  const std::vector<uint32_t> corners = mesh.face_vertices;
  mesh.face_vertices.insert(mesh.face_vertices.end(), corners.rbegin(), corners.rend());
  mesh.face_sizes.insert(mesh.face_sizes.end(), mesh.face_sizes.begin(), mesh.face_sizes.end());
  mesh.positions.emplace_back(1e6f, 0, 0);
  const BodyShape doubled = body_shape(mesh, "a");
  EXPECT_EQ(single.doubled_faces, 0u);
  EXPECT_EQ(doubled.doubled_faces, mesh.face_count() / 2);
  EXPECT_EQ(doubled.area, single.area);
  EXPECT_EQ(doubled.box, single.box);
}

TEST(BodyShape, SizeSchemeAndUnitFollowFromTheMesh) {
  const BodyShape cube = body_shape(Blocks().add({0, 0, 0}, {2, 2, 2}).mesh, "a");
  EXPECT_FLOAT_EQ(cube.area, 24);
  EXPECT_NEAR(cube.size(), 2.764, 1e-3);
  EXPECT_EQ(cube.scheme, SubdivisionScheme::kCatmullClark);
  EXPECT_EQ(cube.meters_per_unit, 1.0f);
  EXPECT_EQ(body_shape(Blocks().add({0, 0, 0}, {50, 50, 50}).mesh, "a").meters_per_unit, 0.01f);
  EXPECT_EQ(body_shape(Blocks().add({0, 0, 0}, {500, 50, 50}).mesh, "a").meters_per_unit, 0.001f);
  ControlMesh grid;  // 32 x 32 pairs of triangles
  for (int i = 0; i <= 32; ++i)
    for (int j = 0; j <= 32; ++j) grid.positions.emplace_back(i, 0, j);
  for (uint32_t i = 0; i < 32; ++i) {
    for (uint32_t j = 0; j < 32; ++j) {
      const uint32_t a = 33 * i + j;
      for (const uint32_t corner : {a, a + 1, a + 33, a + 33, a + 1, a + 34})
        grid.face_vertices.push_back(corner);
      grid.face_sizes.insert(grid.face_sizes.end(), 2, 3);
    }
  }
  EXPECT_EQ(body_shape(grid, "a").scheme, SubdivisionScheme::kNone);
}

TEST(BodyShape, AMeshWithoutAreaIsRefused) {
  try {
    body_shape(Blocks().add({0, 0, 0}, {0, 0, 0}).mesh, "dot.obj");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "dot.obj: its faces have no area");
  }
}

/// A ball of quads.
void add_ball(ControlMesh& mesh, const V3f& center, const V3f& radius) {
  constexpr int kRows = 24, kColumns = 48;
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (int i = 0; i <= kRows; ++i) {
    for (int j = 0; j < kColumns; ++j) {
      const float polar = 3.14159265f * static_cast<float>(i) / kRows;
      const float turn = 6.2831853f * static_cast<float>(j) / kColumns;
      mesh.positions.push_back(center + radius * V3f(std::sin(polar) * std::cos(turn), std::cos(polar),
                                                     std::sin(polar) * std::sin(turn)));
    }
  }
  for (uint32_t i = 0; i < kRows; ++i) {
    for (uint32_t j = 0; j < kColumns; ++j) {
      const uint32_t a = first + i * kColumns + j, b = first + i * kColumns + (j + 1) % kColumns;
      mesh.face_sizes.push_back(4);
      for (const uint32_t corner : {a, b, b + kColumns, a + kColumns}) mesh.face_vertices.push_back(corner);
    }
  }
}

TEST(Scalp, IsTheTopAndTheBackOfTheHead) {
  for (const bool has_body : {false, true}) {
    ControlMesh mesh;
    add_ball(mesh, V3f(0, 10, 0), V3f(0.8f, 1.2f, 1));
    if (has_body) {
      add_ball(mesh, V3f(0, 8.5f, 0), V3f(0.3f, 1, 0.3f));
      add_ball(mesh, V3f(0, 6, 0), V3f(2, 2, 1));
    }
    const BodyShape shape = body_shape(mesh, "head.obj", AxisDirection{1, 1}, AxisDirection{2, 1});
    const auto grows = [&](const V3f& at) { return at.y > shape.scalp.height + shape.scalp.slope * at.z; };
    EXPECT_TRUE(grows(V3f(0, 11.2f, 0))) << "crown";
    EXPECT_TRUE(grows(V3f(0, 10, -1))) << "back";
    EXPECT_FALSE(grows(V3f(0, 10, 1))) << "face";
    EXPECT_FALSE(grows(V3f(0, 9, 0.3f))) << "throat";
    EXPECT_FALSE(grows(V3f(2, 6, 0))) << "shoulder";
    const float ball = 12.5f;  // area of the head
    EXPECT_GT(shape.scalp.area, 0.35f * ball);
    EXPECT_LT(shape.scalp.area, 0.65f * ball);
  }
}

}  // namespace pelage::body_shape_test
