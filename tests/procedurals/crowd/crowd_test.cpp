// SPDX-License-Identifier: Apache-2.0
#include "procedurals/crowd/crowd.h"

#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "base/error.h"
#include "procedurals/crowd/crowd_placement.h"
#include "tests/support/allocation_meter.h"
#include "tests/support/quiet_job.h"

namespace pelage {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

PolygonAreaParams wedge() {
  PolygonAreaParams area;
  area.points = {V2f(-10, 0), V2f(10, 0), V2f(60, -100), V2f(0, -80), V2f(-60, -100)};
  area.height = 3;
  return area;
}
RectangleAreaParams turned_rectangle() {
  RectangleAreaParams area;
  area.center = V3f(5, 1, -7);
  area.size = V2f(120, 60);
  area.rotate = 30;
  return area;
}

// A body with a hooked tail.
const Footprint kRat = {V3f(0, 6, 3), V3f(0, 0, 4), V3f(0, -6, 3), V3f(4, -10, 0.5f), V3f(8, -8, 0.5f)};

class CountsStages final : public Progress {
 public:
  void begin(std::string_view, double total) override {
    ++begun_;
    total_ = total;
  }
  void advance(double amount) override { done_ += amount; }
  void end() override { ++ended_; }
  bool cancelled() const override { return false; }

  int begun_ = 0, ended_ = 0;
  double total_ = 0, done_ = 0;
};

TEST(CrowdProgress, IsShownOfManyAnimals) {
  const Workers workers(1);
  RectangleAreaParams wide;
  wide.size = V2f(2000, 2000);
  for (const size_t count : {100, 20'000}) {
    CrowdRules rules;
    rules.footprints.assign(count, {V3f(0, 0, 1)});
    MemoryLedger ledger;
    CountsStages progress;
    place_crowd(GroundArea(wide), rules, Job{workers, ledger, progress});
    EXPECT_EQ(progress.begun_, count > 1000 ? 1 : 0);
    EXPECT_EQ(progress.ended_, progress.begun_);
    EXPECT_EQ(progress.done_ > 0, count > 1000);
    EXPECT_LE(progress.done_, progress.total_);
  }
}

TEST(CrowdProgress, IsShownOfFewAnimalsThatArePushedAboutForLong) {
  const Workers workers(1);
  RectangleAreaParams narrow;
  CrowdRules rules;
  rules.footprints.assign(6000, {V3f(0, 0, 1)});
  narrow.size = V2f(std::sqrt(6000 * kPi / 0.72f));
  MemoryLedger ledger;
  CountsStages progress;
  place_crowd(GroundArea(narrow), rules, Job{workers, ledger, progress});
  EXPECT_EQ(progress.begun_, 1);
  EXPECT_EQ(progress.ended_, 1);
  EXPECT_GT(progress.done_, 60);  // sweeps, those before it was shown too
  EXPECT_LE(progress.done_, progress.total_);
}

class CrowdPlacementTest : public testing::TestWithParam<AreaParams> {
 protected:
  static CrowdRules rules(size_t count, const Footprint& footprint, float spacing, float variation = kPi) {
    CrowdRules result;
    result.footprints.assign(count, footprint);
    result.spacing = spacing;
    result.heading = 1;
    result.heading_variation = variation;
    result.seed = 11;
    return result;
  }
  static void expect_kept(const GroundArea& area, const CrowdRules& rules,
                          const std::vector<CrowdPlace>& places) {
    ASSERT_EQ(places.size(), rules.footprints.size());
    for (size_t i = 0; i < places.size(); ++i) {
      EXPECT_LT((area.nearest(places[i].position) - places[i].position).length(), 1e-3f);
      if (rules.heading_variation < kPi) {
        EXPECT_LE(std::abs(places[i].heading - rules.heading), rules.heading_variation + 1e-5f);
      }
      for (size_t j = 0; j < i; ++j) {
        EXPECT_GE(footprint_distance(rules.footprints[i], places[i], rules.footprints[j], places[j]),
                  rules.spacing - 1e-4f)
            << i << " and " << j;
      }
    }
  }
};

TEST_P(CrowdPlacementTest, PointsKeepTheirDistance) {
  const GroundArea area(GetParam());
  // Half of what a perfect packing would hold.
  const auto count = static_cast<size_t>(0.5 * area.surface() / (0.866 * 4 * 4));
  const CrowdRules kept = rules(count, {}, 4);
  expect_kept(area, kept, place_crowd(area, kept, QuietJob(1)));
}

TEST_P(CrowdPlacementTest, FootprintsKeepTheirDistance) {
  const GroundArea area(GetParam());
  const auto count = static_cast<size_t>(area.surface() / 260);
  for (float variation : {kPi, 0.3f, 0.0f}) {
    const CrowdRules kept = rules(count, kRat, 0.5f, variation);
    expect_kept(area, kept, place_crowd(area, kept, QuietJob(1)));
  }
}

TEST_P(CrowdPlacementTest, IsAFunctionOfItsSeed) {
  const GroundArea area(GetParam());
  CrowdRules once = rules(12, kRat, 1);
  const auto places = place_crowd(area, once, QuietJob(1)), again = place_crowd(area, once, QuietJob(1));
  once.seed = 12;
  const auto other = place_crowd(area, once, QuietJob(1));
  for (size_t i = 0; i < places.size(); ++i) {
    EXPECT_EQ(places[i].position, again[i].position);
    EXPECT_EQ(places[i].heading, again[i].heading);
    EXPECT_NE(places[i].position, other[i].position);
  }
}

TEST_P(CrowdPlacementTest, WithoutSpacingTheyAreSpreadEvenly) {
  const GroundArea area(GetParam());
  const auto places = place_crowd(area, rules(400, {}, 0), QuietJob(1));
  // Of random points, a tenth would have a neighbour closer than 0.18 of the mean distance.
  const float mean = std::sqrt(static_cast<float>(area.surface() / 400));
  int close = 0;
  for (size_t i = 0; i < places.size(); ++i) {
    float nearest = 1e9f;
    for (size_t j = 0; j < places.size(); ++j) {
      if (j != i) nearest = std::min(nearest, (places[j].position - places[i].position).length());
    }
    close += nearest < 0.18f * mean;
  }
  EXPECT_LT(close, 20);
}

TEST_P(CrowdPlacementTest, KeepsClearOfWhatStandsThere) {
  const GroundArea area(GetParam());
  CrowdRules first = rules(4, kRat, 1), second = rules(static_cast<size_t>(area.surface() / 400), kRat, 1);
  const auto standing = place_crowd(area, first, QuietJob(1));
  for (const CrowdPlace& place : standing) second.obstacles.push_back({kRat, place});
  const auto places = place_crowd(area, second, QuietJob(1));
  expect_kept(area, second, places);
  for (const PlacedFootprint& obstacle : second.obstacles) {
    for (const CrowdPlace& place : places)
      EXPECT_GE(footprint_distance(kRat, obstacle.place, kRat, place), 1 - 1e-4f);
  }
}

INSTANTIATE_TEST_SUITE_P(Areas, CrowdPlacementTest,
                         testing::Values(AreaParams(RectangleAreaParams{}), AreaParams(turned_rectangle()),
                                         AreaParams(DiscAreaParams{}), AreaParams(wedge())));

TEST(CrowdPlacement, RefusesMoreThanFit) {
  const GroundArea area{AreaParams(DiscAreaParams{})};
  CrowdRules rules;
  rules.spacing = 10;
  const auto problem = [&](size_t count) -> std::string {
    rules.footprints.assign(count, {});
    try {
      place_crowd(area, rules, QuietJob(1));
      return "";
    } catch (const Error& error) {
      return error.what();
    }
  };
  EXPECT_EQ(problem(40), "");
  EXPECT_NE(problem(106).find("106 do not fit into its area: after the maximum number of steps, "),
            std::string::npos);
  EXPECT_EQ(problem(1000000), "1000000 do not fit into its area: at this spacing it holds fewer than 111");
}

TEST(GroundArea, KnowsWhatIsInside) {
  const GroundArea rectangle{AreaParams(turned_rectangle())};
  EXPECT_NEAR(rectangle.surface(), 7200, 0.1);
  EXPECT_NEAR(rectangle.border(), 360, 0.01);
  EXPECT_EQ(rectangle.height(), 1);
  // Turned as a character of the same heading is: its x axis points to (cos, -sin).
  EXPECT_TRUE(rectangle.contains(V2f(5 + 59 * 0.866f, -7 - 59 * 0.5f)));
  EXPECT_FALSE(rectangle.contains(V2f(5 + 59 * 0.866f, -7 + 59 * 0.5f)));
  const GroundArea hollow{AreaParams(wedge())};
  EXPECT_FALSE(hollow.contains(V2f(0, -90)));
  EXPECT_TRUE(hollow.contains(V2f(0, -70)));
  EXPECT_TRUE(hollow.contains(V2f(-50, -93)));
  const V2f near = hollow.nearest(V2f(0, -90));
  EXPECT_LT(near.y, -79);
  EXPECT_EQ(GroundArea{AreaParams(DiscAreaParams{})}.nearest(V2f(0, 70)), V2f(0, 50));
}

CrowdParams colony() {
  CrowdParams params;
  params.of = {{"rat", {}}, {"mouse", {}}};
  params.count = 200;
  params.area = wedge();
  params.spacing = 1;
  params.phase = {3, 6};
  params.scale.value = 2;
  params.scale.variation = 0.1f;
  params.scale.axes = V3f(0.05f, 0, 0.02f);
  params.length.variation = 0.2f;
  params.color.variation = 0.3f;
  params.color.hue = 0.1f;
  return params;
}

TEST(Crowd, EveryAnimalIsItsOwnWithinWhatIsAllowed) {
  const auto members = make_crowd("colony", {}, colony(), {{}, {}}, QuietJob(1));
  ASSERT_EQ(members.size(), 200u);
  std::set<float> phases, widths, lengths, reds;
  size_t of[2] = {};
  for (const CrowdMember& member : members) {
    EXPECT_EQ(member.position.y, 3);
    EXPECT_GE(member.frame_offset, -3);
    EXPECT_LE(member.frame_offset, 9);
    EXPECT_GE(member.scale.y, 1.8f);
    EXPECT_LE(member.scale.y, 2.2f);
    EXPECT_LE(std::abs(member.scale.x / member.scale.y - 1), 0.0501f);
    EXPECT_LE(std::abs(member.scale.z / member.scale.y - 1), 0.0201f);
    EXPECT_LE(std::abs(member.length - 1), 0.2f);
    EXPECT_LE(std::abs(member.tint.x / member.tint.y - 1), 0.23f);
    EXPECT_LE(member.tint.x, 1.43f);
    EXPECT_GE(member.tint.x, 0.63f);
    phases.insert(member.frame_offset);
    widths.insert(member.scale.x);
    lengths.insert(member.length);
    reds.insert(member.tint.x);
    ++of[member.prototype];
  }
  for (const auto& values : {phases, widths, lengths, reds}) EXPECT_GT(values.size(), 195u);
  EXPECT_GT(of[0], 70u);
  EXPECT_GT(of[1], 70u);
}

TEST(Crowd, TwoCrowdsOfOneSeedDiffer) {
  const auto a = make_crowd("a", {}, colony(), {{}, {}}, QuietJob(1)),
             b = make_crowd("b", {}, colony(), {{}, {}}, QuietJob(1));
  EXPECT_NE(a[0].position, b[0].position);
  EXPECT_NE(a[0].frame_offset, b[0].frame_offset);
}

TEST(Crowd, HeadingTurnsFromAheadToTheLeft) {
  CrowdMember member;
  member.position = V3f(10, 1, 20);
  member.heading = kPi / 2;
  const V3f nose = V3f(0, 2, 5) * placement_of(member);
  EXPECT_LT((nose - V3f(15, 3, 20)).length(), 1e-5f);
  member.scale = V3f(1, 2, 3);
  EXPECT_EQ(V3f(1, 1, 1) * scale_of(member), V3f(1, 2, 3));
  EXPECT_GT(placement_of(member).determinant(), 0.999f);
}

TEST(Crowd, NamesWhatDoesNotFit) {
  CrowdParams params = colony();
  params.spacing = 50;
  try {
    make_crowd("colony", {"s.yaml", 7, 3}, params, {{}, {}}, QuietJob(1));
    FAIL() << "they fitted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_EQ(std::string(error.what()).find("s.yaml:7:3: crowd 'colony': 200 do not fit into its area"), 0u);
  }
}

TEST(CrowdMemory, PlacingHoldsWhatItAsksForOrIsRefusedByName) {
  CrowdParams params = colony();
  params.count = 20000;
  params.spacing = 0;
  const std::vector<Footprint> footprints{{V3f(0, 0, 1e-5f)}, {V3f(0, 0, 1e-5f), V3f(0, 1e-5f, 1e-5f)}};
  const int64_t says = crowd_temporary_bytes(params, footprints, 0);
  const size_t before = live_bytes();
  reset_peak();
  const auto members = make_crowd("herd", {}, params, footprints, QuietJob(1));
  const auto peak = static_cast<int64_t>(peak_bytes() - before);
  EXPECT_LE(peak, says);
  EXPECT_GE(peak, says / 2);

  MemoryLedger ledger;
  ledger.set_limit(says - 1);
  try {
    make_crowd("herd", {}, params, footprints, QuietJob(1, ledger));
    ADD_FAILURE() << "placed";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kMemory);
    EXPECT_TRUE(std::string(error.what()).starts_with("placing 20000 animals of crowd 'herd' needs "))
        << error.what();
  }
}

}  // namespace
}  // namespace pelage
