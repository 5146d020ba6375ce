// SPDX-License-Identifier: Apache-2.0
#include "groom/follicles/block_order.h"

#include <algorithm>
#include <array>
#include <functional>
#include <span>
#include <utility>

#include "base/job.h"
#include "base/stoppable_sort.h"
#include "groom/follicles/candidate_blocks.h"
#include "groom/follicles/dart_radii.h"
#include "groom/follicles/keyed_sort.h"

namespace pelage {
namespace {

constexpr size_t kBlock = CandidateBlocks::kBlock;
constexpr int16_t kDone = 0x7fff;  // level of a candidate that is a follicle

// Follicles that are too far away are removed from lists at every fourth level.
constexpr int kTidy = 4;

/// Max number of entries in the lists of all blocks.
size_t max_listed(size_t candidates, size_t count) { return 6 * count + candidates / kBlock * 32 + 4096; }

/// Max number of candidates that pass the test against earlier follicles at one level.
size_t max_passing(size_t candidates, size_t count) { return std::min(candidates, count / 4 + 1024); }

/// Moves neighbours in space next to each other.
void sort_in_space(std::vector<FollicleCandidate>& candidates, const CandidateSurvey& survey,
                   const Job& job) {
  const DartRegions regions = DartRegions::finest(survey);
  std::vector<SortItem> order(candidates.size());
  job.for_each(order.size(), 16384, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end; ++i) {
      order[i] = {regions(candidates[i]), static_cast<uint32_t>(i)};
    }
  });
  sort_by_key(order, 30, job);
  arrange(candidates, order);
}

/// One run of block_order().
class BlockDarts {
 public:
  BlockDarts(std::vector<FollicleCandidate> candidates, const CandidateSurvey& survey, size_t count,
             double area, const Job& job)
      : job_(job),
        survey_(survey),
        radii_(area),
        count_(std::min(count, candidates.size())),
        candidates_(std::move(candidates)),
        next_(candidates_.size()),
        blocks_(candidates_, with_overshoot(count_), max_listed(candidates_.size(), count_)),
        next_of_block_(blocks_.size()),
        workers_(static_cast<size_t>(job.workers.thread_count())) {
    order_.reserve(with_overshoot(count_));
    set_joining_levels();
  }

  /// False if there is no room for the lists, or for the candidates that pass at one level.
  bool run();
  std::vector<uint32_t> order() && { return std::move(order_); }

 private:
  /// A candidate that passed the test against follicles of earlier levels.
  struct Passed {
    uint32_t region, rank, place;
    bool operator<(const Passed& other) const {
      return region != other.region ? region < other.region : rank < other.rank;
    }
  };
  /// What one thread uses while it tests blocks.
  struct Worker {
    NearFollicles near;
    std::vector<Passed> passed;
  };

  void set_joining_levels();
  bool throw_at(int level);
  void test_block(size_t block, int level, const DartRegions& regions, Worker& worker);
  bool accept(int level);
  int16_t later_level(int level, float distance) const {
    return static_cast<int16_t>(std::max(radii_.level_of(distance), level + 1));
  }
  void wait(size_t place, int16_t level) {
    next_[place] = level;
    int16_t& first = next_of_block_[place / kBlock];
    first = std::min(first, level);
  }

  const Job& job_;
  const CandidateSurvey survey_;
  const DartRadii radii_;
  const size_t count_;
  const std::vector<FollicleCandidate> candidates_;
  std::vector<int16_t> next_;  // level at which each candidate is tried next
  CandidateBlocks blocks_;
  std::vector<int16_t> next_of_block_;  // the first of these levels
  std::vector<Worker> workers_;
  std::vector<Passed> passed_;
  std::vector<AcceptedDart> accepted_;
  std::vector<uint32_t> order_;
};

/// At first, a candidate waits for the level at which it joins.
void BlockDarts::set_joining_levels() {
  std::vector<double> joining;
  for (int level = 0; level <= DartRadii::kLevels; ++level) {
    joining.push_back(radii_.joining(radii_.at(level), survey_.count));
    if (joining.back() >= static_cast<double>(survey_.count)) break;
  }
  job_.for_each(blocks_.size(), 64, [&](WorkRange range) {
    for (size_t block = range.begin; block < range.end; ++block) {
      next_of_block_[block] = kDone;
      for (size_t i = block * kBlock; i < std::min((block + 1) * kBlock, candidates_.size()); ++i) {
        const auto rank = static_cast<double>(candidates_[i].number);
        wait(i,
             static_cast<int16_t>(std::upper_bound(joining.begin(), joining.end(), rank) - joining.begin()));
      }
    }
  });
}

bool BlockDarts::run() {
  for (int level = 0; level <= DartRadii::kLevels && order_.size() < count_; ++level) {
    if (!throw_at(level)) return false;
  }
  order_.resize(std::min(order_.size(), count_));
  return true;
}

bool BlockDarts::throw_at(int level) {
  const auto regions = DartRegions::of_level(survey_, radii_.at(level));
  job_.for_each(blocks_.size(), 32, [&](WorkRange range) {
    Worker& worker = workers_[static_cast<size_t>(range.worker)];
    for (size_t block = range.begin; block < range.end; ++block) {
      if (next_of_block_[block] <= level) test_block(block, level, regions, worker);
    }
  });
  passed_.clear();
  for (Worker& worker : workers_) {
    if (passed_.size() + worker.passed.size() > max_passing(candidates_.size(), count_)) return false;
    passed_.insert(passed_.end(), worker.passed.begin(), worker.passed.end());
    worker.passed.clear();
  }
  stoppable_sort(job_, passed_.begin(), passed_.end(), std::less<>());
  if (!accept(level)) return false;
  const size_t before = std::min(order_.size(), count_);
  append_at_random(job_, accepted_, order_);
  job_.progress.advance(static_cast<double>(std::min(order_.size(), count_) - before) /
                        static_cast<double>(count_));
  return true;
}

/// Tests the candidates of a block against follicles of earlier levels.
void BlockDarts::test_block(size_t block, int level, const DartRegions& regions, Worker& worker) {
  const auto radius = static_cast<float>(radii_.at(level));
  const size_t begin = block * kBlock, end = std::min(begin + kBlock, candidates_.size());
  std::array<uint32_t, kBlock> tried;
  const auto now = static_cast<int16_t>(level);
  size_t count = 0;
  for (size_t i = begin; i < end; ++i) {
    tried[count] = static_cast<uint32_t>(i);
    count += next_[i] == now ? 1 : 0;
  }
  int16_t first = kDone;
  for (size_t i = begin; i < end; ++i) first = std::min(first, next_[i] == now ? kDone : next_[i]);
  next_of_block_[block] = first;
  if (level % kTidy == 0) {
    blocks_.gather(block, radius, worker.near);
  } else {
    blocks_.gather_all(block, worker.near);
  }
  for (uint32_t place : std::span(tried).first(count)) {
    const FollicleCandidate& candidate = candidates_[place];
    const float distance = level < DartRadii::kLevels ? worker.near.nearest(candidate, radius) : radius;
    if (distance >= radius) {
      worker.passed.push_back({regions(candidate), candidate.number, place});
    } else {
      wait(place, later_level(level, distance));
    }
  }
}

/// Makes follicles of the candidates that passed and are not too close to those before them.
bool BlockDarts::accept(int level) {
  const auto radius = static_cast<float>(radii_.at(level));
  const uint32_t earlier = blocks_.follicle_count();
  size_t looked_at = 0;
  for (const Passed& passed : passed_) {
    if ((++looked_at & 0xfff) == 0) job_.check_stop();
    const FollicleCandidate& candidate = candidates_[passed.place];
    if (level < DartRadii::kLevels) {
      const float distance = blocks_.nearest_of_latest(passed.place / kBlock, candidate, radius, earlier);
      if (distance < radius) {
        wait(passed.place, later_level(level, distance));
        continue;
      }
      if (!blocks_.add(candidate, radius)) return false;
    }
    next_[passed.place] = kDone;
    accepted_.push_back({passed.rank, candidate.attempt});
  }
  return true;
}

}  // namespace

std::optional<std::vector<uint32_t>> block_order(std::vector<FollicleCandidate> candidates,
                                                 const CandidateSurvey& survey, size_t count, double area,
                                                 const Job& job) {
  sort_in_space(candidates, survey, job);
  BlockDarts darts(std::move(candidates), survey, count, area, job);
  if (!darts.run()) return std::nullopt;
  return std::move(darts).order();
}

size_t block_order_bytes(size_t candidates, size_t count) {
  const size_t sorting = candidates * 2 * sizeof(SortItem);
  const size_t passing = max_passing(candidates, count);
  constexpr size_t kPassedBytes = 12, kDrawnBytes = 16;
  const size_t running = (candidates + candidates / kBlock + 1) * sizeof(int16_t) +
                         CandidateBlocks::tree_bytes(candidates) +
                         CandidateBlocks::list_bytes(max_listed(candidates, count)) +
                         with_overshoot(count) * (sizeof(PlacedFollicle) + sizeof(uint32_t)) +
                         passing * (2 * kPassedBytes + kDrawnBytes + sizeof(AcceptedDart));
  return candidates * sizeof(FollicleCandidate) + std::max(sorting, running);
}

}  // namespace pelage
