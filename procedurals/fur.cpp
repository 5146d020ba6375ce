// SPDX-License-Identifier: Apache-2.0
#include "procedurals/fur.h"

#include <algorithm>

#include "base/program_identity.h"
#include "geom/strand_merge.h"
#include "procedurals/segment_parts.h"

namespace pelage {
namespace {

/// Calls `use` with the skin as a leaf needs it.
template <class Use>
auto in_pose(const Groom& groom, const PosedCharacterSkin& skin, size_t leaf, BoundSpan span,
             const Use& use) {
  if (groom.needs_closest_point()) return use(skin.pose(span)->skin());
  return use(skin.pose(span, leaf_faces(groom, leaf)).skin());
}

StrandScale coat_scale(const Groom& groom, const PosedCharacterSkin& skin) {
  const Box3f box = skin.bound(BoundSpan::kFrame);
  return {groom.width() * skin.scale(), box.isEmpty() ? V3f(0) : box.center()};
}

ChunkBounds exact_leaf_bounds(const Groom& groom, size_t leaf, const PosedSkin& pose, int keys) {
  const Strands strands = groom.grow(leaf, pose);
  return SegmentParts(strands).exact_bounds(keys);
}

}  // namespace

FurProcedural::FurProcedural(std::shared_ptr<const Groom> groom,
                             std::shared_ptr<const PosedCharacterSkin> skin)
    : groom_(std::move(groom)), skin_(std::move(skin)) {
  skin_->expect_leaves(*groom_);
}

Box3f FurProcedural::bound(BoundSpan span) const {
  if (groom_->grows_on_skin()) {
    // Without posing the skin: a crowd asks this of every animal.
    Box3f box = skin_->bound(span);
    const V3f out(groom_->reach() * skin_->scale() * std::max(1.0f, skin_->length()));
    return {box.min - out, box.max + out};
  }
  const SkinPose pose = skin_->pose(span, {});
  Box3f box;
  for (size_t leaf = 0; leaf < groom_->follicles().leaves().size(); ++leaf) {
    box.extendBy(groom_->conservative_bound(leaf, pose.skin()));
  }
  return box;
}

std::vector<std::unique_ptr<Procedural>> FurProcedural::split() const {
  std::vector<std::unique_ptr<Procedural>> leaves;
  for (size_t leaf = 0; leaf < groom_->follicles().leaves().size(); ++leaf) {
    leaves.push_back(std::make_unique<FurLeafProcedural>(groom_, skin_, leaf));
  }
  return leaves;
}

Strands FurProcedural::generate() const {
  const auto pose = skin_->pose(BoundSpan::kShutter);
  std::vector<Strands> leaves;
  for (size_t leaf = 0; leaf < groom_->follicles().leaves().size(); ++leaf)
    leaves.push_back(groom_->grow(leaf, pose->skin()));
  return merge(leaves);
}

StrandCounts FurProcedural::counts() const {
  StrandCounts sum;
  for (size_t leaf = 0; leaf < groom_->follicles().leaves().size(); ++leaf) sum += groom_->counts(leaf);
  sum.motion_keys = static_cast<size_t>(skin_->motion_keys());
  return sum;
}

StrandScale FurProcedural::scale() const { return coat_scale(*groom_, *skin_); }

ChunkBounds FurProcedural::exact_bounds(BoundSpan span, int keys) const {
  const auto pose = skin_->pose(span);
  ChunkBounds all;
  all.keys = keys;
  for (size_t leaf = 0; leaf < groom_->follicles().leaves().size(); ++leaf) {
    const ChunkBounds bounds = exact_leaf_bounds(*groom_, leaf, pose->skin(), keys);
    all.boxes.insert(all.boxes.end(), bounds.boxes.begin(), bounds.boxes.end());
  }
  return all;
}

FurLeafProcedural::FurLeafProcedural(std::shared_ptr<const Groom> groom,
                                     std::shared_ptr<const PosedCharacterSkin> skin, size_t leaf)
    : groom_(std::move(groom)), skin_(std::move(skin)), leaf_(leaf) {}

Box3f FurLeafProcedural::bound(BoundSpan span) const {
  return in_pose(*groom_, *skin_, leaf_, span,
                 [&](const PosedSkin& pose) { return groom_->conservative_bound(leaf_, pose); });
}

Strands FurLeafProcedural::generate() const {
  return in_pose(*groom_, *skin_, leaf_, BoundSpan::kShutter,
                 [&](const PosedSkin& pose) { return groom_->grow(leaf_, pose); });
}

StrandCounts FurLeafProcedural::counts() const {
  StrandCounts counts = groom_->counts(leaf_);
  counts.motion_keys = static_cast<size_t>(skin_->motion_keys());
  return counts;
}

StrandScale FurLeafProcedural::scale() const { return coat_scale(*groom_, *skin_); }

ChunkBounds FurLeafProcedural::exact_bounds(BoundSpan span, int keys) const {
  return in_pose(*groom_, *skin_, leaf_, span,
                 [&](const PosedSkin& pose) { return exact_leaf_bounds(*groom_, leaf_, pose, keys); });
}

std::optional<BoundsRecord> FurLeafProcedural::bounds_record() const {
  if (!groom_->store()) return {};
  BoundsRecord record;
  record.store = {groom_, groom_->store()};
  // How boxes are made is code of this room: those of another build of the program are not asked for.
  record.key = ContentHasher()
                   .add(program_identity())
                   .add(groom_->content_hash())
                   .add(skin_->hash())
                   .add(skin_->length())
                   .digest();
  record.index = leaf_;
  record.count = groom_->follicles().leaves().size();
  return record;
}

}  // namespace pelage
