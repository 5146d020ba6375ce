// SPDX-License-Identifier: Apache-2.0
#include "groom/sim/guide_simulation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/job.h"
#include "geom/closest_point.h"

namespace pelage {

using Imath::Quatd;

namespace {

constexpr int kNewtonSteps = 2;
/// A step that stretches a segment by more than this has not converged.
constexpr double kMostStretch = 0.1;

V3d carried(const RodRoot& root, const V3d& local) { return root.position + turned(root.frame, local); }

RodRoot between(const RodRoot& a, const RodRoot& b, double t) {
  if (t >= 1) return b;
  const double sign = a.frame.r * b.frame.r + a.frame.v.dot(b.frame.v) < 0 ? -1 : 1;
  Quatd frame(a.frame.r * (1 - t) + b.frame.r * (sign * t), a.frame.v * (1 - t) + b.frame.v * (sign * t));
  return {a.position * (1 - t) + b.position * t, frame.normalize()};
}

/// The nearest place of a skin, in metres.
struct SkinPlace {
  V3d position, outward;
  double height;  // of the point above it; negative inside
};

bool nearest_place(const SkinMoment& at, const V3d& point, double limit, SkinPlace& result) {
  const double unit = at.meters_per_unit;
  ClosestPoint closest;
  if (!at.skin->closest(V3f(point / unit), static_cast<float>(limit / unit), closest)) return false;
  result.position = V3d(closest.position) * unit;
  V3d away = point - result.position;
  if (closest.inside) away = -away;
  const double distance = away.length();
  // Rounding of positions hides the direction of very short distances.
  const bool is_clear = distance > 1e-5 * unit;
  result.outward = is_clear ? away / distance : V3d(closest.normal);
  result.height = closest.inside ? -distance : distance;
  return true;
}

}  // namespace

struct GuideSimulation::Scratch {
  Rod::Workspace rod;
  std::vector<Plane> planes;
  std::vector<RodContact> contacts;
  std::vector<V3d> air;
};

GuideSimulation::GuideSimulation(const DynamicsParams& params, std::vector<GuideShape> shapes,
                                 const SkinMoment& start)
    : params_(params), shapes_(std::move(shapes)) {
  if (!shapes_.empty()) segments_ = shapes_.front().points.size() - 1;
  always_rigid_.assign(shapes_.size(), 0);
  for (size_t g = 0; g < shapes_.size(); ++g) {
    const GuideShape& shape = shapes_[g];
    double shortest = std::numeric_limits<double>::infinity(), longest = 0;
    for (size_t i = 0; i < segments_; ++i) {
      const double length = (shape.points[i + 1] - shape.points[i]).length();
      shortest = std::min(shortest, length);
      longest = std::max(longest, length);
    }
    // A strand of no length, or with coinciding points, has no direction.
    const bool usable = shortest > 1e-4 * longest && longest > 1e-9 && std::isfinite(longest) &&
                        shape.radius > 0 && std::isfinite(shape.radius);
    always_rigid_[g] = !usable;
    std::vector<V3d> points;
    for (size_t i = 0; i <= segments_; ++i) {
      points.push_back(carried(start.roots[g], usable ? shape.points[i] : V3d(0, 0, static_cast<double>(i))));
    }
    Rod rod(points, params.material(usable ? shape.radius : 1), start.roots[g]);
    if (usable) rod.balance(V3d(params.gravity));
    frames_.emplace_back();
    for (const Quatd& frame : rod.rest().frames) frames_.back().push_back(~start.roots[g].frame * frame);
    states_.push_back(rod.rest());
    rods_.push_back(std::move(rod));
    std::vector<double>& clearance = clearance_.emplace_back(segments_ + 1, shape.radius);
    for (size_t i = 0; usable && start.skin && i <= segments_; ++i) {
      SkinPlace below;
      if (nearest_place(start, points[i], 2 * shape.radius + rods_.back().length(), below))
        clearance[i] = std::min(clearance[i], below.height);
    }
    if (!usable) follow_rigidly(g, start.roots[g], 1);
  }
  rigid_ = always_rigid_;
}

void GuideSimulation::follow_rigidly(size_t g, const RodRoot& root, double seconds) {
  RodState& state = states_[g];
  for (size_t i = 0; i <= segments_; ++i) {
    const V3d was = carried(state.root, shapes_[g].points[i]);
    state.positions[i] = carried(root, shapes_[g].points[i]);
    state.velocities[i] = (state.positions[i] - was) / seconds;
  }
  for (size_t i = 0; i < segments_; ++i) state.frames[i] = root.frame * frames_[g][i];
  state.root = root;
}

void GuideSimulation::find_planes(size_t g, const SkinMoment& to, double seconds, Scratch& scratch) const {
  const RodState& state = states_[g];
  const RodRoot& root = to.roots[g];
  const Quatd turn = root.frame * ~state.root.frame;
  for (size_t i = 1; i <= segments_; ++i) {
    const V3d expected = root.position + turned(turn, state.positions[i] - state.root.position);
    Plane& plane = scratch.planes[i];
    // The farthest that the node is expected to come nearer to the skin.
    const V3d falls = state.velocities[i] * seconds - (expected - state.positions[i]);
    const double limit = std::min(rods_[g].length(), 2 * falls.length() + 0.1 * rods_[g].length());
    SkinPlace below;
    plane = {V3d(0), V3d(0), expected, limit};
    if (!nearest_place(to, expected, limit, below)) continue;
    plane.height = below.height;
    plane.normal = turned(~root.frame, below.outward);
    plane.point = turned(~root.frame, below.position + below.outward * clearance_[g][i] - root.position);
  }
}

bool GuideSimulation::move(size_t g, const SkinMoment& to, const Wind& wind, double seconds, int steps,
                           Scratch& scratch) {
  RodState& state = states_[g];
  const RodRoot from = state.root;
  scratch.planes.assign(segments_ + 1, {});
  scratch.contacts.assign(to.skin ? segments_ + 1 : 0, {});
  if (to.skin) find_planes(g, to, seconds, scratch);
  scratch.air.clear();
  if (!wind.is_still()) {
    for (const V3d& position : state.positions) scratch.air.push_back(wind.at(position));
  }
  RodForces forces{V3d(params_.gravity), scratch.air, scratch.contacts};
  for (int k = 1; k <= steps; ++k) {
    const RodRoot root = between(from, to.roots[g], static_cast<double>(k) / steps);
    for (size_t i = 1; i < scratch.contacts.size(); ++i) {
      const Plane& plane = scratch.planes[i];
      RodContact& contact = scratch.contacts[i];
      const V3d point = carried(root, plane.point);
      contact.normal = turned(root.frame, plane.normal);
      contact.offset = contact.normal.dot(point);
      contact.motion = point - carried(state.root, plane.point);
    }
    if (!rods_[g].step(root, forces, seconds / steps, kNewtonSteps, state, scratch.rod)) return false;
  }
  return rods_[g].stretch(state) < kMostStretch;
}

void GuideSimulation::push_outside(size_t g, const SkinMoment& at, Scratch& scratch) {
  RodState& state = states_[g];
  const auto raise = [&](size_t i, const V3d& outward, double by) {
    state.positions[i] += outward * by;
    const double into = state.velocities[i].dot(outward);
    if (into < 0) state.velocities[i] -= outward * into;
  };
  for (size_t i = 1; i <= segments_; ++i) {
    const RodContact& contact = scratch.contacts[i];
    const double gap = contact.normal.dot(state.positions[i]) - contact.offset;
    // Only a node just below its plane is in contact: the plane means nothing far from where it was found.
    if (gap < 0 && gap > -rods_[g].length() / 4) raise(i, contact.normal, -gap);
    // Distance from the skin changes by no more than the node has moved since it was measured.
    const Plane& plane = scratch.planes[i];
    if (plane.height - (state.positions[i] - plane.from).length() >= clearance_[g][i]) continue;
    SkinPlace below;
    for (int k = 0; k < 2; ++k) {
      if (!nearest_place(at, state.positions[i], rods_[g].length(), below)) break;
      const double missing = clearance_[g][i] - below.height;
      if (!(missing > 0)) break;
      raise(i, below.outward, missing);
    }
  }
}

void GuideSimulation::advance(const SkinMoment& to, const Wind& wind, double seconds, int steps,
                              const Job& job) {
  PELAGE_CHECK(to.roots.size() == guide_count());
  job.for_each(guide_count(), 16, [&](WorkRange range) {
    Scratch scratch;
    for (size_t g = range.begin; g < range.end; ++g) {
      const RodRoot before = states_[g].root;
      rigid_[g] = always_rigid_[g] || !move(g, to, wind, seconds, steps, scratch);
      if (rigid_[g]) {
        states_[g].root = before;
        follow_rigidly(g, to.roots[g], seconds);
      } else if (to.skin) {
        push_outside(g, to, scratch);
      }
    }
  });
}

GuideTurns GuideSimulation::turns() const {
  GuideTurns turns;
  turns.reserve(4 * guide_count() * segments_);
  for (size_t g = 0; g < guide_count(); ++g) {
    const RodState& state = states_[g];
    for (size_t i = 0; i < segments_; ++i) {
      const V3d groomed = turned(state.root.frame, shapes_[g].points[i + 1] - shapes_[g].points[i]);
      const V3d now = state.positions[i + 1] - state.positions[i];
      const double sizes = groomed.length() * now.length();
      const Quatd q =
          sizes > 0 && !rigid_[g] ? smallest_turn(groomed / groomed.length(), now / now.length()) : Quatd();
      for (const double c : {q.v.x, q.v.y, q.v.z, q.r}) turns.push_back(static_cast<float>(c));
    }
  }
  return turns;
}

size_t GuideSimulation::rigid_count() const {
  return static_cast<size_t>(std::count(rigid_.begin(), rigid_.end(), 1));
}

std::vector<float> GuideSimulation::state() const {
  std::vector<float> numbers;
  numbers.reserve(state_size());
  const auto add = [&](const V3d& v) {
    for (const double c : {v.x, v.y, v.z}) numbers.push_back(static_cast<float>(c));
  };
  for (const RodState& state : states_) {
    for (const V3d& position : state.positions) add(position - state.root.position);
    for (const V3d& velocity : state.velocities) add(velocity);
    for (const Quatd& frame : state.frames) {
      add(frame.v);
      numbers.push_back(static_cast<float>(frame.r));
    }
  }
  return numbers;
}

void GuideSimulation::set_state(std::span<const float> numbers, const SkinMoment& at) {
  PELAGE_CHECK(numbers.size() == state_size());
  const float* next = numbers.data();
  const auto take = [&] {
    next += 3;
    return V3d(next[-3], next[-2], next[-1]);
  };
  for (size_t g = 0; g < guide_count(); ++g) {
    RodState& state = states_[g];
    state.root = at.roots[g];
    for (V3d& position : state.positions) position = state.root.position + take();
    for (V3d& velocity : state.velocities) velocity = take();
    for (Quatd& frame : state.frames) {
      frame.v = take();
      frame.r = *next++;
      frame.normalize();
    }
  }
}

}  // namespace pelage
