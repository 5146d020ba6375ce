// SPDX-License-Identifier: Apache-2.0
#include "procedurals/thinned_fur.h"

#include <algorithm>

#include "geom/strand_merge.h"
#include "lod/fewer_points.h"
#include "procedurals/bounds/segment_parts.h"

namespace pelage {

std::vector<std::unique_ptr<Procedural>> ThinnedFurProcedural::divide(
    std::shared_ptr<const CoatDetail> detail, std::shared_ptr<const PosedCharacterSkin> skin) {
  const auto leaves = detail->groom().follicles().leaves();
  size_t max = 0;
  for (const FollicleTree::Leaf& leaf : leaves) max = std::max<size_t>(max, leaf.end - leaf.begin);
  std::vector<size_t> firsts;
  size_t strands = 0;
  for (size_t leaf = 0; leaf < leaves.size(); ++leaf) {
    const size_t more = detail->candidates(leaf);
    if (firsts.empty() || strands + more > max) {
      firsts.push_back(leaf);
      strands = 0;
    }
    strands += more;
  }
  std::vector<std::unique_ptr<Procedural>> chunks;
  for (size_t i = 0; i < firsts.size(); ++i) {
    const size_t end = i + 1 < firsts.size() ? firsts[i + 1] : leaves.size();
    chunks.push_back(std::make_unique<ThinnedFurProcedural>(detail, skin, firsts[i], end, i, firsts.size()));
  }
  return chunks;
}

ThinnedFurProcedural::ThinnedFurProcedural(std::shared_ptr<const CoatDetail> detail,
                                           std::shared_ptr<const PosedCharacterSkin> skin, size_t first,
                                           size_t end, size_t index, size_t count)
    : detail_(std::move(detail)),
      skin_(std::move(skin)),
      first_(first),
      end_(end),
      index_(index),
      count_(count) {}

/// Calls `use` with the pose of the skin for the candidates.
template <class Use>
auto ThinnedFurProcedural::in_pose(BoundSpan span, const Use& use) const {
  const Groom& groom = detail_->groom();
  if (groom.needs_closest_point()) return use(*skin_->pose(span));
  std::vector<uint32_t> faces;
  for (size_t leaf = first_; leaf < end_; ++leaf) add_faces(groom, leaf, detail_->candidates(leaf), faces);
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return use(skin_->pose(span, faces));
}

Strands ThinnedFurProcedural::grow(const SkinPose& pose) const {
  std::vector<Strands> leaves;
  FewerPoints fewer;
  for (size_t leaf = first_; leaf < end_; ++leaf) {
    CoatDetail::Choice choice = detail_->choose(leaf, pose);
    if (choice.strands.empty()) continue;
    const KeptStrands kept = choice.kept();
    Strands strands = detail_->groom().grow(leaf, pose.skin(), &kept);
    if (detail_->groom().grows_on_skin()) strands = RootDetail::added(std::move(strands), choice.detail);
    leaves.push_back(fewer.refit(std::move(strands), choice.tolerance));
  }
  if (leaves.size() == 1) return std::move(leaves.front());
  return merge(leaves);
}

Strands ThinnedFurProcedural::generate() const {
  return in_pose(BoundSpan::kShutter, [&](const SkinPose& pose) { return grow(pose); });
}

ChunkBounds ThinnedFurProcedural::exact_bounds(BoundSpan span, int keys) const {
  const Strands strands = in_pose(span, [&](const SkinPose& pose) { return grow(pose); });
  return SegmentParts(strands).exact_bounds(keys);
}

Box3f ThinnedFurProcedural::bound(BoundSpan span) const {
  const Groom& groom = detail_->groom();
  return in_pose(span, [&](const SkinPose& pose) {
    const V3f wider(0.5f * groom.width() * skin_->scale() * (detail_->max_width_factor() - 1));
    Box3f box;
    for (size_t leaf = first_; leaf < end_; ++leaf)
      box.extendBy(groom.conservative_bound(leaf, pose.skin(), detail_->candidates(leaf)));
    return box.isEmpty() ? box : Box3f(box.min - wider, box.max + wider);
  });
}

StrandCounts ThinnedFurProcedural::counts() const {
  StrandCounts sum;
  for (size_t leaf = first_; leaf < end_; ++leaf)
    sum += detail_->groom().counts(leaf, detail_->candidates(leaf));
  sum.motion_keys = static_cast<size_t>(skin_->motion_keys());
  if (detail_->groom().grows_on_skin()) sum.attribute_floats += RootDetail::kFloats * sum.strands;
  return sum;
}

StrandScale ThinnedFurProcedural::scale() const {
  return coat_scale(detail_->groom(), *skin_, detail_.get());
}

size_t ThinnedFurProcedural::temporary_bytes() const {
  // The leaves, before and while they are merged to one batch with fewer points.
  const StrandCounts n = counts();
  return (4 * n.points * n.motion_keys + n.attribute_floats) * sizeof(float) +
         n.strands * (sizeof(uint64_t) + sizeof(RootAddress) + (RootDetail::kFloats + 8) * sizeof(float));
}

/// Hash of all kept strands of the coat, however it is divided.
ContentHash ThinnedFurProcedural::coat() const {
  return ContentHasher()
      .add(kVersion)
      .add(detail_->groom().content_hash())
      .add(skin_->hash())
      .add(skin_->length())
      .add(detail_->simplification().hash())
      .digest();
}

std::optional<ContentHash> ThinnedFurProcedural::content() const {
  return ContentHasher()
      .add(coat())
      .add(static_cast<uint64_t>(first_))
      .add(static_cast<uint64_t>(end_))
      .digest();
}

std::optional<BoundsRecord> ThinnedFurProcedural::bounds_record() const {
  const Groom& groom = detail_->groom();
  if (!groom.store()) return {};
  BoundsRecord record;
  record.store = {detail_, groom.store()};
  record.key = coat();
  record.index = index_;
  record.count = count_;
  return record;
}

}  // namespace pelage
