// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/pushed_strand.h"

#include <algorithm>
#include <cmath>

#include "geom/closest_point.h"
#include "groom/strands/rotation.h"

namespace pelage {
namespace {

/// Max distance from the tip to the root, in lengths of the strand: pushing stretches it slightly.
constexpr float kReach = 1.02f;

}  // namespace

void PushedStrand::add(const V3f& offset) {
  points_.push_back(root_ + offset);
  const size_t p = points_.size() - 1;
  lengths_.push_back(p > 0 ? (points_[p] - points_[p - 1]).length() : 0.0f);
  arcs_.push_back(p > 0 ? arcs_[p - 1] + lengths_[p] : 0.0f);
}

void PushedStrand::push_out(float distance, int iterations, const V3f& tangent) {
  slide(distance, iterations, tangent);
  push_points(distance);
  for (int i = 0; i < iterations && push_curve(); ++i) {
  }
  draw_back();
}

bool PushedStrand::is_clear(float distance) const {
  for (size_t p = 1; p < points_.size(); ++p) {
    V3f point = points_[p];
    if (push(point, clearance(p, distance), depth_limit(point) + distance, nullptr) || !is_outside(p - 1))
      return false;
  }
  return true;
}

StrandReach PushedStrand::reach_after(const StrandReach& before) {
  StrandReach after = before;
  after.distance = std::max(before.distance, before.length * kReach);
  after.length = 2.0f * before.length * static_cast<float>(before.segments);
  after.lean = std::numbers::pi_v<float>;
  return after;
}

/// Lays out the strand again from the root, segment by segment: each keeps its length and, unless it leads
/// into the skin, its direction; otherwise it slides along the skin.
void PushedStrand::slide(float offset, int rounds, const V3f& tangent) {
  const std::vector<V3f> before = points_;
  for (size_t p = 1; p < points_.size(); ++p) {
    const V3f& from = points_[p - 1];
    V3f direction = normalised_or(before[p] - before[p - 1], normal_);
    points_[p] = from + direction * lengths_[p];
    for (int round = 0; round < rounds; ++round) {
      V3f target = points_[p];
      V3f out;
      // If the root is outside, `from` is, so no point of the segment is deeper than its length.
      if (!push(target, clearance(p, offset), lengths_[p] + offset + depth_, &out)) break;
      if (round == 0) {
        direction -= out * std::min(direction.dot(out), 0.0f);
        if (direction.dot(direction) < 0.01f) direction = tangent - out * tangent.dot(out);
      } else {
        direction = target - from;
      }
      points_[p] = from + normalised_or(direction, out) * lengths_[p];
    }
  }
}

/// Moves control points that are inside or nearer than their clearance.
void PushedStrand::push_points(float offset) {
  for (size_t p = 1; p < points_.size(); ++p)
    push(points_[p], clearance(p, offset), depth_limit(points_[p]) + offset);
}

/// Where the curve between control points is inside, moves the adjacent control points; returns whether any
/// moved.
bool PushedStrand::push_curve() {
  bool moved = false;
  for (size_t segment = 0; segment + 1 < points_.size(); ++segment) {
    for (float t : {0.25f, 0.5f, 0.75f, 1.0f}) {
      const V3f on_curve = curve(segment, t);
      V3f out = on_curve;
      if (!push(out, 0.0f, depth_limit(out))) continue;
      moved = true;
      // The two nearest control points have two thirds or more of the weight here.
      const V3f step = (out - on_curve) * 1.6f;
      if (segment > 0) points_[segment] += step;
      points_[segment + 1] += step;
    }
  }
  return moved;
}

/// Last resort: keeps the part of the strand that is outside and within kReach of its length, stretched
/// over all points.
void PushedStrand::draw_back() {
  size_t good = 0;
  while (good + 1 < points_.size() && is_outside(good)) ++good;
  if (good + 1 == points_.size()) return;
  std::vector<V3f> kept(points_.begin(), points_.begin() + static_cast<std::ptrdiff_t>(good) + 1);
  const size_t last = points_.size() - 1;
  if (good == 0) {
    // Only the root is outside. A thousandth of the length is left, along the normal of the skin.
    for (size_t p = 1; p <= last; ++p) points_[p] = root_ + normal_ * (1e-3f * arcs_[p]);
    return;
  }
  for (size_t p = 1; p <= last; ++p) {
    const float at = static_cast<float>(p * good) / static_cast<float>(last);
    const size_t segment = std::min(static_cast<size_t>(at), good - 1);
    points_[p] = kept[segment] + (kept[segment + 1] - kept[segment]) * (at - static_cast<float>(segment));
  }
}

/// The root is on the skin, so points near it cannot keep the full distance.
float PushedStrand::clearance(size_t p, float offset) const { return std::min(offset, 0.5f * arcs_[p]); }

/// Moves a point that is inside, or outside but nearer than `distance`, to that distance; returns whether
/// it moved. `out_of` receives the outward direction. Searches up to `limit`.
bool PushedStrand::push(V3f& point, float distance, float limit, V3f* out_of) const {
  ClosestPoint nearest;
  if (!mesh_.closest(point, limit * 1.001f + 1e-6f, nearest)) return false;
  if (!nearest.inside && nearest.distance >= distance * 0.999f) return false;
  const V3f way = nearest.inside ? nearest.position - point : point - nearest.position;
  const V3f out = nearest.distance > 1e-6f * limit ? normalised_or(way, nearest.normal) : nearest.normal;
  // Slightly farther, so that rounding does not leave the point inside.
  point = nearest.position + out * (distance + 1e-4f * limit);
  if (out_of) *out_of = out;
  return true;
}

bool PushedStrand::is_outside(size_t segment) const {
  const V3f& end = points_[segment + 1];
  if ((end - points_[0]).length() > arcs_.back() * kReach) return false;
  for (float t : {0.25f, 0.5f, 0.75f, 1.0f}) {
    ClosestPoint nearest;
    const V3f at = curve(segment, t);
    const float limit = depth_limit(at) * 1.001f + 1e-6f;
    if (mesh_.closest(at, limit, nearest) && nearest.inside && nearest.distance > 1e-5f * limit) return false;
  }
  return true;
}

/// The pinned uniform B-spline of the control points.
V3f PushedStrand::curve(size_t segment, float t) const {
  const size_t last = points_.size() - 1;
  const V3f p1 = points_[segment], p2 = points_[segment + 1];
  const V3f p0 = segment > 0 ? points_[segment - 1] : p1 * 2.0f - p2;
  const V3f p3 = segment + 2 <= last ? points_[segment + 2] : p2 * 2.0f - p1;
  const float s = 1 - t;
  return (p0 * (s * s * s) + p1 * (3 * t * t * t - 6 * t * t + 4) + p2 * (3 * s * s * s - 6 * s * s + 4) +
          p3 * (t * t * t)) *
         (1.0f / 6);
}

}  // namespace pelage
