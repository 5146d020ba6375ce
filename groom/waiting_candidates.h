// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "groom/follicle_candidates.h"

namespace pelage {

/// Candidates that wait for a level of progressive_order() each, at most so many at a time: where there are
/// more, those of the furthest levels are dropped. Levels are 0 .. `levels` - 1.
class WaitingCandidates {
 public:
  static constexpr uint32_t kNone = 0xffffffffu;
  static constexpr size_t kItemBytes = sizeof(FollicleCandidate) + sizeof(uint32_t);

  WaitingCandidates(int levels, size_t max);

  /// Its place until it is removed; kNone, and it is not held, where nothing is left to be dropped.
  uint32_t add(const FollicleCandidate& candidate);
  void remove(uint32_t place);
  const FollicleCandidate& operator[](uint32_t place) const { return items_[place].candidate; }

  /// One that waits for no level waits for this one now. It may be dropped from now on.
  void wait_for(int level, uint32_t place);
  size_t size(int level) const { return sizes_[static_cast<size_t>(level)]; }
  /// Calls visit(place) for each that waits for the level. They wait for none from now on.
  template <class Visit>
  void take(int level, const Visit& visit);

  /// Forgets whatever waits for this level or a later one.
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
  int highest_ = -1;  // none waits for a later level
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
