// SPDX-License-Identifier: Apache-2.0
#include "exchange/posed_frames.h"

#include <algorithm>
#include <cmath>

#include "base/memory_budget.h"
#include "base/progress.h"

namespace pelage {
namespace {

/// Memory of the text of a leaf before it is written to its file.
constexpr int64_t kTextBytes = int64_t(3) << 20;

int64_t cage_bytes(const FrameParts& parts) {
  int64_t bytes = 0;
  for (const FrameSkin& skin : parts.skins) {
    for (const auto& cage : skin.cages.cages) bytes += static_cast<int64_t>(2 * cage.size() * sizeof(V3f));
  }
  return bytes;
}

template <class Same>
std::vector<size_t> different(size_t count, bool moves, const Same& same_as_first) {
  std::vector<size_t> frames{0};
  bool differ = moves;
  for (size_t i = 1; i < count; ++i) differ |= !same_as_first(i);
  if (!differ) return frames;
  for (size_t i = 1; i < count; ++i) frames.push_back(i);
  return frames;
}

}  // namespace

PosedFrames::PosedFrames(const ExportSource& source, const Job& job) : numbers_(source.scene.frames.frames) {
  int64_t bytes = 0;
  const ProgressStage stage(job.progress, "pose", static_cast<double>(numbers_.size()));
  for (const int frame : numbers_) {
    job.check_stop();
    parts_.push_back(pose_frame(source.scene, source.assets, frame, job));
    bytes += cage_bytes(parts_.back());
    require_memory(job.ledger, bytes, "the cages of all exported frames");
    stage.advance(1);
  }
  charge_ = reserve(job.ledger, MemoryTag::kSkins, bytes, "the cages of all exported frames");
}

std::vector<size_t> PosedFrames::different_skins(size_t skin) const {
  const FrameSkin& first = parts_[0].skins[skin];
  return different(count(), first.posed->motion_keys() > 1,
                   [&](size_t i) { return parts_[i].skins[skin].posed->hash() == first.posed->hash(); });
}

std::vector<size_t> PosedFrames::different_coats(size_t coat) const {
  const FrameCoat& first = parts_[0].coats[coat];
  return different(count(), first.skin->motion_keys() > 1, [&](size_t i) {
    const FrameCoat& other = parts_[i].coats[coat];
    return other.skin->hash() == first.skin->hash() && other.skin->length() == first.skin->length() &&
           other.coat->content_hash() == first.coat->content_hash() && other.coat == first.coat;
  });
}

std::vector<double> PosedFrames::times(size_t frame, int keys) const {
  std::vector<double> times;
  for (const float time : motion_times(parts_[frame].camera, keys)) {
    const double exact = numbers_[frame] + (keys > 1 ? double{time} : 0.0);
    times.push_back(std::round(exact * 1e6) / 1e6);
  }
  return times;
}

void for_each_leaf_at_once(const CoatTree& tree, const Job& job,
                           const std::function<void(size_t leaf)>& use) {
  const auto threads = static_cast<size_t>(job.workers.thread_count());
  const size_t leaves = tree.all().end;
  const ProgressStage stage(job.progress, "write", static_cast<double>(leaves));
  int64_t leaf_bytes = 0;
  for (size_t leaf = 0; leaf < leaves; ++leaf)
    leaf_bytes = std::max(leaf_bytes, tree.growth_bytes(leaf) + kTextBytes);
  size_t at_once = threads;
  while (at_once > 1 && !has_room(job.ledger, static_cast<int64_t>(at_once) * leaf_bytes)) --at_once;
  const MemoryCharge charge = reserve(job.ledger, MemoryTag::kChunks,
                                      static_cast<int64_t>(at_once) * leaf_bytes, "growing a leaf of a coat");
  const size_t batch = at_once == threads ? std::max<size_t>(leaves, 1) : at_once;
  for (size_t first = 0; first < leaves; first += batch) {
    job.for_each(std::min(batch, leaves - first), 1, [&](WorkRange range) {
      for (size_t i = range.begin; i < range.end; ++i) {
        use(first + i);
        stage.advance(1);
      }
    });
  }
}

}  // namespace pelage
