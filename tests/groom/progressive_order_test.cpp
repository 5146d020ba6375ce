// SPDX-License-Identifier: Apache-2.0
#include "groom/progressive_order.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "groom/follicles.h"
#include "groom/waiting_candidates.h"
#include "tests/groom/scene_text.h"
#include "tests/groom/shapes.h"
#include "tests/support/quiet_job.h"

namespace pelage {
namespace {

/// Candidates of a coat and its order.
class Coat {
 public:
  Coat(const ControlMesh& cage, const char* density, size_t count)
      : rest_(shapes::surface_of(cage)),
        density_{scene_text::read<Field>(density), {}},
        count_(count),
        source_(*rest_, density_, 7, count * kCandidatesPerFollicle, job_) {}

  std::optional<std::vector<uint32_t>> order(const HeldCandidates& held) {
    CandidateSupply supply(source_, held.parts, job_);
    const double mass = measure_surface(*rest_, density_, job_).mass;
    return progressive_order(supply, count_, mass, held, job_);
  }
  /// By holding all, which forgets nothing.
  std::vector<uint32_t> truth() { return *order({1, source_.make(job_).size()}); }
  const FollicleCandidates& source() const { return source_; }

 private:
  QuietJob job_;
  std::shared_ptr<const LimitSurface> rest_;
  FollicleDensity density_;
  size_t count_;
  FollicleCandidates source_;
};

ControlMesh flattened(float y, float z) {
  ControlMesh cage = shapes::ball_cage();
  for (V3f& p : cage.positions) p = {p.x, p.y * y, p.z * z};
  return cage;
}

TEST(ProgressiveOrder, IsThatOfAllCandidatesWhenMostAreForgotten) {
  const char* even = "1";
  const char* uneven = "{ramp: {along: y, knots: [[-1, 0.01], [1, 1]]}}";
  for (const char* density : {even, uneven}) {
    for (const ControlMesh& cage : {shapes::square_cage(5), shapes::ball_cage(), flattened(1, 0.0005f)}) {
      const size_t count = 8000;
      Coat coat(cage, density, count);
      const std::vector<uint32_t> truth = coat.truth();
      ASSERT_EQ(truth.size(), count);
      for (const HeldCandidates held : {HeldCandidates{16, 2 * count}, {5, 3 * count}, {40, 2 * count}}) {
        const auto order = coat.order(held);
        ASSERT_TRUE(order.has_value()) << held.parts;
        EXPECT_EQ(*order, truth) << held.parts;
      }
    }
  }
}

TEST(ProgressiveOrder, HasNoResultRatherThanAnother) {
  const size_t count = 4000;
  Coat coat(shapes::ball_cage(), "1", count);
  const std::vector<uint32_t> truth = coat.truth();
  int none = 0;
  for (size_t max = count / 8; max <= 3 * count; max += count / 4) {
    const auto order = coat.order({16, max});
    none += !order;
    if (order) {
      EXPECT_EQ(*order, truth) << max;
    }
  }
  EXPECT_GT(none, 2);
  EXPECT_LT(none, 11);
}

TEST(ProgressiveOrder, OfANarrowSkinIsFoundWithoutForgetting) {
  // Follicles on a line shun each other at 1 / their number.
  const int64_t count = 30'000;
  const ControlMesh line = flattened(1e-5f, 1e-5f);
  Coat coat(line, "1", static_cast<size_t>(count));
  EXPECT_FALSE(coat.order(HeldCandidates::of(coat.source().wanted(), static_cast<size_t>(count))));
  FollicleOptions options;
  options.count = count;
  EXPECT_EQ(FollicleTree::build(*shapes::surface_of(line), options, QuietJob(2)).size(),
            static_cast<size_t>(count));
}

TEST(ProgressiveOrder, IsNotLongerThanTheCandidates) {
  Coat coat(shapes::square_cage(2), "1", 50);
  const size_t candidates = coat.source().make(QuietJob(1)).size();
  QuietJob job(1);
  CandidateSupply supply(coat.source(), 3, job);
  std::vector<uint32_t> order =
      *progressive_order(supply, 10 * candidates, 1, HeldCandidates{3, candidates}, job);
  EXPECT_EQ(order.size(), candidates);
  std::sort(order.begin(), order.end());
  EXPECT_EQ(std::unique(order.begin(), order.end()), order.end());
}

TEST(CandidateSupply, PartsAreTheWhole) {
  Coat coat(shapes::ball_cage(), "{ramp: {along: x, knots: [[-1, 0], [1, 1]]}}", 1000);
  QuietJob job(2);
  std::vector<FollicleCandidate> whole = coat.source().make(job);
  for (const size_t parts : {1, 2, 7}) {
    CandidateSupply supply(coat.source(), parts, job);
    const CandidateSurvey survey = supply.survey();
    EXPECT_EQ(survey.count, whole.size());
    size_t rank = 0;
    while (!supply.ended()) {
      for (const FollicleCandidate& candidate : supply.next(job)) {
        ASSERT_EQ(candidate.number, rank);
        ASSERT_EQ(candidate.attempt, whole[rank].attempt);
        ASSERT_EQ(candidate.x, whole[rank].x);
        EXPECT_TRUE(survey.box.intersects(V3f(candidate.x, candidate.y, candidate.z)));
        EXPECT_LE(survey.smallest_spacing, candidate.spacing);
        ++rank;
      }
    }
    EXPECT_EQ(rank, whole.size());
  }
}

TEST(WaitingCandidates, ForgetsTheFurthestLevelsFirst) {
  WaitingCandidates waiting(10, 4);
  for (uint32_t number = 0; number < 4; ++number) {
    FollicleCandidate candidate;
    candidate.number = number;
    waiting.wait_for(number == 0 ? 3 : 7, waiting.add(candidate));
  }
  EXPECT_EQ(waiting.dropped(), 10);
  const uint32_t place = waiting.add({});
  EXPECT_EQ(waiting.dropped(), 7);
  EXPECT_EQ(waiting.held(), 2u);
  EXPECT_EQ(waiting.size(7), 0u);
  std::vector<uint32_t> numbers;
  waiting.take(3, [&](uint32_t at) { numbers.push_back(waiting[at].number); });
  EXPECT_EQ(numbers, std::vector<uint32_t>{0});
  // What waits for nothing is not forgotten.
  waiting.add({});
  waiting.add({});
  EXPECT_EQ(waiting.add({}), WaitingCandidates::kNone);
  waiting.remove(place);
  EXPECT_NE(waiting.add({}), WaitingCandidates::kNone);
}

}  // namespace
}  // namespace pelage
