// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "base/job.h"
#include "lab/compare/fibre_oracle.h"
#include "lab/report/report.h"

namespace pelage {

/// One fibre of a model, and the same fibre traced by brute force. The light arrives at the inclination
/// kInclination, spread uniformly over the width of the fibre. The fibre is seen from all directions.
struct SingleFibre {
  static constexpr float kInclination = 0.4f;  ///< inclination of the light, radians
  static constexpr float kAbsorption = 0.2f;   ///< absorption of the fibre, per radius

  std::string model;
  bool opaque = false;
  FibreHistogram by_model, traced;
  double white_across = 0;   ///< albedo of a fibre without absorption for light across the fibre
  double white_slanted = 0;  ///< albedo of a fibre without absorption for light at an inclination of 1 radian

  double azimuth_distance() const;      ///< total variation between the two distributions around the fibre
  double inclination_distance() const;  ///< total variation between the two distributions along the fibre
};

/// Compares a model with brute-force tracing. The result is the same for any number of threads.
SingleFibre compare_single_fibre(const std::string& model, const MaterialParams& material, const Job& job);

/// Returns a picture with one row per fibre. A row has a map of the model's energy over sin(theta_i) and phi,
/// the same map for the traced fibre, and a polar plot of both distributions around the fibre.
Picture single_fibre_sheet(const std::vector<SingleFibre>& fibres);

}  // namespace pelage
