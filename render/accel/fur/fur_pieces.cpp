// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numeric>

#include "render/accel/fur/fur_topology.h"

namespace pelage {
namespace {

constexpr int kMaxCuts = 3;  // levels of halving: eight pieces at most

Four as_four(const std::array<float, 4>& p) { return Four{p[0], p[1], p[2], p[3]}; }

struct Hull {
  Four low = four(0), high = four(0);
  float area() const {
    const Four d = high - low;
    return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
  }
};

struct Bezier {
  Four p[4];  // x, y, z, radius

  explicit Bezier(const SnappedSegment& segment) {
    for (size_t i = 0; i < 4; ++i) p[i] = as_four(segment[i]);
  }
  Bezier() = default;

  Hull hull() const {
    Hull result;
    for (size_t i = 0; i < 4; ++i) {
      const Four radius = four(p[i][3]);
      const Four low = p[i] - radius, high = p[i] + radius;
      result.low = i == 0 ? low : smaller(result.low, low);
      result.high = i == 0 ? high : larger(result.high, high);
    }
    return result;
  }

  void halve(Bezier& left, Bezier& right) const {
    const Four half = four(0.5f);
    const Four a = (p[0] + p[1]) * half, b = (p[1] + p[2]) * half, c = (p[2] + p[3]) * half;
    const Four ab = (a + b) * half, bc = (b + c) * half, middle = (ab + bc) * half;
    left = Bezier(), right = Bezier();
    left.p[0] = p[0], left.p[1] = a, left.p[2] = ab, left.p[3] = middle;
    right.p[0] = middle, right.p[1] = bc, right.p[2] = c, right.p[3] = p[3];
  }
};

/// One segment, or a part of it, at all motion keys.
using Moving = std::vector<Bezier>;

Hull mean_hull(const Moving& part) {
  Hull mean;
  for (const Bezier& curve : part) {
    const Hull hull = curve.hull();
    mean.low = mean.low + hull.low, mean.high = mean.high + hull.high;
  }
  const Four share = four(1.0f / static_cast<float>(part.size()));
  return {mean.low * share, mean.high * share};
}

void add_parts(const Moving& part, CurvePart name, int cuts, std::vector<FurPiece>& pieces) {
  if (cuts == 0) {
    const Hull hull = mean_hull(part);
    pieces.emplace_back(hull.low, hull.high, name);
    return;
  }
  Moving left(part.size()), right(part.size());
  for (size_t key = 0; key < part.size(); ++key) part[key].halve(left[key], right[key]);
  add_parts(left, {name.number, 2 * name.part}, cuts - 1, pieces);
  add_parts(right, {name.number, 2 * name.part + 1}, cuts - 1, pieces);
}

/// Area saved by halving a segment.
float saving(const Moving& part) {
  Moving left(part.size()), right(part.size());
  for (size_t key = 0; key < part.size(); ++key) part[key].halve(left[key], right[key]);
  return mean_hull(part).area() - 0.5f * (mean_hull(left).area() + mean_hull(right).area());
}

class Cutter {
 public:
  Cutter(const SnappedStrands& strands, const FurFrame& frame) : strands_(strands), frame_(frame) {}

  /// Reads all keys of a segment; false when it cannot be rendered.
  bool read(SnappedStrands::Place place, Moving& part) const {
    part.clear();
    for (int key = 0; key < strands_.motion_keys(); ++key) {
      const SnappedSegment segment = strands_.segment(place, key);
      if (!SnappedStrands::is_drawable(segment)) return false;
      part.emplace_back(frame_(segment));
    }
    return true;
  }

  /// Number of halvings of each segment that saves most area, with at most `budget` additional pieces.
  std::vector<uint8_t> choose_cuts(size_t budget) const {
    struct Gain {
      float area;
      uint32_t number;
    };
    std::vector<Gain> gains;
    Moving part;
    strands_.for_each_segment([&](uint32_t number, SnappedStrands::Place place) {
      if (read(place, part)) gains.push_back({saving(part), number});
    });
    std::sort(gains.begin(), gains.end(), [](const Gain& a, const Gain& b) {
      return a.area != b.area ? a.area > b.area : a.number < b.number;
    });
    std::vector<uint8_t> cuts(strands_.segment_count());
    // Halving reduces the remaining gain to about a fourth: the longest segments are halved again if their
    // gain is that much larger than the others'.
    for (size_t i = 0, used = 0; i < gains.size() && used < budget; ++i) {
      int levels = 1;
      const float typical = gains[gains.size() / 2].area;
      for (float left = gains[i].area / 4; levels < kMaxCuts && left > 4 * typical; left /= 4) ++levels;
      const size_t extra = (size_t(1) << levels) - 1;
      if (gains[i].area <= 0 || used + extra > budget) break;
      cuts[gains[i].number] = static_cast<uint8_t>(levels);
      used += extra;
    }
    return cuts;
  }

 private:
  const SnappedStrands& strands_;
  const FurFrame& frame_;
};

}  // namespace

SnappedSegment part_of(const SnappedSegment& segment, uint32_t part) {
  if (part == 1) return segment;
  Bezier left, right;
  Bezier(part_of(segment, part / 2)).halve(left, right);
  const Bezier& half = part % 2 == 0 ? left : right;
  SnappedSegment result;
  for (size_t i = 0; i < 4; ++i) {
    for (size_t j = 0; j < 4; ++j) result[i][j] = half.p[i][j];
  }
  return result;
}

std::vector<FurPiece> make_pieces(const SnappedStrands& strands, float cuts, const FurFrame& frame) {
  const Cutter cutter(strands, frame);
  const size_t budget = piece_count_bound(strands.segment_count(), cuts) - strands.segment_count();
  const std::vector<uint8_t> levels = budget > 0 ? cutter.choose_cuts(budget) : std::vector<uint8_t>();
  std::vector<FurPiece> pieces;
  pieces.reserve(strands.segment_count() + budget);
  Moving part;
  strands.for_each_segment([&](uint32_t number, SnappedStrands::Place place) {
    if (cutter.read(place, part)) add_parts(part, {number, 1}, levels.empty() ? 0 : levels[number], pieces);
  });
  return pieces;
}

}  // namespace pelage
