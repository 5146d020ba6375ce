// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/waiting_rays.h"

#include <algorithm>

#include "base/check.h"

namespace pelage {

static_assert(sizeof(WaitingRays::Ray) == 64);

void WaitingRays::UpcomingSteps::add(const Step& step) {
  if (is_full() && !(step < back())) return;
  size_t at = is_full() ? kMaxSteps - 1 : end_++;
  for (; at > begin_ && step < steps_[at - 1]; --at) steps_[at] = steps_[at - 1];
  steps_[at] = step;
}

WaitingRays::Step WaitingRays::UpcomingSteps::last() const {
  return *std::max_element(steps_.begin(), steps_.begin() + end_);
}

WaitingRays::WaitingRays(size_t pages, size_t rays) : rays_(rays), queues_(rays > 0 ? pages : 0) {
  PELAGE_CHECK(rays < kNone);
  waiting_.reserve(std::min(queues_.size(), rays));
  clear();
}

void WaitingRays::clear() {
  for (const uint32_t page : waiting_) queues_[page] = {};
  waiting_.clear();
  free_ = kNone;
  for (size_t slot = rays_.size(); slot-- > 0;) end(static_cast<uint32_t>(slot));
}

size_t WaitingRays::bytes(size_t pages, size_t rays) {
  if (rays == 0) return 0;
  return rays * sizeof(Ray) + pages * sizeof(Queue) + std::min(pages, rays) * sizeof(uint32_t);
}

uint32_t WaitingRays::begin() {
  const uint32_t slot = free_;
  PELAGE_CHECK(slot != kNone);
  free_ = rays_[slot].next;
  return slot;
}

void WaitingRays::end(uint32_t slot) {
  rays_[slot].next = free_;
  free_ = slot;
}

void WaitingRays::wait(uint32_t slot, uint32_t page) {
  Queue& queue = queues_[page];
  rays_[slot].next = kNone;
  if (queue.count == 0) {
    queue.first = slot;
    waiting_.push_back(page);
  } else {
    rays_[queue.last].next = slot;
  }
  queue.last = slot;
  ++queue.count;
}

uint32_t WaitingRays::fullest() const {
  PELAGE_CHECK(!waiting_.empty());
  return *std::max_element(waiting_.begin(), waiting_.end(),
                           [&](uint32_t a, uint32_t b) { return queues_[a].count < queues_[b].count; });
}

uint32_t WaitingRays::release(uint32_t page) {
  waiting_.erase(std::find(waiting_.begin(), waiting_.end(), page));
  const uint32_t first = queues_[page].first;
  queues_[page] = {};
  return first;
}

}  // namespace pelage
