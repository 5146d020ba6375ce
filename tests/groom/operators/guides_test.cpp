// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/guides.h"

#include <filesystem>

#include "geom/curve.h"
#include "geom/io/strand_file.h"
#include "groom/operators/guide_set.h"
#include "tests/groom/cached_coats.h"

namespace pelage {
namespace {

class GuidesTest : public CachedCoatTest {
 protected:
  /// Writes a guide on every `step`-th follicle, and copies of all of them: straight from the root to
  /// root + tip(root, normal). `place` moves the points of each copy.
  template <class Tip, class Place>
  void write_guides(size_t step, const Tip& tip, int copies, const Place& place) {
    StrandArrays arrays;
    arrays.first_point.push_back(0);
    for (int copy = 0; copy < copies; ++copy) {
      for (size_t f = 0; f < follicles_.size(); f += step) {
        const RootAddress& address = follicles_.root(f);
        const V3f root = rest_->evaluate(address.face, address.u, address.v).position;
        const V3f to = tip(root, rest_->frame(address.face, address.u, address.v).normal);
        for (int p = 0; p < 5; ++p) {
          const V3f point = place(root + to * (static_cast<float>(p) / 4), copy);
          arrays.points.insert(arrays.points.end(), {point.x, point.y, point.z, 0.01f});
        }
        arrays.first_point.push_back(static_cast<uint32_t>(arrays.points.size() / 4));
        arrays.ids.push_back(arrays.ids.size());
      }
    }
    write_strands(file_, Strands(std::move(arrays)));
  }
  /// Guides along the normals, of the length that `length(root)` gives.
  template <class Length>
  void write_guides(size_t step, const Length& length) {
    const auto tip = [&](const V3f& root, const V3f& normal) { return normal * length(root); };
    write_guides(step, tip, 1, [](const V3f& point, int) { return point; });
  }
  /// Random strands lie along x; with the operator, they must be as `length` says.
  template <class Length>
  void expect_lengths(const Length& length, float tolerance) {
    auto batch = straight();
    for (size_t s = 0; s < batch->count; ++s) {
      for (int p = 1; p < 8; ++p) batch->set_offset(p, s, V3f(0.1f * batch->along(p), 0, 0));
    }
    prepared<Guides>(params()).apply(*batch);
    for (size_t s = 0; s < batch->count; ++s) {
      EXPECT_NEAR(length_of(*batch, s), length(vector_at(batch->rest.position, s)), tolerance);
      EXPECT_GT(batch->offset(7, s).normalized().dot(vector_at(batch->rest.normal, s)), 0.999f);
    }
  }

  GuidesParams params() const {
    GuidesParams p;
    p.file = {file_, {}};
    return p;
  }

  std::filesystem::path file_ = folder_.path() / "guides.hair";
  std::vector<V3f> roots_;
};

TEST_F(GuidesTest, StrandsTakeShapeAndLengthOfNearbyGuides) {
  const auto length = [](const V3f& root) { return 1.0f + 0.5f * root.y; };
  write_guides(3, length);  // about 0.13 apart
  expect_lengths(length, 0.08f);
}

TEST_F(GuidesTest, CopiesOfGuidesChangeNothing) {
  const auto tip = [](const V3f& root, const V3f& normal) { return normal * (1 + 0.5f * root.y); };
  for (const float apart : {0.0f, 1e-6f, 0.005f}) {
    write_guides(3, tip, 3, [&](const V3f& point, int copy) {
      return point + V3f(apart * static_cast<float>(copy), -apart * static_cast<float>(copy), 0);
    });
    SCOPED_TRACE(apart);
    expect_lengths([](const V3f& root) { return 1 + 0.5f * root.y; }, 0.12f);
  }
  // A single guide, exported twice, shapes all strands.
  write_guides(
      follicles_.size(), [](const V3f&, const V3f& normal) { return normal * 2.0f; }, 2,
      [](const V3f& point, int copy) { return point + V3f(1e-6f * static_cast<float>(copy), 0, 0); });
  const GuidesParams near_by = params();
  EXPECT_EQ(GuideSet({near_by.file, {}, 1, V3f(0)}, context()).size(), 1u);
  EXPECT_EQ(GuideSet({near_by.file, {}, 1, V3f(0)}, context()).spacing(), 0);
}

TEST_F(GuidesTest, GuidesOnTheOtherSideOfASheetAreFar) {
  ControlMesh sheet = shapes::ball_cage();
  for (V3f& position : sheet.positions) position.z *= 0.01f;
  rest_ = shapes::surface_of(sheet);
  FollicleOptions options;
  options.count = 300;
  follicles_ = FollicleTree::build(*rest_, options, job_);
  const auto up = [](const V3f&, const V3f& normal) { return normal * 0.5f; };
  write_guides(3, up, 2,
               [](const V3f& point, int copy) { return copy ? V3f(point.x, point.y, -point.z) : point; });
  EXPECT_GT(GuideSet({params().file, {}, 1, V3f(0)}, context()).spacing(), 0.03f);
}

TEST_F(GuidesTest, GuidesCombedApartPartTheHair) {
  for (const float lean : {0.8f, 1.5f}) {  // 39 and 56 degrees to either side
    const auto tip = [&](const V3f& root, const V3f& normal) {
      const V3f side(root.x > 0 ? lean : -lean, 0, 0);
      return (normal + side - normal * normal.dot(side)) * 0.4f;
    };
    write_guides(5, tip, 1, [](const V3f& point, int) { return point; });
    const Guides op = prepared<Guides>(params());
    int at_parting = 0;
    for (size_t first = 0; first < follicles_.size(); first += kBlockStrands) {
      auto batch = straight(first);
      op.apply(*batch);
      for (size_t s = 0; s < batch->count; ++s) {
        const V3f root = vector_at(batch->rest.position, s), normal = vector_at(batch->rest.normal, s);
        if (normal.z < 0.9f) continue;
        const V3f offset = batch->offset(7, s);
        const float sideways = offset.x - normal.x * normal.dot(offset);
        EXPECT_GT(std::abs(sideways), 0.3f * lean) << "upright at x = " << root.x;
        if (std::abs(root.x) > 0.3f) {
          EXPECT_GT(sideways * root.x, 0);
        }
        at_parting += std::abs(root.x) < 0.05f;
      }
    }
    EXPECT_GT(at_parting, 10);
  }
}

TEST_F(GuidesTest, OneWarningSaysHowManyStrandsFindNoGuide) {
  write_guides(3, [](const V3f& root) { return root.x > 0 ? 0.5f : 0.0f; });  // the others are dropped
  const std::string line = "- guides: {file: " + file_.string() + ", radius: 0.2";
  make(Coat{line + "}\n", "", 1000});
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_NE(warnings_[0].find("of 1000 strands of groom 'coat' have no guide within `radius`"),
            std::string::npos)
      << warnings_[0];
  const int missed = std::stoi(warnings_[0].substr(warnings_[0].find(": ") + 2));
  EXPECT_NEAR(missed, 400, 60);  // half of them, less a strip as wide as the radius
  warnings_.clear();
  make(Coat{line + ", mask: {ramp: {along: x, knots: [[0, 0], [0, 1]]}}}\n", "", 1000});
  make(Coat{line + ", growth_radius: 0.1}\n", "", 1000});
  EXPECT_TRUE(warnings_.empty()) << warnings_[0];
}

TEST_F(GuidesTest, MirroredGuidesShapeTheOtherSide) {
  // Guides on the right half only, leaning up and outwards.
  const auto tip = [](const V3f& root, const V3f& normal) {
    return root.x > 0.05f ? (normal + V3f(0.4f, 0.4f, 0)) * 0.3f : V3f(0);
  };
  write_guides(3, tip, 1, [](const V3f& point, int) { return point; });
  GuidesParams mirrored = params();
  mirrored.mirror = V3f(-2, 0, 0);
  mirrored.radius = 0.3f;
  const Guides op = prepared<Guides>(mirrored);
  size_t left = 0;
  for (size_t first = 0; first < follicles_.size(); first += kBlockStrands) {
    auto batch = straight(first);
    op.apply(*batch);
    for (size_t s = 0; s < batch->count; ++s) {
      const V3f root = vector_at(batch->rest.position, s);
      if (root.x > -0.3f) continue;
      const V3f want = (vector_at(batch->rest.normal, s) + V3f(-0.4f, 0.4f, 0)).normalized();
      EXPECT_GT(batch->offset(7, s).normalized().dot(want), 0.95f) << root;
      ++left;
    }
  }
  EXPECT_GT(left, 200u);
  mirrored.mirror = V3f(0);
  EXPECT_THROW(prepared<Guides>(mirrored), Error);
}

TEST_F(GuidesTest, Bounds) {
  write_guides(9, [](const V3f&) { return 1.2f; });
  check_bounds(prepared<Guides>(params()), {1, 1, 0});
  GuidesParams half = params();
  half.amount = Field(0.5f);
  check_bounds(prepared<Guides>(half), {1, 1, 0});
}

TEST_F(GuidesTest, CopiesCountOnceButOtherGuidesAtTheSamePlaceCount) {
  const auto up = [](const V3f&, const V3f& normal) { return normal * 0.5f; };
  write_guides(9, up, 3, [](const V3f& point, int copy) {
    return point + V3f(0.002f * static_cast<float>(copy), 0, 0);
  });
  const size_t places = (follicles_.size() + 8) / 9;
  EXPECT_EQ(GuideSet({params().file, {}, 1, V3f(0)}, context()).size(), places);
  // Twice as long: another guide.
  write_guides(9, up, 2, [](const V3f& point, int copy) {
    return point + point.normalized() * (copy * std::max(0.0f, point.length() - 1.02f));
  });
  EXPECT_GT(GuideSet({params().file, {}, 1, V3f(0)}, context()).size(), places + 20);
}

TEST_F(GuidesTest, SpreadKeepsFolliclesNearGuides) {
  // Guides on one side of the ball only.
  write_guides(
      3, [](const V3f& root) { return root.x > 0.4f ? 1.0f : 0.0f; });  // the others are dropped: no extent
  GuidesParams near = params();
  near.spread = 0.1f;
  const Guides op = prepared<Guides>(near);
  EXPECT_TRUE(op.traits().restricts_coverage);
  FollicleOptions options;
  options.count = 1000;
  options.coverage = [&op](const FieldPoint& root) { return op.coverage(root); };
  const FollicleTree tree = FollicleTree::build(*rest_, options, job_);
  ASSERT_EQ(tree.size(), 1000u);
  for (size_t f = 0; f < tree.size(); ++f) {
    const RootAddress& root = tree.root(f);
    EXPECT_GT(rest_->evaluate(root.face, root.u, root.v).position.x, 0.4f - 0.1f);
  }
}

TEST_F(GuidesTest, MissingFilesAndEmptyOnesAreErrors) {
  Guides missing(params());
  EXPECT_THROW(missing.prepare(context()), Error);
}

TEST(Resample, TheSplineRunsAlongTheStrand) {
  // A quarter of a circle in 16 points, brought to 9.
  StrandArrays arrays;
  arrays.basis = CurveBasis::kCatmullRom;
  for (int p = 0; p < 16; ++p) {
    const float angle = static_cast<float>(p) / 15 * std::numbers::pi_v<float> / 2;
    arrays.points.insert(arrays.points.end(), {std::cos(angle), std::sin(angle), 0, 0.01f});
  }
  arrays.first_point = {0, 16};
  arrays.ids = {0};
  const Strands circle(std::move(arrays));
  const std::vector<V3f> points = resample_strand(circle, 0, 9);
  ASSERT_EQ(points.size(), 9u);
  StrandArrays fine;
  for (const V3f& p : points) fine.points.insert(fine.points.end(), {p.x, p.y, p.z, 0.01f});
  fine.first_point = {0, 9};
  fine.ids = {0};
  const Strands spline(std::move(fine));
  for (uint32_t segment = 0; segment < 8; ++segment) {
    for (int i = 0; i <= 8; ++i) {
      const V3f at = curve_position(bezier_segment(spline, 0, segment), static_cast<float>(i) / 8);
      EXPECT_NEAR(at.length(), 1, 4e-3f);
    }
  }
  EXPECT_LT((points.front() - V3f(1, 0, 0)).length(), 1e-5f);
  EXPECT_LT((points.back() - V3f(0, 1, 0)).length(), 1e-5f);
}

}  // namespace
}  // namespace pelage
