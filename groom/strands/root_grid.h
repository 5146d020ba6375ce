// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/vector.h"

namespace pelage {

/// Finds the nearest of a fixed set of points on a skin. Ignores points whose normals differ by more than 60
/// degrees from the normal of the query. This separates the two sides of a thin ear. Immutable.
/// Thread safety: const members may be called from any thread.
class RootGrid {
 public:
  struct Neighbour {
    uint32_t index = 0;  ///< index in the set of points
    float distance = 0;
  };

  /// Whether two normals differ by at most 60 degrees.
  static bool same_side(const V3f& a, const V3f& b) { return a.dot(b) >= kMinCosine; }
  static constexpr float kMinCosine = 0.5f;
  static bool before(const Neighbour& a, const Neighbour& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.index < b.index;
  }
  /// Returns an upper bound of the squared distances whose rounded root is at most `distance`.
  static float farthest(float distance) { return distance * distance * 1.000001f; }
  /// Inserts a point in the sorted list of the `count` nearest ones, of which no more than `wanted` are kept.
  static void insert(const Neighbour& point, int wanted, Neighbour* nearest, int& count) {
    if (count < wanted) ++count;
    int at = count - 1;
    for (; at > 0 && before(point, nearest[at - 1]); --at) nearest[at] = nearest[at - 1];
    nearest[at] = point;
  }

  RootGrid() = default;
  /// `positions` and `normals` describe the points. `radius` is the max distance of searches.
  RootGrid(std::vector<V3f> positions, std::vector<V3f> normals, float radius);

  size_t size() const { return positions_.size(); }
  const V3f& position(size_t i) const { return positions_[i]; }
  const V3f& normal(size_t i) const { return normals_[i]; }
  float radius() const { return radius_; }

  /// Finds the nearest point within the radius; of several nearest points, the one with the lowest index.
  /// Returns false when there is none.
  bool nearest(const V3f& position, const V3f& normal, Neighbour& result) const;
  /// Writes the nearest points within the radius to `result`, at most `wanted`, nearest first. Returns their
  /// count.
  int nearest(const V3f& position, const V3f& normal, int wanted, Neighbour* result) const;
  /// The same among the points for which accept(index) returns true.
  template <class Accept>
  bool nearest_if(const V3f& position, const V3f& normal, Neighbour& result, const Accept& accept) const;
  template <class Accept>
  int nearest_if(const V3f& position, const V3f& normal, int wanted, Neighbour* result,
                 const Accept& accept) const;
  size_t bytes() const;
  /// Upper bound of bytes() divided by the number of points.
  static constexpr size_t kMaxBytesPerPlace = 2 * sizeof(V3f) + 5 * sizeof(uint32_t);

  /// Calls visit(index) for every point within `distance`, which must not exceed the radius, and for some
  /// that are a bit farther away, on all sides, in a fixed but arbitrary order.
  template <class Visit>
  void for_each_within(const V3f& position, float distance, const Visit& visit) const;

  /// Calls visit(index, squared distance) for every point within the radius, in a fixed but arbitrary order.
  template <class Visit>
  void for_each_near(const V3f& position, const V3f& normal, const Visit& visit) const;

 private:
  /// Calls look(x, y, z) for the cells within the radius whose squared distance is at most limit(), which may
  /// fall in the meantime.
  template <class Limit, class Look>
  void for_each_cell(const V3f& position, const Limit& limit, const Look& look) const;
  /// Calls look(index, squared distance) for all points in the bucket of a cell. Several cells may share a
  /// bucket: is_in() tells points of other cells.
  template <class Look>
  void for_each_in_bucket(const V3f& position, int64_t x, int64_t y, int64_t z, const Look& look) const;
  size_t bucket(int64_t x, int64_t y, int64_t z) const;
  int64_t cell(float coordinate) const {
    // std::floor() is slow without SSE 4.1.
    const double at = static_cast<double>(coordinate) * inverse_cell_;
    const auto toward_zero = static_cast<int64_t>(at);
    return toward_zero - (at < static_cast<double>(toward_zero) ? 1 : 0);
  }
  bool is_in(const V3f& p, int64_t x, int64_t y, int64_t z) const {
    return cell(p.x) == x && cell(p.y) == y && cell(p.z) == z;
  }
  /// Lower bound of the squared distance, in this coordinate, from a place to points of a cell. The margin
  /// exceeds the rounding of this function and of squared distances in float.
  double squared_gap(float coordinate, int64_t cell) const {
    const double at = static_cast<double>(coordinate) * inverse_cell_, low = static_cast<double>(cell);
    const double gap = std::max({low - at, at - (low + 1), 0.0}) * ((1 - 1e-5) * cell_);
    return gap * gap;
  }

  float radius_ = 0;
  float inverse_cell_ = 0;
  double cell_ = 0;  // size of a cell
  std::vector<V3f> positions_;
  std::vector<V3f> normals_;
  std::vector<uint32_t> first_;  // first item of each bucket; one more entry at the end
  std::vector<uint32_t> items_;
};

template <class Look>
void RootGrid::for_each_in_bucket(const V3f& position, int64_t x, int64_t y, int64_t z,
                                  const Look& look) const {
  const size_t b = bucket(x, y, z);
  for (uint32_t k = first_[b]; k < first_[b + 1]; ++k) {
    const uint32_t i = items_[k];
    const V3f d = positions_[i] - position;
    look(i, d.dot(d));
  }
}

template <class Visit>
void RootGrid::for_each_near(const V3f& position, const V3f& normal, const Visit& visit) const {
  if (positions_.empty()) return;
  const int64_t x0 = cell(position.x - radius_), x1 = cell(position.x + radius_);
  const int64_t y0 = cell(position.y - radius_), y1 = cell(position.y + radius_);
  const int64_t z0 = cell(position.z - radius_), z1 = cell(position.z + radius_);
  for (int64_t z = z0; z <= z1; ++z) {
    for (int64_t y = y0; y <= y1; ++y) {
      for (int64_t x = x0; x <= x1; ++x) {
        for_each_in_bucket(position, x, y, z, [&](uint32_t i, float distance2) {
          if (distance2 > radius_ * radius_ || !same_side(normals_[i], normal)) return;
          if (is_in(positions_[i], x, y, z)) visit(i, distance2);
        });
      }
    }
  }
}

template <class Limit, class Look>
void RootGrid::for_each_cell(const V3f& position, const Limit& limit, const Look& look) const {
  // Begins with the cell of the query. What is found there is mostly nearer than other cells, so they are
  // left out.
  const int64_t x = cell(position.x), y = cell(position.y), z = cell(position.z);
  look(x, y, z);
  const int64_t x0 = cell(position.x - radius_), x1 = cell(position.x + radius_);
  const int64_t y0 = cell(position.y - radius_), y1 = cell(position.y + radius_);
  const int64_t z0 = cell(position.z - radius_), z1 = cell(position.z + radius_);
  for (int64_t k = z0; k <= z1; ++k) {
    const double dz = squared_gap(position.z, k);
    if (dz > limit()) continue;
    for (int64_t j = y0; j <= y1; ++j) {
      const double dzy = dz + squared_gap(position.y, j);
      if (dzy > limit()) continue;
      for (int64_t i = x0; i <= x1; ++i) {
        if ((i == x && j == y && k == z) || dzy + squared_gap(position.x, i) > limit()) continue;
        look(i, j, k);
      }
    }
  }
}

template <class Visit>
void RootGrid::for_each_within(const V3f& position, float distance, const Visit& visit) const {
  if (positions_.empty()) return;
  const float far = distance * distance * 1.0001f;
  const auto limit = [&] { return static_cast<double>(far); };
  for_each_cell(position, limit, [&](int64_t x, int64_t y, int64_t z) {
    for_each_in_bucket(position, x, y, z, [&](uint32_t i, float distance2) {
      if (distance2 <= far && is_in(positions_[i], x, y, z)) visit(i);
    });
  });
}

template <class Accept>
bool RootGrid::nearest_if(const V3f& position, const V3f& normal, Neighbour& result,
                          const Accept& accept) const {
  if (positions_.empty()) return false;
  float best = radius_ * radius_;
  bool found = false;
  const auto limit = [&] { return static_cast<double>(best); };
  for_each_cell(position, limit, [&](int64_t x, int64_t y, int64_t z) {
    for_each_in_bucket(position, x, y, z, [&](uint32_t i, float distance2) {
      if (distance2 > best || (found && distance2 == best && i > result.index)) return;
      if (!same_side(normals_[i], normal) || !is_in(positions_[i], x, y, z) || !accept(i)) return;
      found = true;
      best = distance2;
      result.index = i;
    });
  });
  result.distance = std::sqrt(found ? best : 0.0f);
  return found;
}

template <class Accept>
int RootGrid::nearest_if(const V3f& position, const V3f& normal, int wanted, Neighbour* result,
                         const Accept& accept) const {
  if (positions_.empty()) return 0;
  int count = 0;
  float far = radius_ * radius_;  // squared distance beyond which no point is wanted
  const auto limit = [&] { return static_cast<double>(far); };
  for_each_cell(position, limit, [&](int64_t x, int64_t y, int64_t z) {
    for_each_in_bucket(position, x, y, z, [&](uint32_t i, float distance2) {
      if (distance2 > far || !same_side(normals_[i], normal)) return;
      const Neighbour candidate{i, std::sqrt(distance2)};
      if (count == wanted && !before(candidate, result[count - 1])) return;
      if (!is_in(positions_[i], x, y, z) || !accept(i)) return;
      insert(candidate, wanted, result, count);
      if (count == wanted) far = std::min(far, farthest(result[count - 1].distance));
    });
  });
  return count;
}

}  // namespace pelage
