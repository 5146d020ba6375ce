// SPDX-License-Identifier: Apache-2.0
#include "lod/lod_view.h"

#include <algorithm>
#include <cmath>

namespace pelage {
namespace {

V3f turned(const LodPose& pose, const V3f& d) {
  return {d.dot(pose.right), d.dot(pose.up), d.dot(pose.forward)};
}

/// Relative to the camera at shutter open: the motion, and the direction to the point.
struct Seen {
  V3f motion{0};  // across the line of sight
  V3f sight{0};   // unit, or 0 at the eye
};

Seen seen(const LodView& view, const V3f& at_open, const V3f& at_close) {
  const V3f from = turned(view.open, at_open - view.open.position);
  const V3f motion = turned(view.close, at_close - view.close.position) - from;
  const V3f sight = from.normalized();
  return {motion - motion.dot(sight) * sight, sight};
}

}  // namespace

float pixels_per_unit(const LodView& view, float distance) {
  return view.open.focal_pixels / std::max(distance, view.near_distance);
}

float pixels_per_unit(const LodView& view, const V3f& point) {
  return pixels_per_unit(view, (point - view.open.position).length());
}

float motion_across(const LodView& view, const V3f& at_open, const V3f& at_close) {
  return seen(view, at_open, at_close).motion.length();
}

float motion_across_line(const LodView& view, const V3f& at_open, const V3f& at_close, const V3f& line) {
  const Seen s = seen(view, at_open, at_close);
  const float along = s.motion.normalized().dot(turned(view.open, line));
  return s.motion.length() * std::sqrt(std::max(0.0f, 1 - along * along));
}

float confusion_diameter(const LodView& view, const V3f& point) {
  if (!(view.lens_diameter > 0)) return 0;
  const float depth = std::max(0.0f, (point - view.open.position).dot(view.open.forward));
  return view.lens_diameter * std::abs(depth - view.focus_distance) / view.focus_distance;
}

float facing(const LodView& view, const V3f& point, const V3f& normal) {
  return normal.length2() > 0 ? normal.dot((view.open.position - point).normalized()) : 1.0f;
}

}  // namespace pelage
