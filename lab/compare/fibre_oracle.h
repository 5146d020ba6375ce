// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "render/fibre/fibre_tracer.h"
#include "render/material/material.h"

namespace pelage {

/// Where a fibre sends the light that comes from one inclination, evenly over its width: energy by cells of
/// sin(theta_i) and phi. One colour channel.
class FibreHistogram {
 public:
  static constexpr int kSines = 40, kAzimuths = 72;

  /// `wi` in the frame of FibreFrame: x along the fibre, wo in the half plane of x and y.
  void add(const V3f& wi, double weight);
  double cell(int sine, int azimuth) const { return cells_[index(sine, azimuth)]; }
  double total() const;
  std::vector<double> by_azimuth() const;  ///< from -pi to pi; 0 is where the light came from
  std::vector<double> by_sine() const;     ///< from -1 to 1

 private:
  static size_t index(int sine, int azimuth) { return static_cast<size_t>(sine * kAzimuths + azimuth); }
  std::vector<double> cells_ = std::vector<double>(static_cast<size_t>(kSines) * kAzimuths);
};

/// How far two distributions are from each other, whatever their totals: 0 where they are the same, 1 where
/// one is nothing wherever the other is something.
double total_variation(const std::vector<double>& a, const std::vector<double>& b);

/// A fibre as a model has it, and the same fibre to be traced: what the model is held against.
struct FibreOracle {
  /// The model without tilt, its absorption given.
  MaterialParams params;
  TracedFibre traced;
  float absorption = 0;  ///< of cortex and medulla, per radius
  /// Blur of what a smooth fibre would do, as rough as the model says: deviations in radians for R, TT and
  /// all that is reflected inside. Light that a medulla scattered is not blurred.
  std::array<float, 3> longitudinal{}, azimuthal{};
  bool opaque = false;  ///< light cannot go through the model: the traced fibre is what it stands for

  /// `look` is called now and then meanwhile, and may throw.
  using Look = std::function<void()>;
  FibreHistogram model(
      float theta_o, int samples, const Look& look = [] {}) const;
  FibreHistogram trace(
      float theta_o, int paths, const Look& look = [] {}) const;
};

/// For a fibre material that absorbs so much per radius, or an opaque one that is as bright as a clear fibre
/// which does. `params` must be of a model for fibres.
FibreOracle fibre_oracle(const MaterialParams& params, float absorption);

/// Names of all models for fibres, from the simplest to the most involved, as scenes have them.
const std::vector<std::string>& fibre_model_names();
/// A fibre material of the model of this name, with the colour and opacity of another; that itself where it
/// is of that model. The name must be one of fibre_model_names().
MaterialParams with_fibre_model(const MaterialParams& other, const std::string& model);

}  // namespace pelage
