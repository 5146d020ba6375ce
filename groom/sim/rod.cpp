// SPDX-License-Identifier: Apache-2.0
#include "groom/sim/rod.h"

#include <numbers>

#include "base/check.h"

namespace pelage {

using Imath::Quatd;

Quatd smallest_turn(const V3d& from, const V3d& to) {
  const double cosine = from.dot(to);
  if (cosine < -1 + 1e-12) {
    const V3d axis = std::fabs(from.x) < 0.6 ? V3d(1, 0, 0) : V3d(0, 1, 0);
    return {0.0, from.cross(axis).normalized()};
  }
  Quatd turn(1 + cosine, from.cross(to));
  return turn.normalize();
}

Rod::Rod(std::span<const V3d> points, const RodMaterial& material, const std::optional<RodRoot>& clamp)
    : is_clamped_(clamp.has_value()), material_(material) {
  PELAGE_CHECK(points.size() >= 2);
  const size_t n = points.size() - 1;
  rest_.positions.assign(points.begin(), points.end());
  rest_.velocities.assign(n + 1, V3d(0));
  masses_.assign(n + 1, 0.0);
  weights_.assign(n + 1, 0.0);
  const double r2 = material.radius * material.radius, area = std::numbers::pi * r2;
  for (size_t i = 0; i < n; ++i) {
    lengths_.push_back((points[i + 1] - points[i]).length());
    length_ += lengths_[i];
    for (const size_t node : {i, i + 1}) {
      weights_[node] += lengths_[i] / 2;
      masses_[node] += material.density * area * lengths_[i] / 2;
    }
    joint_lengths_.push_back(i > 0 ? (lengths_[i - 1] + lengths_[i]) / 2 : lengths_[0] / 2);
  }
  const double points_2 = static_cast<double>(n * n);
  bend_ = material.youngs_modulus * area * r2 / 4 * (is_clamped_ ? 1 + 1 / points_2 : 1);
  twist_ = bend_ / (1 + material.poisson_ratio);
  stretch_ = material.youngs_modulus * area;
  if (clamp) rest_.root = *clamp;
  V3d along(0, 0, 1);
  Quatd frame;
  if (clamp) {
    frame = clamp->frame;
    along = turned(frame, along);
  }
  for (size_t i = 0; i < n; ++i) {
    const V3d next = (points[i + 1] - points[i]) / lengths_[i];
    frame = (smallest_turn(along, next) * frame).normalize();
    along = next;
    rest_.frames.push_back(frame);
  }
  for (size_t i = 0; i < n; ++i) rest_darboux_.push_back(i >= first_joint() ? darboux(rest_, i) : V3d(0));
}

void Rod::set_curvature(const V3d& per_metre) {
  for (size_t i = 1; i < segment_count(); ++i) rest_darboux_[i] = per_metre * joint_lengths_[i];
}

V3d Rod::darboux(const RodState& state, size_t i) const {
  const Quatd& q0 = before(state, i);
  const Quatd& q1 = state.frames[i];
  const V3d v = q0.r * q1.v - q1.r * q0.v - q0.v.cross(q1.v);
  return (q0.r * q1.r + q0.v.dot(q1.v) < 0 ? -2.0 : 2.0) * v;
}

void Rod::balance(const V3d& gravity) {
  PELAGE_CHECK(is_clamped_);
  V3d load(0), moment(0);  // carried by the segment, and at its outer end
  for (size_t i = segment_count(); i-- > 0;) {
    const V3d edge = rest_.positions[i + 1] - rest_.positions[i];
    const double length = edge.length();
    load += masses_[i + 1] * gravity;
    moment += edge.cross(load);
    const double tension = load.dot(edge) / length;
    if (stretch_ + tension > 0) lengths_[i] = length * stretch_ / (stretch_ + tension);
    // The moment is W^T K (Darboux - rest) with W as in add_joint().
    const Quatd& q0 = before(rest_, i);
    const V3d now = darboux(rest_, i), half = now / 2;
    const double s = std::sqrt(std::max(1e-6, 1 - half.dot(half)));
    const V3d local = turned(~q0, moment);
    // Solves (s I + [half]x) y = local: the inverse is (s^2 + half half^T - s [half]x) / (s (s^2 +
    // |half|^2)).
    const V3d y =
        (local * (s * s) + half * half.dot(local) - s * half.cross(local)) / (s * (s * s + half.dot(half)));
    // The rod pulls back: its moment is opposite to the load's.
    const V3d stiffness = V3d(bend_, bend_, twist_) / joint_lengths_[i];
    if (bend_ > 0) rest_darboux_[i] = now - V3d(y.x / stiffness.x, y.y / stiffness.y, y.z / stiffness.z);
  }
}

double Rod::energy(const RodState& state, const V3d& gravity) const {
  double sum = 0;
  for (size_t i = 0; i < state.positions.size(); ++i) {
    if (i == 0 && is_clamped_) continue;
    sum += masses_[i] * (state.velocities[i].length2() / 2 - gravity.dot(state.positions[i]));
  }
  for (size_t i = 0; i < segment_count(); ++i) {
    const double longer = (state.positions[i + 1] - state.positions[i]).length() - lengths_[i];
    sum += stretch_ / lengths_[i] * longer * longer / 2;
    if (i < first_joint()) continue;
    const V3d d = darboux(state, i) - rest_darboux_[i];
    sum += (bend_ * (d.x * d.x + d.y * d.y) + twist_ * d.z * d.z) / joint_lengths_[i] / 2;
  }
  return sum;
}

V3d Rod::momentum(const RodState& state) const {
  V3d sum(0);
  for (size_t i = 0; i < masses_.size(); ++i) sum += masses_[i] * state.velocities[i];
  return sum;
}

V3d Rod::angular_momentum(const RodState& state) const {
  V3d sum(0);
  for (size_t i = 0; i < masses_.size(); ++i)
    sum += masses_[i] * state.positions[i].cross(state.velocities[i]);
  return sum;
}

double Rod::stretch(const RodState& state) const {
  double most = 0;
  for (size_t i = 0; i < segment_count(); ++i) {
    const double now = (state.positions[i + 1] - state.positions[i]).length();
    most = std::max(most, std::fabs(now / lengths_[i] - 1));
  }
  return most;
}

}  // namespace pelage
