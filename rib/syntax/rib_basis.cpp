// SPDX-License-Identifier: Apache-2.0
#include "rib/syntax/rib_basis.h"

namespace pelage {
namespace {

RibBasis make(RibBasis::Kind kind, int step, float scale, const float (&m)[16]) {
  RibBasis basis;
  basis.kind = kind;
  basis.step = step;
  for (int i = 0; i < 16; ++i) basis.matrix[i / 4][i % 4] = m[i] * scale;
  return basis;
}

std::array<float, 4> row_times(const std::array<float, 4>& row, const M44f& matrix) {
  std::array<float, 4> out{};
  for (size_t j = 0; j < 4; ++j) {
    for (size_t i = 0; i < 4; ++i) out[j] += row[i] * matrix.x[i][j];
  }
  return out;
}

}  // namespace

std::optional<RibBasis> RibBasis::named(std::string_view name) {
  using K = Kind;
  if (name == "bezier") return make(K::kBezier, 3, 1, {-1, 3, -3, 1, 3, -6, 3, 0, -3, 3, 0, 0, 1, 0, 0, 0});
  if (name == "b-spline")
    return make(K::kBSpline, 1, 1.0f / 6, {-1, 3, -3, 1, 3, -6, 3, 0, -3, 0, 3, 0, 1, 4, 1, 0});
  if (name == "catmull-rom")
    return make(K::kCatmullRom, 1, 0.5f, {-1, 3, -3, 1, 2, -5, 4, -1, -1, 0, 1, 0, 0, 2, 0, 0});
  if (name == "hermite") return make(K::kOther, 2, 1, {2, 1, -2, 1, -3, -2, 3, -1, 0, 1, 0, 0, 1, 0, 0, 0});
  if (name == "power") return make(K::kOther, 4, 1, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  return {};
}

uint32_t RibBasis::segments(uint32_t points, bool periodic) const {
  const auto by = static_cast<uint32_t>(step);
  if (points < (periodic ? 3u : 4u)) return 0;
  if (periodic) return points % by == 0 ? points / by : 0;
  return (points - 4) % by == 0 ? (points - 4) / by + 1 : 0;
}

std::array<float, 4> RibBasis::weights(float t) const { return row_times({t * t * t, t * t, t, 1}, matrix); }

std::array<float, 4> RibBasis::derivative_weights(float t) const {
  return row_times({3 * t * t, 2 * t, 1, 0}, matrix);
}

}  // namespace pelage
