// SPDX-License-Identifier: Apache-2.0
#include "procedurals/pose_cache.h"

#include <algorithm>

namespace pelage {

size_t SkinPose::bytes() const {
  size_t sum = sizeof(*this) + transforms.capacity() * sizeof(M44f) + (mesh ? mesh->bytes() : 0);
  for (const LimitSurface& key : keys) sum += key.bytes();
  for (const ClosestPointTree& tree : trees) sum += tree.bytes();
  return sum;
}

PoseCache::PoseCache(int threads, MemoryLedger& ledger)
    : threads_(static_cast<size_t>(std::max(1, threads))), ledger_(ledger) {}

PoseCache::~PoseCache() { ledger_.charge(MemoryTag::kSkins, -static_cast<int64_t>(2 * threads_ * largest_)); }

void PoseCache::expect(size_t bytes) {
  const std::lock_guard lock(mutex_);
  if (bytes <= largest_) return;
  ledger_.charge(MemoryTag::kSkins, static_cast<int64_t>(2 * threads_ * (bytes - largest_)));
  largest_ = bytes;
}

void PoseCache::keep(std::shared_ptr<const SkinPose> pose) {
  std::shared_ptr<const SkinPose> dropped;  // freed when nobody waits for it
  const std::lock_guard lock(mutex_);
  const auto known = std::find(recent_.begin(), recent_.end(), pose);
  if (known != recent_.end()) {
    std::rotate(known, known + 1, recent_.end());
    return;
  }
  if (recent_.size() == threads_) {
    dropped = std::move(recent_.front());
    recent_.erase(recent_.begin());
  }
  recent_.push_back(std::move(pose));
}

}  // namespace pelage
