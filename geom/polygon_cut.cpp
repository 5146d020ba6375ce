// SPDX-License-Identifier: Apache-2.0
#include "geom/polygon_cut.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace pelage {

namespace {

/// Twice the area of a polygon, as a vector along its normal (Newell's sum).
V3d area_vector(std::span<const V3f> corners) {
  V3d sum(0);
  const V3d first(corners[0]);
  for (size_t i = 1; i + 1 < corners.size(); ++i)
    sum += (V3d(corners[i]) - first).cross(V3d(corners[i + 1]) - first);
  return sum;
}

class EarCutter {
 public:
  EarCutter(std::span<const uint32_t> vertices, std::span<const V3f> corners)
      : vertices_(vertices), corners_(corners), normal_(area_vector(corners)), left_(corners.size()) {
    std::iota(left_.begin(), left_.end(), 0u);
  }

  void cut(std::vector<uint32_t>& triangles) {
    while (left_.size() > 3) {
      const size_t ear = best_ear();
      if (ear == left_.size()) break;
      add(before(ear), left_[ear], after(ear), triangles);
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    for (size_t i = 1; i + 1 < left_.size(); ++i) add(left_[0], left_[i], left_[i + 1], triangles);
  }

 private:
  V3d at(uint32_t corner) const { return V3d(corners_[corner]); }
  uint32_t before(size_t i) const { return left_[(i + left_.size() - 1) % left_.size()]; }
  uint32_t after(size_t i) const { return left_[(i + 1) % left_.size()]; }

  /// Area relative to the polygon's normal: negative for inverted triangles.
  double area(uint32_t a, uint32_t b, uint32_t c) const {
    return (at(b) - at(a)).cross(at(c) - at(a)).dot(normal_);
  }

  bool is_ear(size_t i) const {
    const uint32_t a = before(i), b = left_[i], c = after(i);
    if (!(area(a, b, c) > 0)) return false;
    return std::none_of(left_.begin(), left_.end(), [&](uint32_t p) {
      const uint32_t v = vertices_[p];
      if (v == vertices_[a] || v == vertices_[b] || v == vertices_[c]) return false;
      return area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0;
    });
  }

  /// The ear with the shortest cut, or left_.size() where there is none because the polygon intersects itself
  /// or has no area.
  size_t best_ear() const {
    size_t best = left_.size();
    double shortest = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < left_.size(); ++i) {
      const double length = (at(after(i)) - at(before(i))).length2();
      if (!(length < shortest) || !is_ear(i)) continue;
      best = i;
      shortest = length;
    }
    return best;
  }

  void add(uint32_t a, uint32_t b, uint32_t c, std::vector<uint32_t>& triangles) const {
    const uint32_t va = vertices_[a], vb = vertices_[b], vc = vertices_[c];
    if (va != vb && vb != vc && vc != va) triangles.insert(triangles.end(), {a, b, c});
  }

  std::span<const uint32_t> vertices_;
  std::span<const V3f> corners_;
  const V3d normal_;
  std::vector<uint32_t> left_;  // corners that are not cut off yet
};

}  // namespace

void cut_polygon(std::span<const uint32_t> vertices, std::span<const V3f> corners,
                 std::vector<uint32_t>& triangles) {
  EarCutter(vertices, corners).cut(triangles);
}

}  // namespace pelage
