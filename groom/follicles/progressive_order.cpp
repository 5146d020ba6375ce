// SPDX-License-Identifier: Apache-2.0
#include "groom/follicles/progressive_order.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

#include "base/release.h"
#include "base/stoppable_sort.h"
#include "groom/follicles/block_order.h"
#include "groom/follicles/dart_radii.h"
#include "groom/follicles/keyed_sort.h"
#include "groom/follicles/octave_grid.h"
#include "groom/follicles/waiting_candidates.h"

namespace pelage {
namespace {

constexpr int kLevels = DartRadii::kLevels;
/// Levels beyond the one that is expected to be the last.
constexpr int kSpareLevels = 1;

/// One run of progressive_order().
class DartThrowing {
 public:
  DartThrowing(CandidateSupply& supply, size_t count, double area, size_t max_waiting, const Job& job)
      : supply_(supply),
        job_(job),
        radii_(area),
        count_(std::min(count, supply.survey().count)),
        grid_(supply.survey().smallest_spacing, with_overshoot(count_)),
        waiting_(kLevels + 1, max_waiting) {
    if (max_waiting < supply.survey().count) last_ = radii_.last_level(count_);
    order_.reserve(with_overshoot(count_));
  }

  /// False if it needs candidates that were dropped because they did not fit.
  bool run();
  std::vector<uint32_t> order() && { return std::move(order_); }

 private:
  struct Tried {
    uint32_t region, rank, place;  // `place` is in waiting_, or in the part of a candidate that arrives
    float distance = 0;            // to the nearest follicle of earlier levels, at most the radius
    bool operator<(const Tried& other) const {
      return region != other.region ? region < other.region : rank < other.rank;
    }
  };

  bool throw_at(int level);
  bool arrive(const DartRegions& regions);
  void hold_all(std::vector<FollicleCandidate> candidates);
  bool collect(int level, double radius);
  void make_room_to_try(size_t count);
  void measure_distances(int level, float radius);
  void accept_or_file(int level, float radius);
  void forget_the_hopeless(int level);

  CandidateSupply& supply_;
  const Job& job_;
  const DartRadii radii_;
  const size_t count_;
  int last_ = kLevels;  // candidates that wait for later levels are dropped
  double grid_radius_ = std::numeric_limits<double>::infinity();
  OctaveGrid grid_;
  WaitingCandidates waiting_;
  std::vector<uint32_t> arrived_;  // places of candidates that have not been tried yet, by rank
  size_t joined_ = 0;              // number of entries of arrived_ that have been tried
  std::vector<Tried> tried_;
  std::vector<AcceptedDart> accepted_;
  std::vector<uint32_t> order_;
};

bool DartThrowing::run() {
  for (int level = 0; level <= kLevels && order_.size() < count_; ++level) {
    if (level > last_ || level >= waiting_.dropped() || !throw_at(level)) return false;
  }
  order_.resize(std::min(order_.size(), count_));
  return true;
}

bool DartThrowing::throw_at(int level) {
  const double radius = radii_.at(level);
  if (radius < 0.6 * grid_radius_ && level < kLevels) {
    grid_radius_ = radius;
    const double ahead = std::min(radii_.expected(0.6 * radius), static_cast<double>(count_));
    grid_.rebuild(static_cast<size_t>(ahead), static_cast<float>(radius));
  }
  if (!collect(level, radius)) return false;
  measure_distances(level, static_cast<float>(radius));
  accept_or_file(level, static_cast<float>(radius));
  const size_t before = order_.size();
  append_at_random(job_, accepted_, order_);
  if (last_ < kLevels) forget_the_hopeless(level);
  job_.progress.advance(static_cast<double>(std::min(order_.size(), count_) - std::min(before, count_)) /
                        static_cast<double>(count_));
  return true;
}

/// Collects the candidates to try at a level, sorted so that neighbours are adjacent.
bool DartThrowing::collect(int level, double radius) {
  const CandidateSurvey& survey = supply_.survey();
  const auto regions = DartRegions::of_level(survey, radius);
  const double join = radii_.joining(radius, survey.count);
  while (static_cast<double>(supply_.supplied()) < join && !supply_.ended()) {
    if (!arrive(regions)) return false;
  }
  size_t joining = joined_;
  while (joining < arrived_.size() && static_cast<double>(waiting_.rank(arrived_[joining])) < join) ++joining;
  make_room_to_try(waiting_.size(level) + joining - joined_);
  const auto add = [&](uint32_t place) {
    tried_.push_back({regions(waiting_[place]), waiting_.rank(place), place});
  };
  waiting_.take(level, add);
  for (; joined_ < joining; ++joined_) add(arrived_[joined_]);
  stoppable_sort(job_, tried_.begin(), tried_.end(), std::less<>());
  return true;
}

void DartThrowing::make_room_to_try(size_t count) {
  tried_.clear();
  if (count <= tried_.capacity()) return;
  release(tried_);  // frees the old ones before allocating more
  tried_.reserve(count);
}

/// Takes in the next candidates, except those that are too close to a follicle even at the last level.
bool DartThrowing::arrive(const DartRegions& regions) {
  std::vector<FollicleCandidate> candidates = supply_.next(job_);
  if (candidates.size() == supply_.survey().count && last_ == kLevels) {
    hold_all(std::move(candidates));
    return true;
  }
  const auto r = static_cast<float>(radii_.at(last_));
  if (last_ < kLevels && !order_.empty()) {
    make_room_to_try(candidates.size());
    for (uint32_t i = 0; i < candidates.size(); ++i)
      tried_.push_back({regions(candidates[i]), candidates[i].number, i});
    stoppable_sort(job_, tried_.begin(), tried_.end(), std::less<>());
    job_.for_each(tried_.size(), 4096, [&](WorkRange range) {
      for (size_t i = range.begin; i < range.end; ++i) {
        FollicleCandidate& candidate = candidates[tried_[i].place];
        if (grid_.nearest(candidate, r) < r) candidate.spacing = 0;
      }
    });
    std::erase_if(candidates, [](const FollicleCandidate& candidate) { return candidate.spacing == 0; });
  }
  arrived_.erase(arrived_.begin(), arrived_.begin() + static_cast<std::ptrdiff_t>(joined_));
  joined_ = 0;
  arrived_.reserve(arrived_.size() + candidates.size());
  for (const FollicleCandidate& candidate : candidates) {
    const uint32_t place = waiting_.add(candidate);
    if (place == WaitingCandidates::kNone) return false;
    arrived_.push_back(place);
  }
  return true;
}

void DartThrowing::hold_all(std::vector<FollicleCandidate> candidates) {
  arrived_.resize(candidates.size());
  std::iota(arrived_.begin(), arrived_.end(), 0u);
  waiting_.hold_all(std::move(candidates));
}

/// Measures the distances to follicles of earlier levels. They reject six of seven candidates, in parallel.
void DartThrowing::measure_distances(int level, float radius) {
  job_.for_each(tried_.size(), 4096, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end; ++i) {
      tried_[i].distance = level < kLevels ? grid_.nearest(waiting_[tried_[i].place], radius) : radius;
    }
  });
}

void DartThrowing::accept_or_file(int level, float radius) {
  const uint32_t earlier = grid_.size();
  size_t looked_at = 0;
  for (const Tried& tried : tried_) {
    if ((++looked_at & 0xfff) == 0) job_.check_stop();
    const FollicleCandidate& candidate = waiting_[tried.place];
    // A rejected candidate also waits for follicles of this level where that makes room for others.
    const bool is_measured = tried.distance < radius && last_ == kLevels;
    const float distance = level == kLevels || is_measured
                               ? tried.distance
                               : std::min(tried.distance, grid_.nearest(candidate, radius, earlier));
    if (distance >= radius) {
      accepted_.push_back({tried.rank, candidate.attempt});
      if (level < kLevels) grid_.insert(candidate);
      waiting_.remove(tried.place);
      continue;
    }
    const int later = std::max(radii_.level_of(distance), level + 1);
    if (later > last_) {
      waiting_.remove(tried.place);
    } else {
      waiting_.wait_for(later, tried.place);
    }
  }
}

/// Drops candidates that cannot join before enough follicles are placed. Assumes that the number of follicles
/// grows as 1 / radius^2, which fails if the skin is no wider than their distance.
void DartThrowing::forget_the_hopeless(int level) {
  if (order_.size() < std::max<size_t>(count_ / 50, 1000)) return;
  const double growth = std::max(static_cast<double>(count_) / static_cast<double>(order_.size()), 1.0);
  const int left = static_cast<int>(std::ceil(std::log(growth) / (-2 * std::log(DartRadii::kShrink))));
  last_ = std::min(last_, level + left + kSpareLevels);
  waiting_.drop_from(last_ + 1);
}

}  // namespace

HeldCandidates HeldCandidates::least(size_t candidates, size_t count) {
  // Few candidates are made once and all held. Of many, at most 1.8 per follicle are held on a plane, at the
  // moment when half of the follicles are placed.
  constexpr size_t kFew = size_t(1) << 17, kParts = 16;
  if (candidates <= kFew) return all(candidates);
  return {kParts, std::min(candidates, 2 * count)};
}

HeldCandidates HeldCandidates::fastest(size_t candidates, size_t count) {
  // Coats of up to 340,000 follicles, at most 93 MB. Others make their candidates twice, which takes longer.
  constexpr size_t kFew = size_t(1) << 21;
  return candidates <= kFew ? all(candidates) : least(candidates, count);
}

size_t progressive_order_bytes(size_t candidates, size_t count, const HeldCandidates& held) {
  if (held.in_blocks) return block_order_bytes(FollicleCandidates::max_of(candidates), count);
  // A level tries fewer candidates than there are follicles, or at most all that are held.
  const size_t part = FollicleCandidates::max_of(candidates / held.parts);
  const size_t tried = std::min(held.max_waiting, count);
  const size_t waiting = held.parts == 1 ? 0 : held.max_waiting;  // the only part waits where it was made
  constexpr size_t kArrivedBytes = 4, kTriedBytes = 16;
  const size_t choosing = part * (sizeof(FollicleCandidate) + kArrivedBytes) +
                          waiting * WaitingCandidates::kItemBytes + tried * kTriedBytes +
                          OctaveGrid::bytes(with_overshoot(count), count) +
                          with_overshoot(count) * sizeof(uint32_t);
  const size_t ranking = held.parts == 1 ? part * (sizeof(FollicleCandidate) + 2 * sizeof(SortItem)) : 0;
  return std::max(choosing, ranking);
}

std::optional<std::vector<uint32_t>> progressive_order(CandidateSupply& supply, size_t count, double area,
                                                       const HeldCandidates& held, const Job& job) {
  if (held.in_blocks) {
    const CandidateSurvey survey = supply.survey();
    return block_order(supply.take_all(), survey, count, area, job);
  }
  DartThrowing darts(supply, count, area, held.max_waiting, job);
  if (!darts.run()) return std::nullopt;
  return std::move(darts).order();
}

}  // namespace pelage
