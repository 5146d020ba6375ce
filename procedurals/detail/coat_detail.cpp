// SPDX-License-Identifier: Apache-2.0
#include "procedurals/detail/coat_detail.h"

#include <algorithm>
#include <cmath>

#include <Imath/ImathBoxAlgo.h>

namespace pelage {
namespace {

/// Contains all roots at shutter open. Computed for the coat as a whole: transformed boxes of its leaves
/// would depend on its division.
Box3f root_box(const Groom& groom, const PosedCharacterSkin& skin) {
  if (groom.grows_on_skin()) return skin.bound(BoundSpan::kShutter);
  const SkinPose pose = skin.pose(BoundSpan::kShutter, {});
  Box3f box;
  for (const FollicleTree::Leaf& leaf : groom.follicles().leaves()) box.extendBy(leaf.rest_roots);
  return box.isEmpty() ? box : Imath::transform(box, pose.transforms[pose.open_key]);
}

}  // namespace

CoatDetail::CoatDetail(std::shared_ptr<const Groom> groom, const PosedCharacterSkin& skin,
                       const Simplification& simplification, std::shared_ptr<const CoatDirection> direction)
    : groom_(std::move(groom)), simplification_(simplification), direction_(std::move(direction)) {
  const Box3f roots = root_box(*groom_, skin);
  if (roots.isEmpty()) return;
  const V3f eye = simplification_.view().open.position;
  const V3f beyond = eye - Imath::closestPointInBox(eye, roots);
  const V3f half = 0.5f * roots.size();
  const float nearest = beyond.length();
  const float farthest = (eye - roots.center()).length() + half.length();
  const float share = simplification_.max_share(nearest);
  first_out_ = share >= 1 ? 1.0f : share + Simplification::fade_half_width(share);
  min_width_factor_ = simplification_.width_factor(share, 0);
  max_width_factor_ = simplification_.max_width_factor(farthest);
}

size_t CoatDetail::candidates(size_t leaf) const {
  const FollicleTree::Leaf& range = groom_->follicles().leaves()[leaf];
  if (first_out_ >= 1 || !groom_->has_priority_order()) return range.end - range.begin;
  uint32_t low = range.begin, high = range.end;
  while (low < high) {
    const uint32_t middle = low + (high - low) / 2;
    if (groom_->priority(middle) < first_out_) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low - range.begin;
}

RootPlace CoatDetail::place(size_t follicle, const SkinPose& pose) const {
  const PosedSkin skin = pose.skin();
  const SurfacePoint root = groom_->root(follicle, skin, pose.open_key);
  RootPlace place;
  place.open = place.close = root.position;
  if (pose.close_key != pose.open_key) place.close = groom_->root(follicle, skin, pose.close_key).position;
  place.normal = root.du.cross(root.dv).normalized();
  if (direction_) place.direction = direction_->at(groom_->follicles().root(follicle), root);
  return place;
}

CoatDetail::Choice CoatDetail::choose(size_t leaf, const SkinPose& pose) const {
  const uint32_t begin = groom_->follicles().leaves()[leaf].begin;
  Choice choice;
  const size_t count = candidates(leaf);
  for (uint32_t s = 0; s < count; ++s) {
    const float priority = groom_->priority(begin + s);
    if (priority >= first_out_) continue;
    const RootPlace place = this->place(begin + s, pose);
    const float share = simplification_.share(place);
    const float width = simplification_.width_factor(share, priority);
    if (width <= 0) continue;
    choice.strands.push_back(s);
    choice.width.push_back(width);
    choice.contrast.push_back(simplification_.contrast(share));
    choice.detail.emplace_back(place.normal, share);
    choice.tolerance.push_back(share < 1 ? simplification_.tolerance(place.open) : 0.0f);
  }
  return choice;
}

StrandScale coat_scale(const Groom& groom, const PosedCharacterSkin& skin, const CoatDetail* detail) {
  const Box3f box = skin.bound(BoundSpan::kFrame);
  const float wider = detail ? detail->min_width_factor() : 1.0f;
  const float widest = detail ? detail->max_width_factor() : 1.0f, width = groom.width() * skin.scale();
  return {width * wider, box.isEmpty() ? V3f(0) : box.center(), width * widest};
}

}  // namespace pelage
