// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace pelage {

// The Wigner semicircle distribution on [-1, 1], p(u) = (2 / pi) sqrt(1 - u^2): the density of cos(Theta) of
// a diffuse fibre, and "the optimal choice" for sampling the cone-shell model [Neulander13].

inline float wigner_pdf(float u) {
  return 2.0f / std::numbers::pi_v<float> * std::sqrt(std::max(0.0f, (1.0f - u) * (1.0f + u)));
}

/// Returns the cumulative distribution F(u) = 1/2 + (u sqrt(1 - u^2) + asin u) / pi.
double wigner_cdf(double u);

/// Inverts F with a table. F^-1 has no closed form. It has infinite slope at both ends: near xi = 0, 1 + u
/// grows as xi^(2/3). The table divides each octave of min(xi, 1 - xi) into eight cells, and the bits of this
/// float select the cell. Each cell has a cubic polynomial. The error of u is 5e-7 of the distance from u to
/// the nearer end of [-1, 1]. The density of the samples equals wigner_pdf() with the same accuracy.
class WignerTable {
 public:
  /// Returns the only table, which is constructed at the first call. Thread safety: any thread.
  static const WignerTable& instance();

  /// Returns u with F(u) = xi, for xi in [0, 1).
  float sample(float xi) const {
    const bool upper = xi >= 0.5f;
    const float tail = std::max(upper ? 1.0f - xi : xi, kSmallest);
    const uint32_t bits = std::bit_cast<uint32_t>(tail);
    const Cell& cell = cells_[(bits >> kCellShift) - kFirstCell];
    const float t = static_cast<float>(bits & kFractionMask) * kFractionScale;
    const float from_end = cell[0] + t * (cell[1] + t * (cell[2] + t * cell[3]));
    return upper ? 1.0f - from_end : from_end - 1.0f;
  }

 private:
  WignerTable();

  using Cell = std::array<float, 4>;  ///< cubic of 1 + u over the position within the cell
  static constexpr int kCellShift = 20;
  static constexpr uint32_t kFractionMask = (1u << kCellShift) - 1;
  static constexpr float kFractionScale = 1.0f / (1u << kCellShift);
  static constexpr float kSmallest = 0x1p-25f;  ///< half the smallest positive number of random streams
  static constexpr uint32_t kFirstCell = std::bit_cast<uint32_t>(kSmallest) >> kCellShift;
  static constexpr uint32_t kLastCell = std::bit_cast<uint32_t>(0.5f) >> kCellShift;
  std::array<Cell, kLastCell - kFirstCell + 1> cells_;
};

/// Probability of the constant part of tent_pdf().
inline constexpr float kTentFloor = 0.51f;
/// The piecewise-linear density that the Wigner sampler replaced [Neulander10]. It is flatter than the
/// semicircle. Because its knots were not published, this density is a tent plus a constant, fitted to the
/// semicircle.
inline float tent_pdf(float u) {
  return std::abs(u) > 1.0f ? 0.0f : (1.0f - kTentFloor) * (1.0f - std::abs(u)) + 0.5f * kTentFloor;
}
inline float tent_sample(float xi) {
  const float tail = xi < 0.5f ? xi : 1.0f - xi;
  const float from_end =
      2.0f * tail /
      (0.5f * kTentFloor + std::sqrt(0.25f * kTentFloor * kTentFloor + 2.0f * (1.0f - kTentFloor) * tail));
  return xi < 0.5f ? from_end - 1.0f : 1.0f - from_end;
}

}  // namespace pelage
