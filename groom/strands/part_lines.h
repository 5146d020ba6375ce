// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "base/vector.h"

namespace pelage {

class LimitSurface;
class SkinBinding;
struct Job;

/// Lines on the rest skin from which hair falls both ways. Queries ignore lines whose skin normal differs by
/// more than 60 degrees from that of the query, such as a line on the other side of a thin ear. Immutable.
/// Thread safety: const members may be called from any thread.
class PartLines {
 public:
  static constexpr size_t kMaxSegments = 10000;

  /// The nearest point of the lines, as a root sees it.
  struct Nearest {
    float distance = 0;  ///< from the root
    /// Unit vector from the line to the root, across the line. At the line itself, its normal along the skin.
    V3f away{0};
    /// 1 beside the line; falls to 0 for roots that lie beyond an end, in the direction of the line.
    float beside = 0;
  };

  /// Projects lines, each a list of points in rest space, onto the rest skin. Adds points, so that the lines
  /// follow the skin. A line that ends where it starts is closed. Lines without extent are dropped.
  PartLines(std::span<const std::vector<V3f>> lines, const LimitSurface& rest, const SkinBinding& binding,
            const Job& job);

  size_t segment_count() const { return segments_.size(); }
  /// Max distance of a given point from the skin.
  float off_skin() const { return off_skin_; }
  size_t bytes() const { return segments_.capacity() * sizeof(Segment) + lines_.capacity() * sizeof(Line); }

  /// Returns whether a line passes between the root `a`, with the skin normal `normal`, and the root `b`.
  bool divides(const V3f& a, const V3f& normal, const V3f& b) const;
  /// Finds the nearest line within the distance `limit`. Returns false when there is none.
  bool nearest(const V3f& root, const V3f& normal, float limit, Nearest& result) const;

 private:
  struct Segment {
    V3f from;
    V3f along, side, normal;  // orthonormal
    float length;
    bool starts_line, ends_line;
  };
  struct Line {
    size_t begin, end;  // segments
    Box3f box;
  };
  void add_line(const std::vector<V3f>& points, const std::vector<V3f>& normals, float smallest);

  std::vector<Segment> segments_;
  std::vector<Line> lines_;
  float off_skin_ = 0;
};

/// Returns whether any of these lines passes between two roots.
inline bool divides(std::span<const std::shared_ptr<const PartLines>> parts, const V3f& a, const V3f& normal,
                    const V3f& b) {
  for (const auto& lines : parts) {
    if (lines->divides(a, normal, b)) return true;
  }
  return false;
}

}  // namespace pelage
