// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pelage {

/// Returns the weight, by the balance heuristic, of a sample that one technique takes with density `pdf` and
/// another would take with density `other`. Both densities are per solid angle; each technique takes one
/// sample [Veach97, section 9.2.2]. Returns 0 when `pdf` is 0.
inline float balance_weight(float pdf, float other) { return pdf > 0 ? pdf / (pdf + other) : 0.0f; }

/// Returns the weight of such a sample by the power heuristic with exponent 2 [Veach97, section 9.2.3].
/// Squares the ratio of the densities instead of the densities, so that large densities do not overflow. If
/// the square of the ratio overflows, the weight is 0.
inline float power_weight(float pdf, float other) {
  if (!(pdf > 0)) return 0.0f;
  const float ratio = other / pdf;
  return 1.0f / (1.0f + ratio * ratio);
}

}  // namespace pelage
