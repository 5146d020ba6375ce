// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "groom/follicles/follicle_candidates.h"

namespace pelage {

/// Candidates that wait for a level of progressive_order(), each for one level. Levels are numbered 0 ..
/// `levels` - 1. Holds at most `max` candidates. When add() finds it full, drops those that wait for the
/// highest levels.
///
/// Add candidates either one by one with add(), or all at once with hold_all(), which takes less memory per
/// candidate.
class WaitingCandidates {
 public:
  static constexpr uint32_t kNone = 0xffffffffu;
  static constexpr size_t kItemBytes = sizeof(FollicleCandidate) + sizeof(uint32_t);

  WaitingCandidates(int levels, size_t max);

  /// Adds a candidate. Returns its index, which is valid until the candidate is removed or dropped. Returns
  /// kNone if there is no room and no waiting candidate can be dropped.
  uint32_t add(const FollicleCandidate& candidate);
  /// Takes all candidates, at most `max`, in order of rank. For use instead of add(). The index of each
  /// candidate is its rank.
  void hold_all(std::vector<FollicleCandidate> candidates);
  /// Removes a candidate that waits for no level.
  void remove(uint32_t place);
  /// Returns a candidate. Its member `number` is undefined; use rank().
  const FollicleCandidate& operator[](uint32_t place) const {
    return all_.empty() ? items_[place].candidate : all_[place];
  }
  /// Returns the rank of the candidate among all candidates of the supply.
  uint32_t rank(uint32_t place) const { return all_.empty() ? items_[place].candidate.number : place; }

  /// Makes a candidate wait for `level`. The candidate must not wait for a level yet. From now on, it may be
  /// dropped.
  void wait_for(int level, uint32_t place);
  /// Number of candidates that wait for a level.
  size_t size(int level) const { return sizes_[static_cast<size_t>(level)]; }
  /// Calls visit(index) for each candidate that waits for the level. Afterwards, these candidates wait for no
  /// level.
  template <class Visit>
  void take(int level, const Visit& visit);

  /// Drops all candidates that wait for `level` or a higher level.
  void drop_from(int level);
  /// The lowest level from which candidates were dropped; the number of levels if none were dropped.
  int dropped() const { return dropped_; }
  /// Number of candidates in memory.
  size_t held() const { return held_; }

 private:
  struct Item {
    FollicleCandidate candidate;
    uint32_t next;
  };
  static_assert(sizeof(Item) == kItemBytes);

  void drop();
  /// The index that follows `place` in the linked list that contains `place`.
  uint32_t& next(uint32_t place) { return all_.empty() ? items_[place].next : all_[place].number; }

  size_t max_, held_ = 0;
  int dropped_;
  int highest_ = -1;                    // no candidate waits for a level above this one
  std::vector<Item> items_;             // candidates from add()
  std::vector<FollicleCandidate> all_;  // candidates from hold_all(); their member `number` links the lists
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
