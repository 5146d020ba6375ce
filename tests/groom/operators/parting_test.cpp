// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/parting.h"

#include <fstream>
#include <map>

#include "geom/io/strand_file.h"
#include "groom/cache/groom_identity.h"
#include "groom/operators/clump.h"
#include "groom/operators/comb.h"
#include "groom/operators/guides.h"
#include "groom/strands/part_lines.h"
#include "tests/groom/cached_coats.h"

namespace pelage::parting_test {
namespace {

/// Over the top of the ball, along x = 0.
const char* const kPart = "- part: {points: [[0, 0.7, -0.7], [0, 1, 0], [0, 0.7, 0.7]], width: 0.8}\n";

class PartingTest : public CachedCoatTest {
 protected:
  static PartingParams over_the_top() {
    PartingParams params;
    params.points = {{0, 0.7f, -0.7f}, {0, 1, 0}, {0, 0.7f, 0.7f}};
    params.width = 0.8f;
    return params;
  }
  /// Calls check(side of the root, side of the tip, root, tip) for all strands of a coat whose roots are near
  /// the part.
  template <class Check>
  void for_each_near_part(const std::string& operators, const Check& check) {
    const auto groom = make(Coat{operators, "", 6000, 1000});
    size_t seen = 0;
    for (const Strands& strands : all(*groom, at_rest())) {
      const std::span<const float> points = strands.points(0);
      for (size_t s = 0; s < strands.strand_count(); ++s) {
        const float* root = &points[s * 8 * 4];
        const float* tip = root + 7 * 4;
        if (root[1] < 0.6f || std::abs(root[0]) > 0.3f || std::abs(root[2]) > 0.6f) continue;
        check(V3f(root[0], root[1], root[2]), V3f(tip[0], tip[1], tip[2]));
        ++seen;
      }
    }
    EXPECT_GT(seen, 100u);
  }
};

TEST_F(PartingTest, Bounds) {
  check_bounds(prepared<Parting>(over_the_top()), {1.5f, 1.5f, 0, 1.2f});
  PartingParams half = over_the_top();
  half.amount = Field(0.5f);
  half.curve = 0.6f;
  check_bounds(prepared<Parting>(half), {1.5f, 1.5f, 0});
}

TEST_F(PartingTest, HairFallsBothWaysFromTheLineWhateverItsCombing) {
  for_each_near_part(
      std::string("- length: {value: 0.4}\n- comb: {direction: [1, 0, 0.4], lift: 0.3}\n") + kPart,
      [](const V3f& root, const V3f& tip) {
        // The line lies within 0.005 of x = 0: the skin is searched on a tessellation.
        if (std::abs(root.x) > 0.01f) {
          EXPECT_GT((tip.x - root.x) * (root.x < 0 ? -1 : 1), 0.2f) << root;
        }
      });
}

TEST_F(PartingTest, FadesBeyondItsEndsAndItsWidth) {
  PartingParams params = over_the_top();
  params.points = {{0, 1, -0.1f}, {0, 1, 0.1f}};
  params.width = 0.3f;
  const Parting op = prepared<Parting>(params);
  for (size_t first = 0; first < follicles_.size(); first += kBlockStrands) {
    auto batch = straight(first), before = straight(first);
    op.apply(*batch);
    for (size_t s = 0; s < batch->count; ++s) {
      const V3f root = vector_at(batch->rest.position, s);
      const V3f from_end(root.x, root.y - 1, std::max(std::abs(root.z) - 0.1f, 0.0f));
      const float moved = (batch->offset(7, s) - before->offset(7, s)).length();
      // The ends on the skin may be a little nearer than those in the scene.
      if (from_end.length() > 0.45f || (std::abs(root.x) < 0.002f && std::abs(root.z) > 0.15f)) {
        EXPECT_LT(moved, 0.05f) << root;
      }
      EXPECT_NEAR(length_of(*batch, s), 1, 1e-5f);
    }
  }
}

TEST_F(PartingTest, GuidesDoNotActAcrossTheLineBeforeOrAfterIt) {
  // Guides lean by 19 degrees to the side on which they stand: near enough to each other to be mixed.
  StrandArrays arrays;
  arrays.first_point.push_back(0);
  for (size_t f = 0; f < follicles_.size(); f += 3) {
    const RootAddress& address = follicles_.root(f);
    const V3f root = rest_->evaluate(address.face, address.u, address.v).position;
    const V3f normal = rest_->frame(address.face, address.u, address.v).normal;
    const V3f to = normal * 0.35f + V3f(root.x < 0 ? -0.12f : 0.12f, 0, 0);
    for (int p = 0; p < 5; ++p) {
      const V3f point = root + to * (static_cast<float>(p) / 4);
      arrays.points.insert(arrays.points.end(), {point.x, point.y, point.z, 0.01f});
    }
    arrays.first_point.push_back(static_cast<uint32_t>(arrays.points.size() / 4));
    arrays.ids.push_back(arrays.ids.size());
  }
  const auto file = folder_.path() / "guides.hair";
  write_strands(file, Strands(std::move(arrays)));
  const std::string guides = "- guides: {file: " + file.string() + "}\n";
  std::string part = kPart;
  part.insert(part.size() - 2, ", amount: 0");
  for (const std::string& operators : {part + guides, guides + part}) {
    for_each_near_part(operators, [](const V3f& root, const V3f& tip) {
      if (std::abs(root.x) > 0.02f) {
        EXPECT_GT((tip.x - root.x) * (root.x < 0 ? -1 : 1), 0.08f) << root;
      }
    });
  }
  // Without the line, they are mixed.
  size_t upright = 0;
  for_each_near_part(guides, [&](const V3f& root, const V3f& tip) {
    upright += (tip.x - root.x) * (root.x < 0 ? -1 : 1) < 0.08f;
  });
  EXPECT_GT(upright, 5u);
}

TEST_F(PartingTest, ClumpsDoNotGatherAcrossTheLine) {
  const std::string clump = "- length: {value: 0.1}\n- clump: {spacing: 0.25, amount: 1, profile: 0.3}\n";
  size_t across = 0;
  for_each_near_part(clump, [&](const V3f& root, const V3f& tip) { across += root.x * tip.x < 0; });
  EXPECT_GT(across, 10u);
  std::string part = kPart;
  part.insert(part.size() - 2, ", amount: 0");
  across = 0;
  for_each_near_part(part + clump, [&](const V3f& root, const V3f& tip) {
    across += std::abs(root.x) > 0.01f && root.x * tip.x < 0;
  });
  EXPECT_EQ(across, 0u);
}

TEST_F(PartingTest, ReadsLinesFromAFile) {
  StrandArrays arrays;
  arrays.first_point = {0, 3};
  arrays.ids = {0};
  for (const V3f& p : over_the_top().points)
    arrays.points.insert(arrays.points.end(), {p.x, p.y, p.z, 0.01f});
  const auto file = folder_.path() / "line.hair";
  write_strands(file, Strands(std::move(arrays)));
  PartingParams from_file;
  from_file.file = {file, {}};
  from_file.width = 0.8f;
  auto a = straight(), b = straight();
  prepared<Parting>(from_file).apply(*a);
  prepared<Parting>(over_the_top()).apply(*b);
  for (size_t s = 0; s < a->count; ++s) EXPECT_EQ(a->offset(7, s), b->offset(7, s));
}

TEST_F(PartingTest, RefusesLinesThatAreNone) {
  const auto message = [&](const PartingParams& params) -> std::string {
    try {
      prepared<Parting>(params);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message({}).find("needs `points` or `file`"), std::string::npos);
  PartingParams point;
  point.points = {{0, 1, 0}, {0, 1, 0}};
  EXPECT_NE(message(point).find("at least 2 different points"), std::string::npos);
}

TEST_F(PartingTest, ChangesTheIdentityOfOperatorsBeforeIt) {
  const auto clump_hash = [&](const std::string& part) {
    const GroomParams params = params_of({"- clump: {spacing: 0.2}\n" + part, ""});
    return GroomIdentity(params, 1, OperatorStack(params.operators), rest_.get()).of_operator(0).hash;
  };
  EXPECT_NE(clump_hash(kPart), clump_hash("- part: {points: [[0.1, 0.7, -0.7], [0, 1, 0]]}\n"));
  EXPECT_EQ(clump_hash(kPart), clump_hash(kPart));
}

TEST_F(PartingTest, GrowsTheSameFromACache) {
  const std::string operators =
      std::string("- length: {value: 0.4}\n- clump: {spacing: 0.2}\n") + kPart + "- width: {root: 0.01}\n";
  const std::vector<float> first = bits(*make(Coat{operators, "clump"}), at_rest());
  EXPECT_EQ(bits(*make(Coat{operators, "clump"}), at_rest()), first);
}

/// With the other operators that gather strands or look for something near them.
TEST_F(PartingTest, StrandsAreTheSameInAnyLeavesAndStayWithinTheirBounds) {
  const auto obstacle = folder_.path() / "obstacle.obj";
  std::ofstream(obstacle)
      << "v 0 2 0\nv -1 1.2 -1\nv 1 1.2 -1\nv 0 1.2 1\nf 1 3 2\nf 1 4 3\nf 1 2 4\nf 2 3 4\n";
  const std::string operators =
      "- length: {value: 0.3, add: {ramp: {along: y, knots: [[-1, 0], [1, 0.3]]}}}\n" + std::string(kPart) +
      "- swirl: {center: [1, 0, 0], radius: 0.8}\n- wet: {spacing: 0.3, amount: 0.6}\n"
      "- braid: {spacing: 0.4, radius: 0.03, pitch: 0.3, mask: {ramp: {along: y, knots: [[0, 0], [0.2, "
      "1]]}}}\n"
      "- avoid: {mesh: " +
      obstacle.string() + "}\n- width: {root: 0.01}\n";
  std::map<uint64_t, std::vector<float>> first;
  for (const int leaf_strands : {1500, 130}) {
    const auto groom = make(Coat{operators, "", 1500, leaf_strands}, leaf_strands == 130 ? 1 : 3);
    for (size_t leaf = 0; leaf < groom->follicles().leaves().size(); ++leaf) {
      const Strands strands = groom->grow(leaf, at_rest());
      const Box3f box = groom->conservative_bound(leaf, at_rest());
      const std::span<const float> points = strands.points(0);
      for (size_t s = 0; s < strands.strand_count(); ++s) {
        const std::vector<float> own(points.begin() + static_cast<std::ptrdiff_t>(s * 32),
                                     points.begin() + static_cast<std::ptrdiff_t>(s * 32 + 32));
        for (size_t p = 0; p < 8; ++p)
          EXPECT_TRUE(box.intersects(V3f(own[4 * p], own[4 * p + 1], own[4 * p + 2])));
        EXPECT_EQ(first.try_emplace(strands.id(s), own).first->second, own);
      }
      const uint32_t some[] = {0, 3, 17};
      const float width[] = {1, 1, 1};
      const KeptStrands kept{some, width, {}};
      const Strands few = groom->grow(leaf, at_rest(), &kept);
      for (size_t i = 0; i < 3; ++i) EXPECT_EQ(few.points(0)[i * 32 + 28], points[some[i] * size_t(32) + 28]);
    }
  }
  EXPECT_EQ(first.size(), 1500u);
}

TEST_F(PartingTest, IgnoresLinesOnTheOtherSideOfASheet) {
  PartLines::Nearest line;
  const Parting op = prepared<Parting>(over_the_top());
  EXPECT_TRUE(op.part()->nearest({0.1f, 1, 0}, {0, 1, 0}, 0.5f, line));
  EXPECT_GT(line.away.x, 0.9f);
  EXPECT_FALSE(op.part()->nearest({0.1f, 1, 0}, {0, -1, 0}, 0.5f, line));
  EXPECT_TRUE(op.part()->divides({0.1f, 1, 0}, {0, 1, 0}, {-0.1f, 1, 0}));
  EXPECT_FALSE(op.part()->divides({0.1f, 1, 0}, {0, -1, 0}, {-0.1f, 1, 0}));
  EXPECT_FALSE(op.part()->divides({0.1f, 1, 0}, {0, 1, 0}, {0.3f, 1, 0}));
}

}  // namespace
}  // namespace pelage::parting_test
