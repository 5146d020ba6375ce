// SPDX-License-Identifier: Apache-2.0
#include "groom/progressive_order.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/hash.h"

namespace pelage {
namespace {

/// Radius after one level of shrinking: small steps keep prefixes that end within a level near the best.
constexpr double kShrink = 0.94;
/// Part of the densest packing (hexagons) that dart throwing is expected to fill, for the number of
/// candidates that take part.
constexpr double kExpectedFill = 0.5;

/// To a radius of 1e-11 of the first: only coincident candidates are left.
constexpr int kLevels = 400;

/// Follicles in cells of space, found by hashing. Spacings that differ by more than two are kept in grids of
/// their own (octaves), so that a search never walks through many small cells.
class OctaveGrid {
 public:
  OctaveGrid(const FollicleCandidates& candidates, float smallest_spacing)
      : c_(candidates), smallest_(smallest_spacing) {}

  /// Files `placed` anew for searches at radii up to `radius`.
  void rebuild(const std::vector<uint32_t>& placed, size_t expected, float radius) {
    cell_ = 2.0f * radius * smallest_;
    heads_.assign(std::bit_ceil(2 * expected + 16), kNone);
    next_.clear();
    items_.clear();
    for (uint32_t i : placed) insert(i);
  }

  void insert(uint32_t i) {
    const int octave = octave_of(i);
    octaves_ |= 1u << octave;
    const float inverse = inverse_cell(octave);
    uint32_t& head =
        heads_[bucket(cell(c_.x[i] * inverse), cell(c_.y[i] * inverse), cell(c_.z[i] * inverse), octave)];
    items_.push_back(i);
    next_.push_back(head);
    head = static_cast<uint32_t>(items_.size() - 1);
  }

  /// Distance from candidate `i` to the nearest follicle, in units of the smaller spacing, or `radius` when
  /// none is nearer.
  float nearest(uint32_t i, float radius) const {
    float best = radius;
    const V3f normal = unpack_normal(c_.normal[i]);
    for (unsigned left = octaves_; left != 0; left &= left - 1) {
      const int octave = std::countr_zero(left);
      const float inverse = inverse_cell(octave);
      // Whatever lies in this octave has less than its upper spacing.
      const float reach =
          radius * std::min(c_.spacing[i], smallest_ * static_cast<float>(uint64_t(2) << octave));
      const int32_t x0 = cell((c_.x[i] - reach) * inverse), x1 = cell((c_.x[i] + reach) * inverse);
      const int32_t y0 = cell((c_.y[i] - reach) * inverse), y1 = cell((c_.y[i] + reach) * inverse);
      const int32_t z0 = cell((c_.z[i] - reach) * inverse), z1 = cell((c_.z[i] + reach) * inverse);
      for (int32_t z = z0; z <= z1; ++z) {
        for (int32_t y = y0; y <= y1; ++y) {
          for (int32_t x = x0; x <= x1; ++x) best = nearest_in(bucket(x, y, z, octave), i, normal, best);
        }
      }
    }
    return best;
  }

 private:
  static constexpr uint32_t kNone = 0xffffffffu;

  float nearest_in(size_t bucket_index, uint32_t i, const V3f& normal, float best) const {
    for (uint32_t k = heads_[bucket_index]; k != kNone; k = next_[k]) {
      const uint32_t j = items_[k];
      const float dx = c_.x[i] - c_.x[j], dy = c_.y[i] - c_.y[j], dz = c_.z[i] - c_.z[j];
      const float spacing = std::min(c_.spacing[i], c_.spacing[j]);
      const float limit = best * spacing;
      const float distance2 = dx * dx + dy * dy + dz * dz;
      if (distance2 >= limit * limit) continue;
      if (unpack_normal(c_.normal[j]).dot(normal) < 0.5f) continue;
      best = std::sqrt(distance2) / spacing;
    }
    return best;
  }

  int octave_of(uint32_t i) const {
    return std::clamp(static_cast<int>(std::log2(c_.spacing[i] / smallest_)), 0, 30);
  }
  float inverse_cell(int octave) const { return 1.0f / (cell_ * static_cast<float>(uint64_t(1) << octave)); }
  static int32_t cell(float coordinate) {
    return static_cast<int32_t>(std::floor(std::clamp(coordinate, -2e9f, 2e9f)));
  }
  size_t bucket(int32_t x, int32_t y, int32_t z, int octave) const {
    const uint64_t key = static_cast<uint64_t>(static_cast<uint32_t>(x)) * 0x9e3779b97f4a7c15ull ^
                         static_cast<uint64_t>(static_cast<uint32_t>(y)) * 0xc2b2ae3d27d4eb4full ^
                         static_cast<uint64_t>(static_cast<uint32_t>(z)) * 0x165667b19e3779f9ull ^
                         static_cast<uint64_t>(octave);
    return mix64(key) & (heads_.size() - 1);
  }

  const FollicleCandidates& c_;
  float smallest_;
  float cell_ = 1;
  unsigned octaves_ = 0;
  std::vector<uint32_t> heads_;
  std::vector<uint32_t> next_;
  std::vector<uint32_t> items_;
};

}  // namespace

std::vector<uint32_t> progressive_order(const FollicleCandidates& candidates, size_t count, double area) {
  const size_t available = candidates.size();
  count = std::min(count, available);
  std::vector<uint32_t> order;
  order.reserve(count);
  if (count == 0) return order;

  const float smallest = *std::min_element(candidates.spacing.begin(), candidates.spacing.end());
  // Hexagonal packing puts 2 / (sqrt(3) r^2) points at distance r on a unit of area.
  const auto expected = [area](double radius) {
    return kExpectedFill * area * 2.0 / (std::sqrt(3.0) * radius * radius);
  };
  const double largest = std::sqrt(kExpectedFill * area * 2.0 / std::sqrt(3.0));  // expects one follicle
  const auto radius_of = [largest](int level) { return largest * std::pow(kShrink, level); };
  const auto level_of = [largest](float distance) {
    if (!(distance > 0)) return kLevels;
    const int level = static_cast<int>(std::ceil(std::log(distance / largest) / std::log(kShrink)));
    return std::clamp(level, 0, kLevels);
  };

  std::vector<std::vector<uint32_t>> waiting(kLevels + 1);
  OctaveGrid grid(candidates, smallest);
  size_t joined = 0;
  double grid_radius = std::numeric_limits<double>::infinity();
  for (int level = 0; level <= kLevels && order.size() < count; ++level) {
    const double radius = level < kLevels ? radius_of(level) : 0.0;
    if (radius < 0.6 * grid_radius && level < kLevels) {
      grid_radius = radius;
      const double ahead = std::min(expected(0.5 * radius), static_cast<double>(count));
      grid.rebuild(order, static_cast<size_t>(ahead), static_cast<float>(radius));
    }
    const double take_part =
        static_cast<double>(kCandidatesPerFollicle) / kExpectedFill * 0.6 * expected(radius);
    const size_t join =
        radius > 0 ? static_cast<size_t>(std::min(take_part + 1, static_cast<double>(available))) : available;
    std::vector<uint32_t> tried = std::move(waiting[static_cast<size_t>(level)]);
    waiting[static_cast<size_t>(level)] = {};
    for (; joined < join; ++joined) tried.push_back(static_cast<uint32_t>(joined));
    std::sort(tried.begin(), tried.end());
    for (uint32_t i : tried) {
      const auto r = static_cast<float>(radius);
      const float distance = level < kLevels ? grid.nearest(i, r) : r;
      if (distance >= r) {
        order.push_back(i);
        if (order.size() == count) break;
        if (level < kLevels) grid.insert(i);
      } else {
        waiting[static_cast<size_t>(std::max(level_of(distance), level + 1))].push_back(i);
      }
    }
  }
  return order;
}

}  // namespace pelage
