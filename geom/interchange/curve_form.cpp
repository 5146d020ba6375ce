// SPDX-License-Identifier: Apache-2.0
#include "geom/interchange/curve_form.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace pelage {
namespace {

using Basis = CurveForm::Basis;
using Wrap = CurveForm::Wrap;

constexpr uint32_t kPointsPerSegment = 6;

/// Weights of the four vertices of a segment at `t`.
void set_weights(Basis basis, float t, float* w) {
  const float s = 1 - t;
  if (basis == Basis::kBezier) {
    w[0] = s * s * s, w[1] = 3 * s * s * t, w[2] = 3 * s * t * t, w[3] = t * t * t;
  } else if (basis == Basis::kBSpline) {
    w[0] = s * s * s / 6, w[3] = t * t * t / 6;
    w[1] = (4 + t * t * (3 * t - 6)) / 6, w[2] = (4 + s * s * (3 * s - 6)) / 6;
  } else {
    w[0] = 0.5f * t * (-1 + t * (2 - t)), w[3] = 0.5f * t * t * (t - 1);
    w[1] = 0.5f * (2 + t * t * (3 * t - 5)), w[2] = 0.5f * t * (1 + t * (4 - 3 * t));
  }
}

/// Adds the phantom vertices of a pinned curve: 2 P0 - P1 before the first one, and likewise at the end.
void add_weight(uint32_t n, int64_t vertex, float weight, float* all) {
  if (vertex < 0) {
    all[0] += 2 * weight, all[1] -= weight;
  } else if (vertex >= static_cast<int64_t>(n)) {
    all[2] += 2 * weight, all[3] -= weight;
  }
}

/// The point at `t` of a segment of a pinned curve: vertices 0, 1, n - 1, n - 2 and the inner ones.
CurvePoint pinned_point(const CurveForm& form, uint32_t n, uint32_t segment, float t) {
  float w[4];
  set_weights(form.basis, t, w);
  std::vector<std::pair<uint32_t, float>> sum;
  const auto add = [&](uint32_t vertex, float weight) {
    for (auto& [known, total] : sum) {
      if (known == vertex) {
        total += weight;
        return;
      }
    }
    sum.emplace_back(vertex, weight);
  };
  for (int k = 0; k < 4; ++k) {
    const int64_t vertex = int64_t{segment} + k - 1;
    if (vertex >= 0 && vertex < static_cast<int64_t>(n)) {
      add(static_cast<uint32_t>(vertex), w[k]);
      continue;
    }
    float ends[4] = {0, 0, 0, 0};
    add_weight(n, vertex, w[k], ends);
    add(vertex < 0 ? 0 : n - 1, ends[0] + ends[2]);
    add(vertex < 0 ? 1 : n - 2, ends[1] + ends[3]);
  }
  CurvePoint point;
  point.weight[0] = 0;
  for (size_t k = 0; k < std::min<size_t>(4, sum.size()); ++k) {
    point.vertex[k] = sum[k].first;
    point.weight[k] = sum[k].second;
  }
  return point;
}

}  // namespace

std::optional<CurveBasis> CurveForm::native() const {
  if (!cubic) return CurveBasis::kLinear;
  if (basis == Basis::kBSpline)
    return wrap == Wrap::kPinned ? CurveBasis::kPinnedBSpline : CurveBasis::kBSpline;
  if (basis == Basis::kCatmullRom && wrap == Wrap::kPinned) return CurveBasis::kCatmullRom;
  return {};
}

uint32_t CurveForm::segments(uint32_t n) const {
  if (!cubic) return wrap == Wrap::kPeriodic ? (n >= 3 ? n : 0) : (n >= 2 ? n - 1 : 0);
  if (basis == Basis::kBezier) {
    if (wrap == Wrap::kPeriodic) return n >= 3 ? n / 3 : 0;
    return n >= 4 ? (n - 1) / 3 : 0;
  }
  if (wrap == Wrap::kPinned) return n >= 2 ? n - 1 : 0;
  if (wrap == Wrap::kPeriodic) return n >= 3 ? n : 0;
  return n >= 4 ? n - 3 : 0;
}

uint32_t CurveForm::varying(uint32_t n) const {
  const uint32_t count = segments(n);
  return count == 0 ? 0 : wrap == Wrap::kPeriodic ? count : count + 1;
}

uint32_t CurveForm::points(uint32_t n, bool resample) const {
  const uint32_t count = segments(n);
  if (count == 0) return 0;
  if (resample) return kPointsPerSegment * count + 1;
  if (wrap != Wrap::kPeriodic) return n;
  return n + (cubic ? 3 : 1);
}

CurvePoint curve_point(const CurveForm& form, uint32_t n, uint32_t i, bool resample) {
  const bool periodic = form.wrap == Wrap::kPeriodic;
  const uint32_t varying = form.varying(n);
  CurvePoint point;
  uint32_t segment = 0;
  float t = 0;
  if (resample) {
    segment = std::min(i / kPointsPerSegment, form.segments(n) - 1);
    t = static_cast<float>(i - segment * kPointsPerSegment) / kPointsPerSegment;
    if (!form.cubic) {
      point.vertex[0] = segment, point.vertex[1] = (segment + 1) % n;
      point.weight[0] = 1 - t, point.weight[1] = t;
    } else if (form.wrap == Wrap::kPinned) {
      point = pinned_point(form, n, segment, t);
    } else {
      set_weights(form.basis, t, point.weight);
      const uint32_t step = form.basis == Basis::kBezier ? 3 : 1;
      for (uint32_t k = 0; k < 4; ++k) point.vertex[k] = (segment * step + k) % n;
    }
  } else {
    point.vertex[0] = i % n;
    // The first vertex of a B-spline without phantom vertices is before its first segment.
    segment = i;
    if (form.cubic && form.wrap != Wrap::kPinned) segment = i == 0 ? (periodic ? n - 1 : 0) : i - 1;
  }
  if (varying == 0) return point;
  if (periodic) {
    point.varying[0] = segment % varying, point.varying[1] = (segment + 1) % varying;
  } else {
    point.varying[0] = std::min(segment, varying - 1), point.varying[1] = std::min(segment + 1, varying - 1);
  }
  point.along = t;
  return point;
}

}  // namespace pelage
