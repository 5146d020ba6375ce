// SPDX-License-Identifier: Apache-2.0
#include "groom/strands/resample.h"

#include <algorithm>

#include "geom/curve.h"

namespace pelage {
namespace {

/// The strand as a polyline that is fine enough for measuring it.
std::vector<V3f> trace(const Strands& strands, size_t strand) {
  constexpr int kSteps = 8;
  std::vector<V3f> line;
  const uint32_t segments = segment_count(strands.basis(), strands.strand_points(strand));
  for (uint32_t k = 0; k < segments; ++k) {
    const CubicSegment segment = bezier_segment(strands, strand, k);
    for (int i = k == 0 ? 0 : 1; i <= kSteps; ++i) {
      line.push_back(curve_position(segment, static_cast<float>(i) / kSteps));
    }
  }
  return line;
}

std::vector<V3f> at_even_arcs(const std::vector<V3f>& line, int count) {
  std::vector<float> arc(line.size(), 0.0f);
  for (size_t i = 1; i < line.size(); ++i) arc[i] = arc[i - 1] + (line[i] - line[i - 1]).length();
  std::vector<V3f> result;
  size_t segment = 0;
  for (int i = 0; i < count; ++i) {
    const float wanted = arc.back() * static_cast<float>(i) / static_cast<float>(count - 1);
    while (segment + 2 < line.size() && arc[segment + 1] < wanted) ++segment;
    const float length = arc[segment + 1] - arc[segment];
    const float t = length > 0 ? std::clamp((wanted - arc[segment]) / length, 0.0f, 1.0f) : 0.0f;
    result.push_back(line[segment] + (line[segment + 1] - line[segment]) * t);
  }
  return result;
}

}  // namespace

std::vector<V3f> resample_strand(const Strands& strands, size_t strand, int count) {
  const std::vector<V3f> through = at_even_arcs(trace(strands, strand), count);
  // The ends are interpolated by construction; inside, solves (P[i-1] + 4 P[i] + P[i+1]) / 6 = Q[i] by
  // elimination (Thomas).
  std::vector<V3f> points = through;
  const size_t last = points.size() - 1;
  std::vector<float> upper(points.size(), 0.0f);
  for (size_t i = 1; i < last; ++i) {
    const float below = i > 1 ? upper[i - 1] : 0.0f;
    const float pivot = 1.0f / (4.0f - below);
    upper[i] = pivot;
    V3f right = through[i] * 6.0f - points[i - 1];
    if (i + 1 == last) right -= through[last];
    points[i] = right * pivot;
  }
  for (size_t i = last; i-- > 1;) {
    if (i + 1 < last) points[i] -= points[i + 1] * upper[i];
  }
  return points;
}

}  // namespace pelage
