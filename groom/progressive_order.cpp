// SPDX-License-Identifier: Apache-2.0
// Tested in tests/groom/follicles_test.cpp.
#include "groom/progressive_order.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "base/hash.h"
#include "base/release.h"
#include "base/stoppable_sort.h"
#include "groom/octave_grid.h"

namespace pelage {
namespace {

/// Radius after one level of shrinking: small steps keep prefixes that end within a level near the best.
constexpr double kShrink = 0.94;
/// Part of the densest packing (hexagons) that dart throwing is expected to fill.
constexpr double kExpectedFill = 0.5;
/// Candidates that take part per follicle expected: a fifth more than there are per follicle in the end.
constexpr double kTakePart = 1.2 * static_cast<double>(kCandidatesPerFollicle);
/// To a radius of 1e-11 of the first: only coincident candidates are left.
constexpr int kLevels = 400;
constexpr uint32_t kEndOfList = 0xffffffffu;

/// Candidates that wait for a level each, as lists through FollicleCandidate::next.
class WaitingLists {
 public:
  explicit WaitingLists(std::span<FollicleCandidate> candidates)
      : candidates_(candidates), heads_(kLevels + 1, kEndOfList), sizes_(kLevels + 1, 0) {}
  void add(int level, uint32_t candidate) {
    uint32_t& head = heads_[static_cast<size_t>(level)];
    candidates_[candidate].next = head;
    head = candidate;
    ++sizes_[static_cast<size_t>(level)];
  }
  size_t size(int level) const { return sizes_[static_cast<size_t>(level)]; }
  uint32_t first(int level) const { return heads_[static_cast<size_t>(level)]; }
  uint32_t after(uint32_t candidate) const { return candidates_[candidate].next; }

 private:
  std::span<FollicleCandidate> candidates_;
  std::vector<uint32_t> heads_;
  std::vector<size_t> sizes_;
};

/// The radii of progressive dart throwing.
class Radii {
 public:
  explicit Radii(double area)
      : area_(area), largest_(std::sqrt(kExpectedFill * area * 2.0 / std::sqrt(3.0))) {}

  double at(int level) const { return level < kLevels ? largest_ * std::pow(kShrink, level) : 0.0; }
  /// First level whose radius is at most `distance`.
  int level_of(float distance) const {
    if (!(distance > 0)) return kLevels;
    const int level = static_cast<int>(std::ceil(std::log(distance / largest_) * (1.0 / std::log(kShrink))));
    return std::clamp(level, 0, kLevels);
  }
  /// Follicles expected: hexagonal packing puts 2 / (sqrt(3) r^2) points at distance r on a unit of area.
  double expected(double radius) const {
    return kExpectedFill * area_ * 2.0 / (std::sqrt(3.0) * radius * radius);
  }

 private:
  double area_;
  double largest_;  // expects one follicle
};

/// Region of space of a candidate, for trying neighbours together: Morton code of cells of side 1 /
/// `inverse`.
uint32_t region_of(const FollicleCandidate& c, const V3f& origin, float inverse) {
  const auto spread = [](float coordinate) {
    auto x = static_cast<uint32_t>(std::clamp(coordinate, 0.0f, 1023.0f));
    x = (x | x << 16) & 0x030000ff;
    x = (x | x << 8) & 0x0300f00f;
    x = (x | x << 4) & 0x030c30c3;
    return (x | x << 2) & 0x09249249;
  };
  return spread((c.x - origin.x) * inverse) | spread((c.y - origin.y) * inverse) << 1 |
         spread((c.z - origin.z) * inverse) << 2;
}

}  // namespace

namespace {

/// The last level may find more than are wanted, of which the last go again.
size_t with_overshoot(size_t count) { return count + count / 6; }

}  // namespace

size_t progressive_order_bytes(size_t candidates, size_t count) {
  // Of each follicle: its place in the order, its entry in the grid and at most 4 heads of lists; and some
  // candidates are tried at a time.
  constexpr size_t kOfFollicle = 4 + OctaveGrid::kItemBytes, kHeads = 16, kTried = 24;
  return candidates * sizeof(FollicleCandidate) + with_overshoot(count) * kOfFollicle +
         count * (kHeads + kTried);
}

std::vector<uint32_t> progressive_order(std::span<FollicleCandidate> candidates, size_t count, double area,
                                        const Job& job) {
  count = std::min(count, candidates.size());
  std::vector<uint32_t> order;
  order.reserve(with_overshoot(count));
  if (count == 0) return order;

  float smallest = std::numeric_limits<float>::infinity();
  Box3f box;
  for (const FollicleCandidate& c : candidates) {
    smallest = std::min(smallest, c.spacing);
    box.extendBy(V3f(c.x, c.y, c.z));
  }
  const float extent = std::max({box.size().x, box.size().y, box.size().z, 1e-30f});
  const Radii radii(area);
  OctaveGrid grid(smallest, with_overshoot(count));
  WaitingLists waiting(candidates);
  std::vector<std::pair<uint32_t, uint32_t>> tried;  // region, candidate
  size_t joined = 0;
  double grid_radius = std::numeric_limits<double>::infinity();
  for (int level = 0; level <= kLevels && order.size() < count; ++level) {
    const double radius = radii.at(level);
    const auto r = static_cast<float>(radius);
    if (radius < 0.6 * grid_radius && level < kLevels) {
      grid_radius = radius;
      const double ahead = std::min(radii.expected(0.6 * radius), static_cast<double>(count));
      grid.rebuild(static_cast<size_t>(ahead), r);
    }
    // Regions hold some thousand follicles, so that what is looked at together stays in the cache.
    const float inverse = std::min(1.0f / (64.0f * r * smallest), 1023.0f / extent);
    const double join =
        std::min(kTakePart * radii.expected(radius) + 1, static_cast<double>(candidates.size()));
    const size_t joining =
        static_cast<double>(joined) < join ? static_cast<size_t>(std::ceil(join)) - joined : 0;
    tried.clear();
    if (waiting.size(level) + joining > tried.capacity()) {
      release(tried);  // the old ones go before room for more is made
      tried.reserve(waiting.size(level) + joining);
    }
    const auto add = [&](uint32_t i) { tried.emplace_back(region_of(candidates[i], box.min, inverse), i); };
    for (uint32_t i = waiting.first(level); i != kEndOfList; i = waiting.after(i)) add(i);
    for (; static_cast<double>(joined) < join; ++joined) add(static_cast<uint32_t>(joined));
    stoppable_sort(job, tried.begin(), tried.end(), std::less<>());

    const size_t before = order.size();
    size_t looked_at = 0;
    for (const auto& [region, i] : tried) {
      if ((++looked_at & 0xfff) == 0) job.check_stop();
      const float distance = level < kLevels ? grid.nearest(candidates[i], r) : r;
      if (distance >= r) {
        order.push_back(i);
        if (level < kLevels) grid.insert(candidates[i]);
      } else {
        waiting.add(std::max(radii.level_of(distance), level + 1), i);
      }
    }
    // Which of a level come first must not depend on where they are.
    stoppable_sort(job, order.begin() + static_cast<std::ptrdiff_t>(before), order.end(),
                   [](uint32_t a, uint32_t b) {
                     const uint64_t ha = hash64(a, random_use("follicle order")),
                                    hb = hash64(b, random_use("follicle order"));
                     return ha != hb ? ha < hb : a < b;
                   });
    job.progress.advance(static_cast<double>(std::min(order.size(), count) - std::min(before, count)) /
                         static_cast<double>(count));
  }
  order.resize(std::min(order.size(), count));
  return order;
}

}  // namespace pelage
