// SPDX-License-Identifier: Apache-2.0
#include "groom/follicles/progressive_order.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "base/error.h"
#include "groom/follicles/follicles.h"
#include "groom/follicles/waiting_candidates.h"
#include "tests/groom/scene_text.h"
#include "tests/groom/shapes.h"
#include "tests/support/effort.h"
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
        source_(*rest_, density_, 7, count * kCandidatesPerFollicle,
                measure_surface(*rest_, density_, job_)) {}

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
  const int64_t few = 30'000, many = 345'000;
  const ControlMesh line = flattened(1e-5f, 1e-5f);
  Coat coat(line, "1", static_cast<size_t>(few));
  EXPECT_FALSE(coat.order(HeldCandidates::least(coat.source().wanted(), static_cast<size_t>(few))));
  const auto surface = shapes::surface_of(line);
  const auto placed = [&](int64_t count, int64_t limit) {
    FollicleOptions options;
    options.count = count;
    QuietJob job(2);
    job.ledger().set_limit(static_cast<uint64_t>(limit));
    return static_cast<int64_t>(FollicleTree::build(*surface, options, job).size());
  };
  EXPECT_EQ(placed(few, 0), few);  // holds all at once
  if (!kSanitized) {
    EXPECT_EQ(placed(many, 0), many);  // holds the least, and then all
  }
  try {
    placed(few, follicle_temporary_bytes(few));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kMemory);
    const std::string message = error.what();
    EXPECT_NE(message.find("placing 30000 strands of groom with all their candidates"), std::string::npos)
        << message;
    const size_t megabytes = std::stoul(message.substr(message.find("--memory ") + 9));
    EXPECT_EQ(placed(few, static_cast<int64_t>(megabytes) << 20), few);
  }
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

TEST(ProgressiveOrder, AsksForLessWhenItHoldsLess) {
  const auto bytes = [](size_t count, const HeldCandidates& held) {
    return static_cast<double>(progressive_order_bytes(count * kCandidatesPerFollicle, count, held)) /
           static_cast<double>(count);
  };
  for (const size_t count : {100'000, 340'000, 350'000}) {
    const size_t candidates = FollicleCandidates::max_of(count * kCandidatesPerFollicle);
    const HeldCandidates least = HeldCandidates::least(candidates, count),
                         fastest = HeldCandidates::fastest(candidates, count);
    EXPECT_EQ(least.parts, 16u);
    EXPECT_LT(bytes(count, least), 140);
    EXPECT_EQ(fastest.parts, count < 344'000 ? 1u : 16u);
    EXPECT_LT(bytes(count, fastest), count < 344'000 ? 280 : 140);
  }
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

TEST(WaitingCandidates, WaitTheSameOneByOneOrAllAtOnce) {
  std::vector<FollicleCandidate> candidates(20);
  for (uint32_t rank = 0; rank < candidates.size(); ++rank) {
    candidates[rank].number = rank;
    candidates[rank].attempt = 100 + rank;
  }
  WaitingCandidates one(10, 20), all(10, 20);
  for (const FollicleCandidate& candidate : candidates) one.add(candidate);
  all.hold_all(candidates);
  for (uint32_t place = 0; place < candidates.size(); ++place) {
    for (WaitingCandidates* waiting : {&one, &all}) {
      if (place % 5 == 0) {
        waiting->remove(place);
      } else {
        waiting->wait_for(static_cast<int>(place % 3) + 2, place);
      }
    }
  }
  one.drop_from(4);
  all.drop_from(4);
  EXPECT_EQ(all.dropped(), 4);
  EXPECT_EQ(all.held(), one.held());
  for (int level = 0; level < 10; ++level) {
    EXPECT_EQ(all.size(level), one.size(level));
    std::vector<std::pair<uint32_t, uint32_t>> found[2];
    one.take(level, [&](uint32_t at) { found[0].emplace_back(one.rank(at), one[at].attempt); });
    all.take(level, [&](uint32_t at) { found[1].emplace_back(all.rank(at), all[at].attempt); });
    EXPECT_EQ(found[1], found[0]);
    for (const auto& [rank, attempt] : found[1]) EXPECT_EQ(attempt, 100 + rank);
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
