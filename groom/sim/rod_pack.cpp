// SPDX-License-Identifier: Apache-2.0
#include "groom/sim/rod_pack.h"

namespace pelage {

RodContact CarriedPlane::contact(const RodRoot& from, const RodRoot& to) const {
  const V3d now = to.position + turned(to.frame, point);
  RodContact contact;
  contact.normal = turned(to.frame, normal);
  contact.offset = contact.normal.dot(now);
  contact.motion = now - (from.position + turned(from.frame, point));
  return contact;
}

void RodPack::reset(size_t segments) {
  if (segments != segments_) {
    segments_ = segments;
    for (Numbers* numbers : {&masses_, &weights_}) numbers->assign(segments + 1, {});
    for (Numbers* numbers : {&lengths_, &joint_lengths_}) numbers->assign(segments, {});
    for (Numbers* numbers : {&positions_, &velocities_, &air_}) numbers->assign(3 * (segments + 1), {});
    rest_darboux_.assign(3 * segments, {});
    frames_.assign(4 * segments, {});
    planes_.assign(6 * kMaxPlanes * (segments + 1), {});
    scratch_.assign(RodPackView::scratch_size(segments), {});
  }
  failed_ = {};
}

void RodPack::set_rod(size_t lane, const Rod& rod, const RodState& state) {
  material_ = rod.material_;
  const auto copy = [&](Numbers& to, const std::vector<double>& from) {
    for (size_t i = 0; i < from.size(); ++i) to[i].lane[lane] = from[i];
  };
  copy(masses_, rod.masses_);
  copy(weights_, rod.weights_);
  copy(lengths_, rod.lengths_);
  copy(joint_lengths_, rod.joint_lengths_);
  for (size_t i = 0; i < segments_; ++i) put(rest_darboux_, 3 * i, lane, rod.rest_darboux_[i]);
  for (size_t i = 0; i <= segments_; ++i) {
    put(positions_, 3 * i, lane, state.positions[i]);
    put(velocities_, 3 * i, lane, state.velocities[i]);
  }
  for (size_t i = 0; i < segments_; ++i) {
    put(frames_, 4 * i, lane, state.frames[i].v);
    frames_[4 * i + 3].lane[lane] = state.frames[i].r;
  }
  bend_.lane[lane] = rod.bend_;
  twist_.lane[lane] = rod.twist_;
  stretch_.lane[lane] = rod.stretch_;
  length_.lane[lane] = rod.length_;
  radius_.lane[lane] = rod.material_.radius;
  set_root(lane, state.root);
  for (size_t k = 0; k < 7; ++k) root_[k].lane[lane] = target_[k].lane[lane];
}

void RodPack::set_plane(size_t lane, size_t node, size_t which, const CarriedPlane& plane) {
  const size_t first = 6 * (kMaxPlanes * node + which);
  put(planes_, first, lane, plane.point);
  put(planes_, first + 3, lane, plane.normal);
}

void RodPack::set_root(size_t lane, const RodRoot& root) {
  const double numbers[7] = {root.position.x, root.position.y, root.position.z, root.frame.v.x,
                             root.frame.v.y,  root.frame.v.z,  root.frame.r};
  for (size_t k = 0; k < 7; ++k) target_[k].lane[lane] = numbers[k];
}

void RodPack::get_state(size_t lane, RodState& state) const {
  for (size_t i = 0; i <= segments_; ++i) {
    state.positions[i] = get(positions_, 3 * i, lane);
    state.velocities[i] = get(velocities_, 3 * i, lane);
  }
  for (size_t i = 0; i < segments_; ++i)
    state.frames[i] = {frames_[4 * i + 3].lane[lane], get(frames_, 4 * i, lane)};
  state.root.position = {root_[0].lane[lane], root_[1].lane[lane], root_[2].lane[lane]};
  state.root.frame = {root_[6].lane[lane],
                      V3d(root_[3].lane[lane], root_[4].lane[lane], root_[5].lane[lane])};
}

RodPackView::RodPackView(RodPack& pack, size_t first)
    : segments(pack.segments_),
      damping(pack.material_.damping),
      drag(pack.material_.drag),
      friction(pack.material_.friction),
      masses(pack.masses_[0].lane + first),
      weights(pack.weights_[0].lane + first),
      lengths(pack.lengths_[0].lane + first),
      joint_lengths(pack.joint_lengths_[0].lane + first),
      rest_darboux(pack.rest_darboux_[0].lane + first),
      air(pack.air_[0].lane + first),
      planes(pack.planes_[0].lane + first),
      target(pack.target_[0].lane + first),
      bend(pack.bend_.lane + first),
      twist(pack.twist_.lane + first),
      stretch(pack.stretch_.lane + first),
      length(pack.length_.lane + first),
      radius(pack.radius_.lane + first),
      positions(pack.positions_[0].lane + first),
      velocities(pack.velocities_[0].lane + first),
      frames(pack.frames_[0].lane + first),
      root(pack.root_[0].lane + first),
      failed(pack.failed_.lane + first),
      scratch(pack.scratch_[0].lane) {}

}  // namespace pelage
