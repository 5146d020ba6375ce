// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/fur_tree_check.h"

#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "tests/render/accel/fur/fur_grooms.h"

namespace pelage {
namespace {

FurTree tree_of(const GroomShape& shape, size_t strands, FurRotation rotation = FurRotation::kWhenUseful) {
  FurTreeOptions options;
  options.build.rotation = rotation;
  const Strands groom = random_groom(shape, strands, 3);
  return FurTree(SnappedStrands(groom, FurGrid(shape.width)), options);
}

class FurTreeCheckOf : public testing::TestWithParam<GroomShape> {};

INSTANTIATE_TEST_SUITE_P(Grooms, FurTreeCheckOf, testing::ValuesIn(groom_shapes()), [](const auto& test) {
  std::string name = test.param.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

TEST_P(FurTreeCheckOf, AcceptsEveryTree) {
  for (const FurRotation rotation : {FurRotation::kNever, FurRotation::kAlways}) {
    const FurTree tree = tree_of(GetParam(), 200, rotation);
    EXPECT_TRUE(has_possible_grid(tree.view()));
    EXPECT_TRUE(has_possible_nodes(tree.view(), tree.node_bytes(), tree.leaf_bytes()));
    const Strands groom = random_groom(GetParam(), 200, 3);
    const size_t segments = SnappedStrands(groom, FurGrid(GetParam().width)).segment_count();
    EXPECT_TRUE(has_possible_segments(tree.view(), tree.node_bytes(), segments));
    EXPECT_FALSE(has_possible_segments(tree.view(), tree.node_bytes(), segments / 2));
  }
}

TEST(FurTreeCheck, RefusesImpossibleGrids) {
  const FurTree tree = tree_of(groom_shapes()[11], 50);
  ASSERT_TRUE(tree.view().frame.turned);
  const auto with = [&](const auto& change) {
    FurTreeView view = tree.view();
    change(view);
    return has_possible_grid(view);
  };
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  for (const int keys : {-1, 0, 65})
    EXPECT_FALSE(with([&](FurTreeView& view) { view.motion_keys = keys; })) << keys;
  for (const float step : {0.0f, -0.5f, 0.3f, nan, inf, 1e-42f})
    EXPECT_FALSE(with([&](FurTreeView& view) { view.step = step; })) << step;
  for (const float bad : {nan, inf}) {
    EXPECT_FALSE(with([&](FurTreeView& view) { view.anchor.y = bad; }));
    EXPECT_FALSE(with([&](FurTreeView& view) { view.reach = bad; }));
  }
  EXPECT_FALSE(with([&](FurTreeView& view) { view.reach = -1; }));

  const auto with_axes = [&](const V3f& x, const V3f& y, const V3f& z) {
    return with([&](FurTreeView& view) { view.frame.axes = {x, y, z}; });
  };
  const V3f x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  EXPECT_TRUE(with_axes(x, y, z));
  EXPECT_FALSE(with_axes(x, y, x));
  EXPECT_FALSE(with_axes(x, 1.1f * y, z));
  EXPECT_FALSE(with_axes(x, y, V3f(0)));
  EXPECT_FALSE(with_axes(x, V3f(nan, 1, 0), z));
  EXPECT_FALSE(with_axes(x, y, V3f(0, 0, inf)));
}

TEST(FurTreeCheck, RefusesReferencesThatLeadNowhere) {
  const FurTree tree = tree_of(groom_shapes()[0], 20);
  FurTreeView view = tree.view();
  PageBlock nodes(tree.node_bytes());
  view.nodes = nodes.data();
  const auto with_child = [&](size_t i, uint32_t bits) {
    std::memcpy(nodes.data(), tree.view().nodes, tree.node_bytes());
    std::memcpy(nodes.data() + FurQuantisedNode::kReferences + i * sizeof(bits), &bits, sizeof(bits));
    return has_possible_nodes(view, tree.node_bytes(), tree.leaf_bytes());
  };
  EXPECT_FALSE(with_child(0, 0xdddddddd));
  EXPECT_FALSE(with_child(0, 0x7fffffff));
  EXPECT_FALSE(with_child(0, 1));  // into the middle of the root
  const uint32_t first = child_reference(tree.view().nodes, 0).bits();
  EXPECT_TRUE(with_child(0, first));
  EXPECT_FALSE(with_child(1, first));  // a node that is the child of two
  // The last leaf extends beyond the end.
  EXPECT_FALSE(has_possible_nodes(tree.view(), tree.node_bytes(), tree.leaf_bytes() - 1));
  EXPECT_FALSE(has_possible_nodes(tree.view(), tree.node_bytes() - 1, tree.leaf_bytes()));
  EXPECT_FALSE(has_possible_nodes(tree.view(), 0, tree.leaf_bytes()));
}

TEST(FurTreeCheck, RefusesTreesThatAreTooDeep) {
  const size_t size = FurQuantisedNode::size(1);
  const auto chain = [&](size_t levels) {
    PageBlock nodes(levels * size);
    for (size_t n = 0; n < levels; ++n) {
      const bool last = n + 1 == levels;
      const FurBox box{{0, 0, 0}, {1, 1, 1}};
      const FurChild child{last ? FurReference::to_leaf(0, 1, false) : FurReference::to_node((n + 1) * size),
                           std::span(&box, 1)};
      write_node(1, std::span(&child, 1), nodes.data() + n * size);
    }
    FurTreeView view;
    view.nodes = nodes.data();
    return has_possible_nodes(view, levels * size, 1 << 10);
  };
  EXPECT_TRUE(chain(80));
  EXPECT_FALSE(chain(81));
}

}  // namespace
}  // namespace pelage
