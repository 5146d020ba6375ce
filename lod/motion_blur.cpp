// SPDX-License-Identifier: Apache-2.0
#include "lod/motion_blur.h"

#include <cmath>

namespace pelage {
namespace {

V3f in_camera(const LodPose& pose, const V3f& point) {
  const V3f d = point - pose.position;
  return {d.dot(pose.right), d.dot(pose.up), d.dot(pose.forward)};
}

}  // namespace

float motion_across(const LodView& view, const V3f& at_open, const V3f& at_close) {
  const V3f from = in_camera(view.open, at_open);
  const V3f motion = in_camera(view.close, at_close) - from;
  const float distance2 = from.length2();
  if (!(distance2 > 0)) return motion.length();
  const float along = motion.dot(from);
  return std::sqrt(std::max(0.0f, motion.length2() - along * along / distance2));
}

}  // namespace pelage
