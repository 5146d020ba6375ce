// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "base/job.h"
#include "lab/compare/fibre_oracle.h"
#include "lab/report/report.h"

namespace pelage {

/// One fibre of a model beside the same fibre traced by brute force, lit from kInclination uniformly over its
/// width and seen from all directions.
struct SingleFibre {
  static constexpr float kInclination = 0.4f;  ///< radians
  static constexpr float kAbsorption = 0.2f;   ///< per radius

  std::string model;
  bool opaque = false;
  FibreHistogram by_model, traced;
  double white_across = 0;   ///< albedo of a fibre without absorption for light across the fibre
  double white_slanted = 0;  ///< the same for light at an inclination of 1 radian

  double azimuth_distance() const;      ///< total variation of the distributions around the fibre
  double inclination_distance() const;  ///< total variation of the distributions along the fibre
};

/// The result is the same for any number of threads.
SingleFibre compare_single_fibre(const std::string& model, const MaterialParams& material, const Job& job);

/// A row per fibre: the model's map over sin(theta_i) and phi, the same map of the traced light, and a polar
/// plot of both around the fibre.
Picture single_fibre_sheet(const std::vector<SingleFibre>& fibres);

}  // namespace pelage
