// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/light/direct_light_test.cpp.
#pragma once

namespace pelage {

/// Weight of a sample drawn with density `pdf` that another technique could have drawn with density `other`;
/// both per solid angle, one sample of each [Veach97, section 9.2.2]. Zero when `pdf` is zero.
inline float balance_weight(float pdf, float other) { return pdf > 0 ? pdf / (pdf + other) : 0.0f; }

/// The power heuristic with exponent 2 [Veach97, section 9.2.3], written so that squares cannot overflow.
inline float power_weight(float pdf, float other) {
  if (!(pdf > 0)) return 0.0f;
  const float ratio = other / pdf;
  return 1.0f / (1.0f + ratio * ratio);
}

}  // namespace pelage
