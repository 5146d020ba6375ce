// SPDX-License-Identifier: Apache-2.0
#include "geom/io/strand_repair.h"

#include <algorithm>
#include <cmath>

namespace pelage {
namespace {

/// Squares of larger coordinates would overflow in later computations.
constexpr float kFarthest = 1e18f;

bool is_usable(const float* p) {
  return std::abs(p[0]) <= kFarthest && std::abs(p[1]) <= kFarthest && std::abs(p[2]) <= kFarthest;
}

bool is_same(const float* a, const float* b) { return a[0] == b[0] && a[1] == b[1] && a[2] == b[2]; }

/// Moves the values of element `from` to element `to` in every attribute of one frequency.
void move_values(StrandArrays& a, AttributeClass frequency, size_t from, size_t to) {
  for (StrandAttribute& attribute : a.attributes) {
    if (attribute.frequency != frequency) continue;
    const size_t n = static_cast<size_t>(attribute.components);
    std::copy_n(&attribute.values[from * n], n, &attribute.values[to * n]);
  }
}

void truncate_attributes(StrandArrays& a, size_t strands, size_t points) {
  for (StrandAttribute& attribute : a.attributes) {
    const size_t n = static_cast<size_t>(attribute.components);
    if (attribute.frequency == AttributeClass::kPerStrand) attribute.values.resize(strands * n);
    if (attribute.frequency == AttributeClass::kPerPoint) attribute.values.resize(points * n);
    for (float& v : attribute.values) {
      if (!std::isfinite(v)) v = 0;
    }
  }
}

/// Compacts strands and points towards the front of the arrays.
class Repair {
 public:
  Repair(StrandArrays& arrays, float default_width) : a_(arrays), default_radius_(0.5f * default_width) {}

  StrandRepairs run() {
    const size_t strands = a_.ids.size();
    size_t kept = 0;
    uint32_t begin = 0;
    for (size_t s = 0; s < strands; ++s) {
      const uint32_t end = a_.first_point[s + 1];  // read before it may be overwritten
      if (!has_extent(begin, end) || !keep(s, begin, end, kept)) {
        ++result_.dropped;
      } else {
        ++kept;
      }
      begin = end;
    }
    a_.first_point.resize(kept + 1);
    a_.ids.resize(kept);
    if (!a_.root_uv.empty()) a_.root_uv.resize(kept);
    a_.points.resize(size_t(points_) * 4);
    truncate_attributes(a_, kept, points_);
    return result_;
  }

 private:
  /// All points finite, at least two of them different.
  bool has_extent(uint32_t begin, uint32_t end) const {
    bool differs = false;
    for (uint32_t i = begin; i < end; ++i) {
      const float* p = &a_.points[size_t(i) * 4];
      if (!is_usable(p)) return false;
      differs |= !is_same(p, &a_.points[size_t(begin) * 4]);
    }
    return differs;
  }

  /// Copies the strand after those kept so far; false when it has too few points left.
  bool keep(size_t strand, uint32_t begin, uint32_t end, size_t kept) {
    const uint32_t first = points_;
    bool repaired = false, has_width = false;
    for (uint32_t i = begin; i < end; ++i) {
      float* p = &a_.points[size_t(i) * 4];
      const bool repeats = points_ > first && is_same(p, &a_.points[size_t(points_ - 1) * 4]);
      if (repeats && a_.basis != CurveBasis::kBSpline) {
        repaired = true;
        continue;
      }
      float r = p[3];
      if (!(r >= 0 && r <= kFarthest)) {
        r = 0;
        repaired = true;
      }
      has_width |= r > 0;
      float* to = &a_.points[size_t(points_) * 4];
      std::copy_n(p, 3, to);
      to[3] = r;
      move_values(a_, AttributeClass::kPerPoint, i, points_);
      ++points_;
    }
    if (segment_count(a_.basis, points_ - first) == 0) {
      points_ = first;
      return false;
    }
    if (!has_width) {
      for (uint32_t i = first; i < points_; ++i) a_.points[size_t(i) * 4 + 3] = default_radius_;
      repaired = true;
    }
    a_.first_point[kept + 1] = points_;
    a_.ids[kept] = a_.ids[strand];
    if (!a_.root_uv.empty()) a_.root_uv[kept] = a_.root_uv[strand];
    move_values(a_, AttributeClass::kPerStrand, strand, kept);
    result_.repaired += repaired;
    return true;
  }

  StrandArrays& a_;
  float default_radius_;
  uint32_t points_ = 0;  ///< kept so far
  StrandRepairs result_;
};

}  // namespace

StrandRepairs repair_strands(StrandArrays& arrays, float default_width) {
  return Repair(arrays, default_width).run();
}

float assumed_width(const StrandArrays& arrays) { return assumed_width(usable_box(arrays)); }

float assumed_width(const Box3f& box) {
  const V3f size = box.isEmpty() ? V3f(1) : box.size();
  const float largest = std::max({size.x, size.y, size.z});
  return largest > 0 ? 1e-3f * largest : 1e-3f;
}

Box3f usable_box(const StrandArrays& arrays) {
  Box3f box;
  for (size_t i = 0; i < arrays.points.size(); i += 4) {
    const float* p = &arrays.points[i];
    if (is_usable(p)) box.extendBy(V3f(p[0], p[1], p[2]));
  }
  return box;
}

}  // namespace pelage
