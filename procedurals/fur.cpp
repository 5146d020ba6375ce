// SPDX-License-Identifier: Apache-2.0
#include "procedurals/fur.h"

#include <algorithm>

#include "geom/strand_merge.h"
#include "procedurals/bounds/segment_parts.h"
#include "procedurals/thinned_fur.h"

namespace pelage {
namespace {

/// Calls `use` with the pose of the skin for a leaf.
template <class Use>
auto in_pose(const Groom& groom, const PosedCharacterSkin& skin, size_t leaf, BoundSpan span,
             const Use& use) {
  if (groom.needs_closest_point()) return use(skin.pose(span)->skin());
  return use(skin.pose(span, leaf_faces(groom, leaf)).skin());
}

ChunkBounds exact_leaf_bounds(const Groom& groom, size_t leaf, const PosedSkin& pose, int keys) {
  const Strands strands = groom.grow(leaf, pose);
  return SegmentParts(strands).exact_bounds(keys);
}

Box3f bound_of(const std::vector<std::unique_ptr<Procedural>>& chunks, BoundSpan span) {
  Box3f box;
  for (const auto& chunk : chunks) box.extendBy(chunk->bound(span));
  return box;
}

}  // namespace

FurProcedural::FurProcedural(std::shared_ptr<const Groom> groom,
                             std::shared_ptr<const PosedCharacterSkin> skin,
                             const std::optional<Simplification>& lod,
                             std::shared_ptr<const CoatDirection> direction)
    : groom_(std::move(groom)), skin_(std::move(skin)) {
  if (lod) detail_ = std::make_shared<const CoatDetail>(groom_, *skin_, *lod, std::move(direction));
  skin_->reserve_for_leaves(*groom_, detail_ != nullptr);
}

Box3f FurProcedural::bound(BoundSpan span) const {
  if (groom_->grows_on_skin()) {
    // Without posing the skin: a crowd calls this for every animal.
    Box3f box = skin_->bound(span);
    const float wider = detail_ ? 0.5f * groom_->width() * (detail_->max_width_factor() - 1) : 0.0f;
    const V3f out((groom_->reach() * std::max(1.0f, skin_->length()) + wider) * skin_->scale());
    return {box.min - out, box.max + out};
  }
  if (detail_) return bound_of(ThinnedFurProcedural::divide(detail_, skin_), span);
  const SkinPose pose = skin_->pose(span, {});
  Box3f box;
  for (size_t leaf = 0; leaf < groom_->follicles().leaves().size(); ++leaf) {
    box.extendBy(groom_->conservative_bound(leaf, pose.skin()));
  }
  return box;
}

std::vector<std::unique_ptr<Procedural>> FurProcedural::split() const {
  if (detail_) return ThinnedFurProcedural::divide(detail_, skin_);
  std::vector<std::unique_ptr<Procedural>> leaves;
  for (size_t leaf = 0; leaf < groom_->follicles().leaves().size(); ++leaf) {
    leaves.push_back(std::make_unique<FurLeafProcedural>(groom_, skin_, leaf));
  }
  return leaves;
}

Strands FurProcedural::generate() const {
  std::vector<Strands> chunks;
  for (const auto& chunk : split()) chunks.push_back(chunk->generate());
  return merge(chunks);
}

StrandCounts FurProcedural::counts() const {
  StrandCounts sum;
  for (const auto& chunk : split()) sum += chunk->counts();
  return sum;
}

StrandScale FurProcedural::scale() const { return coat_scale(*groom_, *skin_, detail_.get()); }

ChunkBounds FurProcedural::exact_bounds(BoundSpan span, int keys) const {
  ChunkBounds all;
  all.keys = keys;
  for (const auto& chunk : split()) {
    const ChunkBounds bounds = chunk->exact_bounds(span, keys);
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

StrandScale FurLeafProcedural::scale() const { return coat_scale(*groom_, *skin_, nullptr); }

ChunkBounds FurLeafProcedural::exact_bounds(BoundSpan span, int keys) const {
  return in_pose(*groom_, *skin_, leaf_, span,
                 [&](const PosedSkin& pose) { return exact_leaf_bounds(*groom_, leaf_, pose, keys); });
}

std::optional<ContentHash> FurLeafProcedural::content() const {
  return ContentHasher()
      .add(groom_->content_hash())
      .add(skin_->hash())
      .add(skin_->length())
      .add(static_cast<uint64_t>(leaf_))
      .digest();
}

std::optional<BoundsRecord> FurLeafProcedural::bounds_record() const {
  if (!groom_->store()) return {};
  BoundsRecord record;
  record.store = {groom_, groom_->store()};
  record.key = ContentHasher().add(groom_->content_hash()).add(skin_->hash()).add(skin_->length()).digest();
  record.index = leaf_;
  record.count = groom_->follicles().leaves().size();
  return record;
}

}  // namespace pelage
