// SPDX-License-Identifier: Apache-2.0
#include "procedurals/skin/pose_cache.h"

#include <algorithm>

namespace pelage {

PoseCache::PoseCache(int threads, MemoryLedger& ledger)
    : threads_(static_cast<size_t>(std::max(1, threads))), ledger_(ledger) {}

PoseCache::~PoseCache() {
  ledger_.charge(MemoryTag::kSkins, -static_cast<int64_t>(threads_ * (2 * largest_ + largest_part_)));
}

void PoseCache::raise(size_t& largest, size_t bytes, size_t count) {
  if (bytes <= largest) return;
  ledger_.charge(MemoryTag::kSkins, static_cast<int64_t>(count * (bytes - largest)));
  largest = bytes;
}

void PoseCache::reserve(size_t bytes) {
  const std::lock_guard lock(mutex_);
  raise(largest_, bytes, 2 * threads_);
}

void PoseCache::reserve_for_leaves(const Groom& groom, const SurfaceTopology& topology, size_t keys) {
  const std::lock_guard lock(mutex_);
  const auto [known, is_new] = expected_.emplace(&groom, &topology, keys);
  if (!is_new) return;
  for (size_t leaf = 0; leaf < groom.follicles().leaves().size(); ++leaf) {
    const auto [held, making] = topology.pose_bytes(leaf_faces(groom, leaf));
    raise(largest_part_, sizeof(SkinPose) + keys * (held + sizeof(M44f)) + making, threads_);
  }
}

void PoseCache::reserve_for_whole(const SurfaceTopology& topology, size_t keys) {
  const std::lock_guard lock(mutex_);
  const auto [held, making] = topology.pose_bytes();
  raise(largest_part_, sizeof(SkinPose) + keys * (held + sizeof(M44f)) + making, threads_);
}

void PoseCache::keep(std::shared_ptr<const SkinPose> pose) {
  std::shared_ptr<const SkinPose> dropped;  // freed outside of the lock
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
