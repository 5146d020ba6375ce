// SPDX-License-Identifier: Apache-2.0
#include "procedurals/posed_character_skin.h"

#include "base/check.h"
#include "base/parallel.h"

namespace pelage {

namespace {

/// Of one time, in order: V3f and M44f are plain floats without padding.
uint64_t hash_of(const PosedCages& cages) {
  uint64_t hash = cages.cages.size();
  for (const std::vector<V3f>& cage : cages.cages) {
    const ContentHash h = content_hash(std::as_bytes(std::span(cage)));
    hash = hash64(hash, h.low, h.high);
  }
  const ContentHash h = content_hash(std::as_bytes(std::span(cages.transforms)));
  return hash64(hash, h.low, h.high);
}

ContentHash hash_of(const CharacterPose& pose) {
  uint64_t words[6] = {pose.topology->hash().low, pose.topology->hash().high,          hash_of(pose.shutter),
                       hash_of(pose.frame_ends),  std::bit_cast<uint32_t>(pose.scale), 0};
  // Strands that keep clear of the skin see its triangles, which depend on the view.
  if (const auto& view = pose.push_out_view) {
    const float seen[] = {view->position.x, view->position.y, view->position.z, view->focal_pixels,
                          view->near_distance};
    words[5] = content_hash(std::as_bytes(std::span(seen))).low;
  }
  return content_hash(std::as_bytes(std::span(words)));
}

size_t bytes_of(const PosedCages& cages) {
  size_t sum = cages.transforms.capacity() * sizeof(M44f);
  for (const std::vector<V3f>& cage : cages.cages) sum += cage.capacity() * sizeof(V3f) + sizeof(cage);
  return sum;
}

}  // namespace

PosedCharacterSkin::PosedCharacterSkin(CharacterPose pose, std::shared_ptr<PoseCache> poses)
    : pose_(std::move(pose)), poses_(std::move(poses)), hash_(hash_of(pose_)) {
  PELAGE_CHECK(!pose_.shutter.cages.empty());
  PELAGE_CHECK(pose_.shutter.transforms.size() == pose_.shutter.cages.size());
  PELAGE_CHECK(pose_.frame_ends.cages.size() == pose_.frame_ends.transforms.size());
  PELAGE_CHECK(pose_.frame_ends.cages.empty() || pose_.frame_ends.cages.size() == 2);
  // How large the trees are is known when they are made; without them, the topology says it.
  poses_->expect(pose_.push_out_view ? make(BoundSpan::kFrame)->bytes()
                                     : sizeof(SkinPose) + (pose_.shutter.cages.size() + 2) *
                                                              (pose_.topology->pose_bytes() + sizeof(M44f)));
}

std::shared_ptr<const SkinPose> PosedCharacterSkin::pose(BoundSpan span) const {
  if (pose_.frame_ends.cages.empty()) span = BoundSpan::kShutter;  // the same
  std::shared_ptr<const SkinPose> pose;
  {
    const std::lock_guard lock(mutex_);
    std::weak_ptr<const SkinPose>& made = made_[static_cast<size_t>(span)];
    pose = made.lock();
    if (!pose) made = pose = make(span);
  }
  poses_->keep(pose);
  return pose;
}

std::shared_ptr<const SkinPose> PosedCharacterSkin::make(BoundSpan span) const {
  auto made = std::make_shared<SkinPose>();
  const auto add = [&](const PosedCages& cages, size_t i) {
    made->keys.emplace_back(pose_.topology, cages.cages[i]);
    made->transforms.push_back(cages.transforms[i]);
  };
  const bool with_ends = span == BoundSpan::kFrame && !pose_.frame_ends.cages.empty();
  const size_t count = pose_.shutter.cages.size() + (with_ends ? 2 : 0);
  made->keys.reserve(count);
  made->transforms.reserve(count);
  if (with_ends) add(pose_.frame_ends, 0);
  for (size_t i = 0; i < pose_.shutter.cages.size(); ++i) add(pose_.shutter, i);
  if (with_ends) add(pose_.frame_ends, 1);
  made->scale = pose_.scale;
  made->length = pose_.length;
  if (pose_.push_out_view) {
    // The triangles that the shutter's keys ask for, so that hair grows the same over either span.
    TessellationOptions options;
    options.first_rated_key = with_ends ? 1 : 0;
    options.end_rated_key = options.first_rated_key + pose_.shutter.cages.size();
    made->mesh = std::make_unique<const SkinMesh>(
        pelage::tessellate(made->keys, *pose_.push_out_view, options, Workers::alone()));
    for (size_t key = 0; key < count; ++key) made->trees.emplace_back(*made->mesh, static_cast<int>(key));
  }
  return made;
}

Box3f PosedCharacterSkin::bound(BoundSpan span) const {
  Box3f box;
  const auto extend = [&](const PosedCages& cages) {
    for (const std::vector<V3f>& cage : cages.cages) {
      for (const V3f& point : cage) box.extendBy(point);
    }
  };
  extend(pose_.shutter);
  if (span == BoundSpan::kFrame) extend(pose_.frame_ends);
  // Limit points are averages of control points, but patches near extraordinary vertices are off by up to
  // 1e-3 of a face (geom/limit_surface.h).
  const V3f out(1e-3f * box.size().length());
  return {box.min - out, box.max + out};
}

TessellationSize PosedCharacterSkin::size(const View& view) const {
  return tessellation_size(pose(BoundSpan::kShutter)->keys, view, {}, Workers::alone());
}

SkinMesh PosedCharacterSkin::tessellate(const View& view) const {
  return pelage::tessellate(pose(BoundSpan::kShutter)->keys, view, {}, Workers::alone());
}

size_t PosedCharacterSkin::bytes() const {
  return sizeof(*this) + bytes_of(pose_.shutter) + bytes_of(pose_.frame_ends);
}

}  // namespace pelage
