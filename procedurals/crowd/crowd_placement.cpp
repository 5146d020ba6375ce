// SPDX-License-Identifier: Apache-2.0
#include "procedurals/crowd/crowd_placement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "base/error.h"
#include "base/hash.h"
#include "base/job.h"
#include "base/progress_stage.h"

namespace pelage {
namespace {

constexpr int kRounds = 40, kSweepsPerRound = 80;
constexpr size_t kBodiesPerJump = 100;
// Limits that keep a crowd of a million from taking hours: comparisons per round of jumps, and total visits
// of sweeps.
constexpr size_t kMaxComparisons = 100'000'000, kMaxVisits = 200'000'000;
constexpr size_t kMinForProgress = 20'000;       // animals, for any arrangement
constexpr size_t kVisitsWorthShowing = 400'000;  // some tenths of a second
constexpr int kJumps = 100;                      // places tried for an animal that is stuck
constexpr float kMargin = 1e-3f;     // of the distance: pushes slightly too far, so that sweeps terminate
constexpr double kDensest = 0.9069;  // area fraction of equal discs in the plane
constexpr float kPi = std::numbers::pi_v<float>;

V2f turned(const V2f& v, float s, float c) { return {c * v.x + s * v.y, c * v.y - s * v.x}; }

/// The state of one animal while it is moved.
struct Body {
  CrowdPlace place;
  std::vector<V3f> discs;  // a point is a disc of radius 0
  float reach = 0;         // farthest point of the footprint from the origin
  float inertia = 1;       // rotational inertia for a mass of 1
  float yields = 1;        // 0: fixed
  float sine = 0, cosine = 1;

  void turn_to(float heading) {
    place.heading = heading;
    sine = std::sin(heading);
    cosine = std::cos(heading);
  }
  V2f lever(size_t disc) const { return turned({discs[disc].x, discs[disc].y}, sine, cosine); }
};

Body body_of(const Footprint& footprint, const CrowdPlace& place) {
  Body body;
  body.place = place;
  body.discs = footprint.empty() ? Footprint{V3f(0)} : footprint;
  float spread = 0;
  for (const V3f& disc : body.discs) {
    const float from_origin = std::hypot(disc.x, disc.y);
    body.reach = std::max(body.reach, from_origin + disc.z);
    spread = std::max(spread, from_origin * from_origin + disc.z * disc.z);
  }
  body.inertia = std::max(0.5f * spread, 1e-12f);
  body.turn_to(place.heading);
  return body;
}

float distance(const Body& a, const Body& b) {
  float min = std::numeric_limits<float>::infinity();
  for (size_t p = 0; p < a.discs.size(); ++p) {
    for (size_t q = 0; q < b.discs.size(); ++q) {
      const V2f apart = b.place.position + b.lever(q) - a.place.position - a.lever(p);
      min = std::min(min, apart.length() - a.discs[p].z - b.discs[q].z);
    }
  }
  return min;
}

/// Points of the R2 sequence [Roberts18] that fall into the area, each jittered by a fraction of their
/// distance: even, but not a lattice.
std::vector<V2f> spread(const GroundArea& area, size_t count, uint64_t seed, const Job& job) {
  constexpr double kStepX = 0.7548776662466927, kStepY = 0.5698402909980532;
  const double shift_x = unit_float(hash64(seed, random_use("crowd shift x")));
  const double shift_y = unit_float(hash64(seed, random_use("crowd shift y")));
  const V2f size = area.max() - area.min();
  const float jitter = 0.4f * std::sqrt(static_cast<float>(area.surface() / static_cast<double>(count)));
  std::vector<V2f> points;
  points.reserve(count);
  // Points may never fall into the sliver of an area: those outside are then moved to its border.
  const uint64_t patience = 1000 * count + 100000;
  for (uint64_t i = 0; points.size() < count; ++i) {
    if (i % 4096 == 0) job.check_stop();
    const double x = shift_x + kStepX * static_cast<double>(i), y = shift_y + kStepY * static_cast<double>(i);
    const V2f at = area.min() + V2f(size.x * static_cast<float>(x - std::floor(x)),
                                    size.y * static_cast<float>(y - std::floor(y)));
    if (!area.contains(at) && i < patience) continue;
    const V2f moved(at.x + jitter * signed_float(hash64(seed, i, random_use("crowd jitter x"))),
                    at.y + jitter * signed_float(hash64(seed, i, random_use("crowd jitter y"))));
    points.push_back(area.nearest(moved));
  }
  return points;
}

/// Pairs of bodies that may touch: those in the same or neighbouring cells of a grid.
class Neighbours {
 public:
  Neighbours(const std::vector<Body>& bodies, const V2f& origin, float cell) {
    cells_.reserve(bodies.size());
    for (uint32_t i = 0; i < bodies.size(); ++i) {
      const V2f at = (bodies[i].place.position - origin) / cell;
      cells_.push_back({static_cast<int32_t>(std::floor(at.x)), static_cast<int32_t>(std::floor(at.y)), i});
    }
    std::sort(cells_.begin(), cells_.end());
  }
  /// Calls `visit(i, j)` once for every pair, in a fixed order.
  static constexpr size_t kBytesPerBody = 3 * sizeof(uint32_t);
  template <class Visit>
  void each_pair(const Visit& visit) const {
    for (const Cell& cell : cells_) {
      for (int dx = -1; dx <= 1; ++dx) {
        auto other = std::lower_bound(cells_.begin(), cells_.end(), Cell{cell.x + dx, cell.y - 1, 0});
        for (; other != cells_.end() && other->x == cell.x + dx && other->y <= cell.y + 1; ++other) {
          if (other->body > cell.body) visit(cell.body, other->body);
        }
      }
    }
  }

 private:
  struct Cell {
    int32_t x, y;
    uint32_t body;
    auto operator<=>(const Cell&) const = default;
  };
  std::vector<Cell> cells_;
};

/// Pushes pairs of discs apart like rigid bodies on ice.
class Crowd {
 public:
  Crowd(const GroundArea& area, const CrowdRules& rules, std::vector<Body> bodies, const Job& job)
      : area_(area), rules_(rules), bodies_(std::move(bodies)), job_(job) {}

  /// Pushes apart every pair that is too close; returns how many there were.
  size_t sweep() {
    float reach = 0;
    for (const Body& body : bodies_) reach = std::max(reach, body.reach);
    const V2f size = area_.max() - area_.min();
    const float touching = 2 * reach + rules_.spacing * (1 + 2 * kMargin);
    if (!(touching > 0)) return 0;
    const Neighbours neighbours(bodies_, area_.min(), std::max(touching, 1e-6f * std::max(size.x, size.y)));
    contacts_.clear();
    size_t pairs = 0;
    neighbours.each_pair([&](uint32_t i, uint32_t j) {
      if ((++pairs & 0xffff) == 0) job_.check_stop();
      const float depth = separate(i, j);
      if (depth > 0) contacts_.push_back({depth, bodies_[j].yields > 0 ? j : i});
    });
    return contacts_.size();
  }

  /// Moves one animal of each pair that was closest in the last sweep, such as two that are interlocked, to
  /// the roomiest of several random places.
  void jump(uint64_t round) {
    job_.check_stop();
    const V2f size = area_.max() - area_.min();
    std::sort(contacts_.begin(), contacts_.end(), [](const Contact& a, const Contact& b) {
      return a.depth != b.depth ? a.depth > b.depth : a.body < b.body;
    });
    const size_t max_jumps =
        1 + std::min(bodies_.size() / kBodiesPerJump, kMaxComparisons / (kJumps * bodies_.size()));
    for (size_t n = 0; n < std::min(max_jumps, contacts_.size()); ++n) {
      const uint32_t i = contacts_[n].body;
      CrowdPlace best = bodies_[i].place;
      float max = -std::numeric_limits<float>::infinity();
      for (uint64_t attempt = 0; attempt < kJumps; ++attempt) {
        job_.check_stop();
        const auto dice = [&](uint64_t use) { return hash64(rules_.seed, i, round, attempt, use); };
        CrowdPlace place;
        place.position = area_.nearest(area_.min() + V2f(size.x * unit_float(dice(random_use("crowd x"))),
                                                         size.y * unit_float(dice(random_use("crowd z")))));
        place.heading =
            rules_.heading + rules_.heading_variation * signed_float(dice(random_use("crowd turn")));
        const float room = room_at(i, place, max);
        if (room <= max) continue;
        max = room;
        best = place;
      }
      bodies_[i].place = best;
      bodies_[i].turn_to(best.heading);
    }
  }
  const std::vector<Body>& bodies() const { return bodies_; }

 private:
  /// Distance from the nearest other footprint if `i` were at `place`. Exact only if larger than `enough`;
  /// otherwise any value up to `enough`.
  float room_at(uint32_t i, const CrowdPlace& place, float enough) const {
    Body moved = bodies_[i];
    moved.place = place;
    moved.turn_to(place.heading);
    float room = std::numeric_limits<float>::infinity();
    for (uint32_t j = 0; j < bodies_.size() && room > enough; ++j) {
      if (j == i) continue;
      const float apart = (bodies_[j].place.position - place.position).length();
      if (apart - moved.reach - bodies_[j].reach < room) room = std::min(room, distance(moved, bodies_[j]));
    }
    return room;
  }

  /// Returns by how much two animals were too close; 0 if they were not.
  float separate(uint32_t i, uint32_t j) {
    Body &a = bodies_[i], &b = bodies_[j];
    const float far = a.reach + b.reach + rules_.spacing;
    if ((b.place.position - a.place.position).length2() > far * far) return 0;
    if (a.yields + b.yields == 0) return 0;
    float deepest = 0;
    for (size_t p = 0; p < a.discs.size(); ++p) {
      for (size_t q = 0; q < b.discs.size(); ++q)
        deepest = std::max(deepest, separate(a, p, b, q, hash64(rules_.seed, i, j)));
    }
    if (deepest > 0) {
      constrain(a);
      constrain(b);
    }
    return deepest;
  }

  /// Solves one contact as in position based dynamics [Mueller07]: both bodies move, in proportion to their
  /// mobility at this point.
  float separate(Body& a, size_t p, Body& b, size_t q, uint64_t tie) {
    const V2f lever_a = a.lever(p), lever_b = b.lever(q);
    V2f apart = b.place.position + lever_b - a.place.position - lever_a;
    const float wanted = a.discs[p].z + b.discs[q].z + rules_.spacing;
    const float length = apart.length();
    if (length >= wanted) return 0;
    const float angle = 2 * kPi * unit_float(tie);  // same point: arbitrary, deterministic
    apart = length > 1e-6f * wanted ? apart / length : V2f(std::sin(angle), std::cos(angle));
    // d(lever)/d(heading) is the lever rotated by a quarter turn: (z, -x).
    const float turn_a = lever_a.y * apart.x - lever_a.x * apart.y;
    const float turn_b = lever_b.y * apart.x - lever_b.x * apart.y;
    const bool turns = rules_.heading_variation > 0;
    const float give_a = a.yields * (1 + (turns ? turn_a * turn_a / a.inertia : 0));
    const float give_b = b.yields * (1 + (turns ? turn_b * turn_b / b.inertia : 0));
    const float push = (wanted * (1 + kMargin) - length) / (give_a + give_b);
    a.place.position -= apart * (push * a.yields);
    b.place.position += apart * (push * b.yields);
    if (turns) {
      a.turn_to(a.place.heading - push * a.yields * turn_a / a.inertia);
      b.turn_to(b.place.heading + push * b.yields * turn_b / b.inertia);
    }
    return wanted - length;
  }

  /// Moves a body back into the area and the allowed headings.
  void constrain(Body& body) const {
    if (body.yields == 0) return;
    body.place.position = area_.nearest(body.place.position);
    if (rules_.heading_variation >= kPi) return;
    const float max = rules_.heading_variation;
    body.turn_to(rules_.heading + std::clamp(body.place.heading - rules_.heading, -max, max));
  }

  const GroundArea& area_;
  const CrowdRules& rules_;
  std::vector<Body> bodies_;
  const Job& job_;
  struct Contact {
    float depth;
    uint32_t body;  // one of the two, not fixed
  };
  std::vector<Contact> contacts_;  // of the last sweep
};

/// Rejects impossible crowds early: more discs than fit the area, enlarged by the parts of discs that may
/// overlap its border.
void require_space(const GroundArea& area, const CrowdRules& rules) {
  float radius = std::numeric_limits<float>::infinity(),
        offset = 0;  // of the smallest of the bodies' largest discs
  for (const Footprint& footprint : rules.footprints) {
    V3f largest(0);
    for (const V3f& disc : footprint) {
      if (disc.z >= largest.z) largest = disc;
    }
    radius = std::min(radius, largest.z);
    offset = std::max(offset, std::hypot(largest.x, largest.y));
  }
  const double disc = double(radius) + 0.5 * rules.spacing, over = disc + offset;
  if (!(disc > 0) || rules.footprints.size() < 2) return;
  const double room = area.surface() + area.border() * over + std::numbers::pi * over * over;
  const double max = kDensest * room / (std::numbers::pi * disc * disc);
  if (static_cast<double>(rules.footprints.size()) <= max + 1) return;
  throw Error(ErrorKind::kInput,
              fmt::format("{} do not fit into its area: at this spacing it holds fewer than {:.0f}",
                          rules.footprints.size(), max + 1));
}

}  // namespace

size_t crowd_placement_bytes(size_t discs) {
  constexpr size_t kHeap = 16;  // per list of discs: overhead and rounding of the heap
  const size_t footprint = sizeof(Footprint) + discs * sizeof(V3f) + kHeap;
  // A few contacts each; while their list grows, the old one still exists.
  constexpr size_t kContacts = 4 * 3 * sizeof(uint64_t) / 2;
  return footprint + sizeof(V2f) + sizeof(Body) + discs * sizeof(V3f) + kHeap + Neighbours::kBytesPerBody +
         kContacts + sizeof(CrowdPlace);
}

std::vector<CrowdPlace> place_crowd(const GroundArea& area, const CrowdRules& rules, const Job& job) {
  require_space(area, rules);
  const size_t count = rules.footprints.size();
  // Sweeps end as soon as there are no contacts; their number is not known in advance.
  const size_t visited_by_a_sweep = count + rules.obstacles.size();
  const size_t sweeps =
      std::min<size_t>(kRounds * kSweepsPerRound, kMaxVisits / std::max<size_t>(1, visited_by_a_sweep) + 1);
  std::optional<ProgressStage> stage;
  const auto show = [&] { stage.emplace(job.progress, "place animals", static_cast<double>(sweeps)); };
  if (count >= kMinForProgress) show();
  const std::vector<V2f> points = spread(area, count, rules.seed, job);
  std::vector<Body> bodies;
  bodies.reserve(count + rules.obstacles.size());
  for (size_t i = 0; i < count; ++i) {
    const float turn = signed_float(hash64(rules.seed, i, random_use("crowd heading")));
    bodies.push_back(
        body_of(rules.footprints[i], {points[i], rules.heading + rules.heading_variation * turn}));
  }
  for (const PlacedFootprint& obstacle : rules.obstacles) {
    bodies.push_back(body_of(obstacle.footprint, obstacle.place));
    bodies.back().yields = 0;
  }
  Crowd crowd(area, rules, std::move(bodies), job);
  size_t contacts = 1, visits = 0;
  for (uint64_t round = 0; round < kRounds && contacts > 0; ++round) {
    if (round > 0) crowd.jump(round);
    for (int sweep = 0; sweep < kSweepsPerRound && contacts > 0 && visits <= kMaxVisits; ++sweep) {
      contacts = crowd.sweep();
      visits += crowd.bodies().size();
      if (!stage && visits >= kVisitsWorthShowing) {
        show();
        stage->advance(static_cast<double>(visits / visited_by_a_sweep - 1));
      }
      if (stage) stage->advance(1);
    }
    if (visits > kMaxVisits) break;
  }
  if (contacts > 0) {
    throw Error(ErrorKind::kInput,
                fmt::format("{} do not fit into its area: after the maximum number of steps, {} pairs are "
                            "still closer than {}; enlarge the area, or reduce count, spacing or footprint",
                            count, contacts, rules.spacing));
  }
  std::vector<CrowdPlace> places;
  for (size_t i = 0; i < count; ++i) places.push_back(crowd.bodies()[i].place);
  return places;
}

float footprint_distance(const Footprint& a, const CrowdPlace& at, const Footprint& b, const CrowdPlace& bt) {
  return distance(body_of(a, at), body_of(b, bt));
}

}  // namespace pelage
