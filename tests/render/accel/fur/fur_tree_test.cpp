// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/fur_tree.h"

#include <cstring>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "render/accel/flush_denormals.h"
#include "render/accel/fur/fur_leaf.h"
#include "tests/render/accel/fur/fur_grooms.h"
#include "tests/support/effort.h"

namespace pelage::fur_tree_test {
namespace {

constexpr size_t kStrands = 300;
constexpr uint64_t kRays = repetitions(2500);

FurTreeOptions options_of(float node_cost, FurRotation rotation = FurRotation::kNever) {
  FurTreeOptions options;
  options.build.rotation = rotation;
  options.build.node_cost = node_cost;
  return options;
}

bool same_bits(const FurHit& a, const FurHit& b) {
  return a.number == b.number && a.distance == b.distance && (!a || (a.u == b.u && a.h == b.h));
}

/// Puts every other strand of a batch into a batch of its own.
Strands every_other(const Strands& strands, size_t offset) {
  StrandArrays a;
  a.basis = strands.basis();
  a.motion_keys = strands.motion_keys();
  a.first_point.push_back(0);
  for (int key = 0; key < strands.motion_keys(); ++key) {
    for (size_t s = offset; s < strands.strand_count(); s += 2) {
      const auto first =
          strands.points(key).begin() + 4 * static_cast<std::ptrdiff_t>(strands.first_point(s));
      a.points.insert(a.points.end(), first,
                      first + 4 * static_cast<std::ptrdiff_t>(strands.strand_points(s)));
    }
  }
  for (size_t s = offset; s < strands.strand_count(); s += 2) {
    a.first_point.push_back(a.first_point.back() + strands.strand_points(s));
    a.ids.push_back(strands.id(s));
  }
  return Strands(std::move(a));
}

class FurTreeOf : public testing::TestWithParam<GroomShape> {
 protected:
  FurTreeOf()
      : strands_(random_groom(GetParam(), kStrands, 7)),
        snapped_(strands_, FurGrid(GetParam().width)),
        tree_(snapped_, options_of(1)) {}

  template <class Check>
  void with_rays(const Check& check) {
    const FlushDenormals flush;
    TestRandom random(8);
    uint64_t hits = 0;
    for (uint64_t i = 0; i < kRays; ++i) {
      const Ray ray = ray_at_groom(GetParam(), strands_, random, i);
      const FurHit expected = tree_.closest(ray, {});
      hits += bool(expected);
      check(ray, expected, i);
      if (testing::Test::HasFatalFailure()) return;
    }
    EXPECT_GT(hits, kRays / 100);
  }

  Strands strands_;
  SnappedStrands snapped_;
  FurTree tree_;
};

TEST_P(FurTreeOf, answers_alike_in_every_shape) {
  const FurTree others[] = {FurTree(snapped_, options_of(0)), FurTree(snapped_, options_of(3)),
                            FurTree(snapped_, options_of(1, FurRotation::kAlways)),
                            FurTree(snapped_, options_of(3, FurRotation::kAlways))};
  with_rays([&](const Ray& ray, const FurHit& expected, uint64_t i) {
    for (const FurTree& other : others) {
      ASSERT_TRUE(same_bits(expected, other.closest(ray, {}))) << i;
      ASSERT_EQ(bool(expected), other.occluded(ray, {})) << i;
    }
  });
}

TEST_P(FurTreeOf, answers_alike_however_it_is_cut_into_chunks) {
  const Strands parts[] = {every_other(strands_, 0), every_other(strands_, 1)};
  const SnappedStrands snapped[] = {SnappedStrands(parts[0], snapped_.grid()),
                                    SnappedStrands(parts[1], snapped_.grid())};
  const FurTree trees[] = {FurTree(snapped[0], {}), FurTree(snapped[1], {})};
  const auto name = [](const SnappedStrands& of, const Strands& strands, const FurHit& hit) {
    const SnappedStrands::Place place = of.locate(hit.number);
    return std::pair(strands.id(place.strand), place.segment);
  };
  with_rays([&](const Ray& ray, const FurHit& expected, uint64_t i) {
    const FurHit hits[] = {trees[0].closest(ray, {}), trees[1].closest(ray, {})};
    ASSERT_EQ(bool(expected), hits[0] || hits[1]) << i;
    if (!expected) return;
    const size_t first = hits[0].distance != hits[1].distance
                             ? hits[1].distance < hits[0].distance
                             : name(snapped[1], parts[1], hits[1]) < name(snapped[0], parts[0], hits[0]);
    ASSERT_EQ(name(snapped_, strands_, expected), name(snapped[first], parts[first], hits[first])) << i;
    ASSERT_EQ(expected.distance, hits[first].distance) << i;
    ASSERT_EQ(expected.u, hits[first].u) << i;
    ASSERT_EQ(expected.h, hits[first].h) << i;
  });
}

TEST_P(FurTreeOf, answers_alike_on_every_instruction_set) {
  for (const int64_t target : {HWY_EMU128, HWY_SSE4, HWY_AVX2, HWY_AVX3}) {
    hwy::SetSupportedTargetsForTest(0);
    if (target != HWY_EMU128 && (hwy::SupportedTargets() & target) == 0) continue;
    with_rays([&](const Ray& ray, const FurHit& expected, uint64_t i) {
      hwy::SetSupportedTargetsForTest(target);
      hwy::GetChosenTarget().Update(target);
      const FurHit hit = tree_.closest(ray, {});
      const bool occluded = tree_.occluded(ray, {});
      hwy::SetSupportedTargetsForTest(0);
      hwy::GetChosenTarget().Update(hwy::SupportedTargets());
      ASSERT_TRUE(same_bits(expected, hit)) << i;
      ASSERT_EQ(bool(expected), occluded) << i;
    });
  }
}

TEST_P(FurTreeOf, holds_together_wherever_it_stands) {
  PageBlock copy(tree_.bytes());
  std::memcpy(copy.data(), tree_.view().nodes, tree_.bytes());
  FurTreeView view = tree_.view();
  view.leaves = copy.data() + (view.leaves - view.nodes);
  view.nodes = copy.data();
  with_rays([&](const Ray& ray, const FurHit& expected, uint64_t i) {
    ASSERT_TRUE(same_bits(expected, closest_fur(view, ray, {}, nullptr))) << i;
  });
}

INSTANTIATE_TEST_SUITE_P(grooms, FurTreeOf, testing::ValuesIn(groom_shapes_at_any_distance()),
                         [](const auto& of) {
                           std::string name = of.param.name;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

TEST(FurTree, is_the_same_every_time) {
  const Strands strands = random_groom(groom_shapes()[1], 500, 1);
  const SnappedStrands snapped(strands, FurGrid(0.02f));
  const FurTree a(snapped, {}), b(snapped, {});
  ASSERT_EQ(a.bytes(), b.bytes());
  EXPECT_EQ(0, std::memcmp(a.view().nodes, b.view().nodes, a.node_bytes() + a.leaf_bytes()));
}

TEST(FurTree, fills_its_lanes) {
  const Strands strands = random_groom(groom_shapes()[0], 3000, 1);
  const SnappedStrands snapped(strands, FurGrid(0.02f));
  const FurTree tree(snapped, {});
  const double blocks = static_cast<double>(tree.leaf_bytes()) / static_cast<double>(kNarrowBlock.block(1));
  EXPECT_GT(snapped.segment_count() / (4 * blocks), 0.97);
}

TEST(FurTree, of_nothing_meets_nothing) {
  const Strands none;
  const SnappedStrands snapped(none, FurGrid(0.02f));
  const FurTree tree(snapped, {});
  EXPECT_EQ(tree.bytes(), 0u);
  EXPECT_FALSE(tree.closest(Ray(), {}));
  EXPECT_FALSE(tree.occluded(Ray(), {}));
}

TEST(FurTree, lets_the_smaller_id_stand_first) {
  // Three times the same strand: ids 9, 4, 7.
  StrandArrays a;
  a.first_point.push_back(0);
  for (uint64_t id : {9, 4, 7}) {
    for (int i = 0; i < 6; ++i) a.points.insert(a.points.end(), {static_cast<float>(i), 0, 0, 0.25f});
    a.first_point.push_back(a.first_point.back() + 6);
    a.ids.push_back(id);
  }
  const Strands strands(std::move(a));
  const SnappedStrands snapped(strands, FurGrid(0.5f));
  const FurTree tree(snapped, {});
  for (float x = 0.1f; x < 5; x += 0.3f) {
    Ray ray;
    ray.origin = {x, 0.1f, -1};
    const FurHit hit = tree.closest(ray, {});
    ASSERT_TRUE(hit);
    EXPECT_EQ(snapped.locate(hit.number).strand, 1u);
  }
}

}  // namespace
}  // namespace pelage::fur_tree_test
