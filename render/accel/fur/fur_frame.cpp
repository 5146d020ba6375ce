// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/fur_frame.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/hash.h"
#include "render/accel/fur/fur_node.h"

namespace pelage {
namespace {

constexpr uint32_t kSamples = 512;  // number of segments
constexpr int kSpins = 8;           // angles over a quarter turn
constexpr int kSteps = 32;          // iterations towards the common direction
// Rays enter a rotated tree slightly more slowly. The boxes of four segments shrink by half as much as the
// boxes of single segments: by an eighth or more at this ratio.
constexpr double kWorth = 0.7;

using Samples = std::vector<SnappedSegment>;

/// One segment out of each group, selected by hash: at regular steps, strands with that number of segments
/// would always contribute the same one, such as their roots, which may be combed differently from the rest.
Samples samples_of(const SnappedStrands& strands) {
  Samples samples;
  const uint64_t count = strands.segment_count(), max = std::min<uint64_t>(count, kSamples);
  samples.reserve(max);
  for (uint64_t i = 0; i < max; ++i) {
    const uint64_t first = i * count / max, end = (i + 1) * count / max;
    const auto number = static_cast<uint32_t>(first + hash64(i, random_use("fur frame")) % (end - first));
    const SnappedSegment segment = strands.segment(strands.locate(number), 0);
    if (SnappedStrands::is_visible(segment)) samples.push_back(segment);
  }
  return samples;
}

double box_area(const Samples& samples, const FurFrame& frame) {
  double sum = 0;
  for (const SnappedSegment& sample : samples) {
    const SnappedSegment segment = frame(sample);
    FurBox box;
    for (const auto& p : segment) {
      for (size_t axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::min(box.low[axis], p[axis] - p[3]);
        box.high[axis] = std::max(box.high[axis], p[axis] + p[3]);
      }
    }
    sum += box.area();
  }
  return sum;
}

/// The direction with most of the chords' squared length, by power iteration.
V3f common_direction(const Samples& samples) {
  double m[3][3] = {};
  for (const SnappedSegment& s : samples) {
    for (size_t a = 0; a < 3; ++a) {
      for (size_t b = 0; b < 3; ++b) m[a][b] += (double(s[3][a]) - s[0][a]) * (double(s[3][b]) - s[0][b]);
    }
  }
  V3d direction(0.36, 0.48, 0.8);
  for (int step = 0; step < kSteps; ++step) {
    V3d next(0);
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) next[a] += m[a][b] * direction[b];
    }
    const double length = next.length();
    if (!(length > 0) || !std::isfinite(length)) break;
    direction = next * (1 / length);
  }
  return V3f(direction);
}

FurFrame frame_along(const V3f& direction, float angle) {
  const V3f a = direction.cross(std::abs(direction.x) < 0.6f ? V3f(1, 0, 0) : V3f(0, 1, 0)).normalized();
  const V3f b = direction.cross(a);
  const V3f first = (std::cos(angle) * a + std::sin(angle) * b).normalized();
  return {{first, direction.cross(first).normalized(), direction}, true};
}

}  // namespace

SnappedSegment FurFrame::operator()(const SnappedSegment& segment) const {
  if (!turned) return segment;
  SnappedSegment result;
  for (size_t i = 0; i < 4; ++i) {
    const V3f p = (*this)(V3f(segment[i][0], segment[i][1], segment[i][2]));
    result[i] = {p.x, p.y, p.z, segment[i][3]};
  }
  return result;
}

FurBox FurFrame::unrotated(const FurBox& box) const {
  if (!turned || box.is_empty()) return box;
  FurBox result;
  for (size_t axis = 0; axis < 3; ++axis) {
    double centre = 0, half = 0, max = 0;
    for (size_t i = 0; i < 3; ++i) {
      const double along = axes[i][static_cast<int>(axis)];
      centre += along * 0.5 * (double(box.low[i]) + box.high[i]);
      half += std::abs(along) * 0.5 * (double(box.high[i]) - box.low[i]);
      max += std::abs(box.low[i]) + std::abs(box.high[i]);
    }
    // Axes are floats, and orthogonal only to their precision.
    half += 0x1p-20 * max;
    result.low[axis] = static_cast<float>(centre - half);
    result.high[axis] = static_cast<float>(centre + half);
  }
  return result;
}

bool FurFrame::is_possible() const {
  constexpr float kNearly = 1e-3f;
  for (size_t i = 0; i < 3; ++i) {
    if (!(std::abs(axes[i].length() - 1) < kNearly)) return false;
    if (!(std::abs(axes[i].dot(axes[(i + 1) % 3])) < kNearly)) return false;
  }
  return true;
}

FurFrame choose_frame(const SnappedStrands& strands, FurRotation rotation) {
  if (rotation == FurRotation::kNever || strands.motion_keys() > 1) return {};
  const Samples samples = samples_of(strands);
  const V3f direction = common_direction(samples);
  FurFrame best;
  const double aligned = box_area(samples, best);
  double min = rotation == FurRotation::kAlways ? INFINITY : kWorth * aligned;
  for (int spin = 0; spin < kSpins; ++spin) {
    const FurFrame frame =
        frame_along(direction, std::numbers::pi_v<float> / 2 * static_cast<float>(spin) / kSpins);
    const double area = box_area(samples, frame);
    if (area < min) min = area, best = frame;
  }
  return best;
}

}  // namespace pelage
