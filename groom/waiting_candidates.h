// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "groom/follicle_candidates.h"

namespace pelage {

/// Candidates, each of which waits for one level of progressive_order(). Holds at most `max` candidates. When
/// full, drops the candidates that wait for the highest levels. Levels are 0 .. `levels` - 1.
///
/// Add candidates one by one with add(), or all at once with hold_all(), which takes less memory per
/// candidate.
class WaitingCandidates {
 public:
  static constexpr uint32_t kNone = 0xffffffffu;
  static constexpr size_t kItemBytes = sizeof(FollicleCandidate) + sizeof(uint32_t);

  WaitingCandidates(int levels, size_t max);

  /// Returns the candidate's place, valid until it is removed; kNone if there is no room and nothing to drop.
  uint32_t add(const FollicleCandidate& candidate);
  /// Instead of add(): takes all candidates, at most `max`, in order of rank. The place of each is its rank.
  void hold_all(std::vector<FollicleCandidate> candidates);
  void remove(uint32_t place);
  /// FollicleCandidate::number is undefined, see rank().
  const FollicleCandidate& operator[](uint32_t place) const {
    return all_.empty() ? items_[place].candidate : all_[place];
  }
  /// Rank of the candidate among all candidates.
  uint32_t rank(uint32_t place) const { return all_.empty() ? items_[place].candidate.number : place; }

  /// Makes a candidate that waits for no level wait for `level`. The candidate may be dropped from now on.
  void wait_for(int level, uint32_t place);
  size_t size(int level) const { return sizes_[static_cast<size_t>(level)]; }
  /// Calls visit(place) for each candidate that waits for the level. These wait for no level afterwards.
  template <class Visit>
  void take(int level, const Visit& visit);

  /// Drops all candidates that wait for this level or a higher one.
  void drop_from(int level);
  /// The lowest level whose candidates were dropped, or the number of levels.
  int dropped() const { return dropped_; }
  size_t held() const { return held_; }

 private:
  struct Item {
    FollicleCandidate candidate;
    uint32_t next;
  };
  static_assert(sizeof(Item) == kItemBytes);

  void drop();
  /// The next place of the list that the place is in.
  uint32_t& next(uint32_t place) { return all_.empty() ? items_[place].next : all_[place].number; }

  size_t max_, held_ = 0;
  int dropped_;
  int highest_ = -1;                    // no candidate waits for a higher level
  std::vector<Item> items_;             // those of add()
  std::vector<FollicleCandidate> all_;  // those of hold_all(); their numbers are the links of lists
  uint32_t unused_ = kNone;
  std::vector<uint32_t> heads_;
  std::vector<size_t> sizes_;
};

template <class Visit>
void WaitingCandidates::take(int level, const Visit& visit) {
  const auto l = static_cast<size_t>(level);
  for (uint32_t place = heads_[l]; place != kNone; place = next(place)) visit(place);
  heads_[l] = kNone;
  sizes_[l] = 0;
}

}  // namespace pelage
