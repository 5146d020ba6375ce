// SPDX-License-Identifier: Apache-2.0
#include "groom/follicles/waiting_candidates.h"

#include <algorithm>
#include <utility>

#include "base/check.h"

namespace pelage {

WaitingCandidates::WaitingCandidates(int levels, size_t max)
    : max_(max),
      dropped_(levels),
      heads_(static_cast<size_t>(levels), kNone),
      sizes_(static_cast<size_t>(levels), 0) {}

void WaitingCandidates::hold_all(std::vector<FollicleCandidate> candidates) {
  PELAGE_CHECK(items_.empty() && candidates.size() <= max_);
  all_ = std::move(candidates);
  held_ = all_.size();
}

uint32_t WaitingCandidates::add(const FollicleCandidate& candidate) {
  if (items_.empty()) items_.reserve(max_);
  if (held_ == max_) drop();
  if (held_ == max_) return kNone;
  ++held_;
  if (unused_ == kNone) {
    items_.push_back({candidate, kNone});
    return static_cast<uint32_t>(items_.size() - 1);
  }
  const uint32_t place = unused_;
  unused_ = items_[place].next;
  items_[place].candidate = candidate;
  return place;
}

void WaitingCandidates::remove(uint32_t place) {
  next(place) = unused_;
  unused_ = place;
  --held_;
}

void WaitingCandidates::wait_for(int level, uint32_t place) {
  uint32_t& head = heads_[static_cast<size_t>(level)];
  next(place) = head;
  head = place;
  ++sizes_[static_cast<size_t>(level)];
  highest_ = std::max(highest_, level);
}

void WaitingCandidates::drop() {
  const size_t enough = max_ - max_ / 16;
  while (highest_ >= 0 && held_ >= enough) drop_from(highest_);
}

void WaitingCandidates::drop_from(int level) {
  for (; highest_ >= level; --highest_) {
    const auto l = static_cast<size_t>(highest_);
    if (sizes_[l] == 0) continue;
    dropped_ = std::min(dropped_, highest_);
    uint32_t following = kNone;
    for (uint32_t place = heads_[l]; place != kNone; place = following) {
      following = next(place);
      remove(place);
    }
    heads_[l] = kNone;
    sizes_[l] = 0;
  }
}

}  // namespace pelage
