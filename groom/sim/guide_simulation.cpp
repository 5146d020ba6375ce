// SPDX-License-Identifier: Apache-2.0
#include "groom/sim/guide_simulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/check.h"
#include "base/job.h"

namespace pelage {

using Imath::Quatd;

namespace {

constexpr int kNewtonSteps = 2;
/// A guide whose steps fail is moved again in this many times as many steps, at most so often.
constexpr int kMoreSteps = 4, kRetries = 2;
/// A step that stretches a segment by more than this has not converged.
constexpr double kMostStretch = 0.1;

V3d carried(const RodRoot& root, const V3d& local) { return root.position + turned(root.frame, local); }

RodRoot between(const RodRoot& a, const RodRoot& b, double t) {
  if (t >= 1) return b;
  const double sign = a.frame.r * b.frame.r + a.frame.v.dot(b.frame.v) < 0 ? -1 : 1;
  Quatd frame(a.frame.r * (1 - t) + b.frame.r * (sign * t), a.frame.v * (1 - t) + b.frame.v * (sign * t));
  return {a.position * (1 - t) + b.position * t, frame.normalize()};
}

/// A distance within which the skin is found, although places are rounded to floats.
double safe_limit(double distance, const V3d& point, double unit) {
  return distance * 1.001 + 1e-6 * (point.length() + unit);
}

}  // namespace

struct GuideSimulation::Scratch {
  RodPack pack;
  std::vector<Below> below;          // of the nodes of each lane
  std::vector<CarriedPlane> others;  // of the nodes of each lane; only if there are other skins
  Wind::Cell air;
};

bool GuideShape::has_directions() const {
  double shortest = std::numeric_limits<double>::infinity(), longest = 0;
  for (size_t i = 0; i + 1 < points.size(); ++i) {
    const double length = (points[i + 1] - points[i]).length();
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  }
  return shortest > 1e-4 * longest && longest > 1e-9 && std::isfinite(longest);
}

GuideSimulation::GuideSimulation(const DynamicsParams& params, std::vector<GuideShape> shapes,
                                 const SkinMoment& start)
    : params_(params), shapes_(std::move(shapes)) {
  if (!shapes_.empty()) segments_ = shapes_.front().points.size() - 1;
  always_rigid_.assign(shapes_.size(), 0);
  for (size_t g = 0; g < shapes_.size(); ++g) {
    const GuideShape& shape = shapes_[g];
    const bool usable = shape.has_directions() && shape.radius > 0 && std::isfinite(shape.radius);
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
    std::vector<double>& heights = heights_.emplace_back(segments_ + 1, shape.radius);
    for (size_t i = 0; usable && start.skin && i <= segments_; ++i) {
      const auto below = nearest_place(*start.skin, start.meters_per_unit, points[i],
                                       2 * shape.radius + rods_.back().length());
      if (!below) continue;
      heights[i] = below->height;
      clearance[i] = std::min(clearance[i], below->height);
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

void GuideSimulation::find_skin(size_t g, const SkinMoment& to, double seconds,
                                std::span<Below> below) const {
  const RodState& state = states_[g];
  const RodRoot& root = to.roots[g];
  const Quatd turn = root.frame * ~state.root.frame;
  const double length = rods_[g].length();
  // From the tip down: where a node is high above the skin, its neighbours are known to be.
  for (size_t i = segments_; i > 0; --i) {
    const V3d expected = root.position + turned(turn, state.positions[i] - state.root.position);
    // The farthest that the node is expected to come nearer to the skin.
    const V3d falls = state.velocities[i] * seconds - (expected - state.positions[i]);
    double limit = std::min(length, 2 * falls.length() + 0.1 * length);
    below[i] = {{}, expected, limit};
    if (i < segments_) {
      // Distances of two places from the skin differ by no more than the distance between the places.
      const Below& last = below[i + 1];
      const double at_least = last.distance - (expected - last.from).length();
      below[i].distance = std::max(limit, at_least);
      if (at_least > limit) continue;
      if (last.is_near()) {
        const double known = (expected - last.place.position).length();
        limit = std::min(limit, safe_limit(known, expected, to.meters_per_unit));
      }
    }
    const auto place = nearest_place(*to.skin, to.meters_per_unit, expected, limit);
    if (!place) continue;
    below[i].place = *place;
    below[i].distance = std::fabs(place->height);
  }
}

void GuideSimulation::set_planes(size_t g, const SkinMoment& to, double seconds, std::span<const Below> below,
                                 size_t lane, Scratch& scratch) const {
  const RodRoot& root = to.roots[g];
  const Quatd to_root = ~root.frame;
  const RodState& state = states_[g];
  const Quatd turn = root.frame * ~state.root.frame;
  for (size_t i = 1; i <= segments_; ++i) {
    size_t k = 0;
    if (to.skin) {
      CarriedPlane hard, soft;
      if (below[i].is_near()) {
        const SkinPlace& place = below[i].place;
        hard.normal = soft.normal = turned(to_root, place.outward);
        const auto at_height = [&](double height) {
          return turned(to_root, place.position + place.outward * height - root.position);
        };
        hard.point = at_height(clearance_[g][i]);
        soft.point = at_height(heights_[g][i]);
      }
      scratch.pack.set_plane(lane, i, k++, hard);
      if (params_.volume > 0) scratch.pack.set_plane(lane, i, k++, soft);
    }
    if (to.others.empty()) continue;
    NodeMove node{state.positions[i], root.position + turned(turn, state.positions[i] - state.root.position)};
    node.reach =
        2 * (state.velocities[i] * seconds - (node.after - node.before)).length() + 0.1 * rods_[g].length();
    node.clearance = shapes_[g].radius;
    CarriedPlane& plane = scratch.others[lane * (segments_ + 1) + i];
    plane = plane_of_others(to, node, root);
    scratch.pack.set_plane(lane, i, k, plane);
  }
}

void GuideSimulation::move(std::span<const size_t> guides, const SkinMoment& to, const Wind& wind,
                           double seconds, int steps, Scratch& scratch, int retries) {
  RodPack& pack = scratch.pack;
  pack.reset(segments_);
  const size_t nodes = segments_ + 1;
  scratch.below.resize(RodPack::kLanes * nodes);
  scratch.others.assign(to.others.empty() ? 0 : RodPack::kLanes * nodes, {});
  std::array<RodRoot, RodPack::kLanes> from;
  const auto below_of = [&](size_t lane) { return std::span(scratch.below).subspan(lane * nodes, nodes); };
  // Lanes without a guide repeat the last one.
  const auto known = [&](size_t lane) { return std::min(lane, guides.size() - 1); };
  const auto guide_of = [&](size_t lane) { return guides[known(lane)]; };
  for (size_t lane = 0; lane < RodPack::kLanes; ++lane) {
    const size_t g = guide_of(lane);
    pack.set_rod(lane, rods_[g], states_[g]);
    from[lane] = states_[g].root;
    if (to.skin && known(lane) == lane) find_skin(g, to, seconds, below_of(lane));
    set_planes(g, to, seconds, below_of(known(lane)), lane, scratch);
    for (size_t i = 0; !wind.is_still() && i < nodes; ++i)
      pack.set_air(lane, i, wind.at(states_[g].positions[i], scratch.air));
  }
  RodPack::Step step{V3d(params_.gravity), seconds / steps, kNewtonSteps, !wind.is_still()};
  if (to.skin) ++step.planes;
  if (to.skin && params_.volume > 0) {
    const double rate = 2 * std::numbers::pi * params_.volume;
    step.softness[step.planes++] = rate * rate;
  }
  if (!to.others.empty()) ++step.planes;
  for (int k = 1; k <= steps; ++k) {
    for (size_t lane = 0; lane < RodPack::kLanes; ++lane)
      pack.set_root(lane, between(from[lane], to.roots[guide_of(lane)], static_cast<double>(k) / steps));
    pack.step(step);
  }
  std::vector<size_t> failed;
  for (size_t lane = 0; lane < guides.size(); ++lane) {
    const size_t g = guides[lane];
    const RodState before = states_[g];
    pack.get_state(lane, states_[g]);
    if (!pack.is_finite(lane) || !(rods_[g].stretch(states_[g]) < kMostStretch)) {
      states_[g] = before;
      failed.push_back(g);
    } else if (to.skin || !to.others.empty()) {
      push_outside(g, to, below_of(lane),
                   to.others.empty() ? std::span<const CarriedPlane>()
                                     : std::span(scratch.others).subspan(lane * nodes, nodes));
    }
  }
  if (failed.empty()) return;
  if (retries > 0) return move(failed, to, wind, seconds, kMoreSteps * steps, scratch, retries - 1);
  for (const size_t g : failed) {
    rigid_[g] = 1;
    follow_rigidly(g, to.roots[g], seconds);
  }
}

void GuideSimulation::push_outside(size_t g, const SkinMoment& at, std::span<const Below> below,
                                   std::span<const CarriedPlane> others) {
  RodState& state = states_[g];
  const RodRoot& root = at.roots[g];
  const double length = rods_[g].length();
  const auto raise = [&](size_t i, const V3d& outward, double by) {
    state.positions[i] += outward * by;
    const double into = state.velocities[i].dot(outward);
    if (into < 0) state.velocities[i] -= outward * into;
  };
  // Only a node just below a plane is in contact: the plane means nothing far from where it was found.
  const auto raise_to = [&](size_t i, const V3d& outward, const V3d& point) {
    const double gap = outward.dot(state.positions[i] - point);
    if (gap < 0 && gap > -length / 4) raise(i, outward, -gap);
  };
  V3d measured(0);  // a place above the skin, and its distance from it
  double height = -1;
  for (size_t i = segments_; i > 0; --i) {
    V3d& position = state.positions[i];
    if (!others.empty()) {
      const CarriedPlane& plane = others[i];
      if (plane.normal != V3d(0))
        raise_to(i, turned(root.frame, plane.normal), root.position + turned(root.frame, plane.point));
      const V3d way = way_out_of_others(at, position, shapes_[g].radius, length);
      if (way != V3d(0)) raise(i, way.normalized(), way.length());
    }
    if (!at.skin) continue;
    const SkinPlace& place = below[i].place;
    const bool is_near = below[i].is_near();
    if (is_near) raise_to(i, place.outward, place.position + place.outward * clearance_[g][i]);
    // Distances of two places from the skin differ by no more than the distance between the places.
    const double moved = (position - below[i].from).length();
    if (!below[i].is_inside() && below[i].distance - moved >= clearance_[g][i]) continue;
    if (height - (position - measured).length() >= clearance_[g][i]) continue;
    double limit = length;
    if (is_near) {
      const double known = (position - place.position).length();
      limit = std::min(limit, safe_limit(known, position, at.meters_per_unit));
    }
    for (int k = 0; k < 2; ++k) {
      const auto nearest = nearest_place(*at.skin, at.meters_per_unit, position, k == 0 ? limit : length);
      if (!nearest) break;
      measured = position;
      height = nearest->height;
      const double missing = clearance_[g][i] - nearest->height;
      if (!(missing > 0)) break;
      raise(i, nearest->outward, missing);
    }
  }
}

void GuideSimulation::advance(const SkinMoment& to, const Wind& wind, double seconds, int steps,
                              const Job& job) {
  PELAGE_CHECK(to.roots.size() == guide_count());
  std::vector<size_t> moving;
  for (size_t g = 0; g < guide_count(); ++g) {
    rigid_[g] = always_rigid_[g];
    if (always_rigid_[g]) {
      follow_rigidly(g, to.roots[g], seconds);
    } else {
      moving.push_back(g);
    }
  }
  job.for_each(moving.size(), 8 * RodPack::kLanes, [&](WorkRange range) {
    Scratch scratch;
    for (size_t g = range.begin; g < range.end; g += RodPack::kLanes)
      move(std::span(moving).subspan(g, std::min(RodPack::kLanes, range.end - g)), to, wind, seconds, steps,
           scratch, kRetries);
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
