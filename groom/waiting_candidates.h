// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "groom/follicle_candidates.h"

namespace pelage {

/// Candidates, each of which waits for one level of progressive_order(). Holds at most `max` of them: when
/// full, drops those that wait for the highest levels. Levels are 0 .. `levels` - 1.
class WaitingCandidates {
 public:
  static constexpr uint32_t kNone = 0xffffffffu;
  static constexpr size_t kItemBytes = sizeof(FollicleCandidate) + sizeof(uint32_t);

  WaitingCandidates(int levels, size_t max);

  /// Returns the candidate's place, valid until it is removed; kNone if there is no room and nothing to drop.
  uint32_t add(const FollicleCandidate& candidate);
  void remove(uint32_t place);
  const FollicleCandidate& operator[](uint32_t place) const { return items_[place].candidate; }

  /// Makes a candidate that waits for no level wait for this one. It may be dropped from now on.
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

  size_t max_, held_ = 0;
  int dropped_;
  int highest_ = -1;  // no candidate waits for a higher level
  std::vector<Item> items_;
  uint32_t unused_ = kNone;
  std::vector<uint32_t> heads_;
  std::vector<size_t> sizes_;
};

template <class Visit>
void WaitingCandidates::take(int level, const Visit& visit) {
  const auto l = static_cast<size_t>(level);
  for (uint32_t place = heads_[l]; place != kNone; place = items_[place].next) visit(place);
  heads_[l] = kNone;
  sizes_[l] = 0;
}

}  // namespace pelage
