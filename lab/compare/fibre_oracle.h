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

/// Distribution of the light that a fibre scatters: energy in cells of sin(theta_i) and phi. The light
/// arrives at one inclination, spread uniformly over the width of the fibre. One colour channel.
class FibreHistogram {
 public:
  static constexpr int kSines = 40, kAzimuths = 72;

  /// Adds the energy `weight` to the cell of the direction `wi`. `wi` is in the frame of FibreFrame: x along
  /// the fibre, and the fixed direction wo in the half plane of x and positive y.
  void add(const V3f& wi, double weight);
  double cell(int sine, int azimuth) const { return cells_[index(sine, azimuth)]; }
  double total() const;
  /// Energy by azimuth, from -pi to pi; the light arrives from azimuth 0.
  std::vector<double> by_azimuth() const;
  std::vector<double> by_sine() const;  ///< energy by sine, from -1 to 1

 private:
  static size_t index(int sine, int azimuth) { return static_cast<size_t>(sine * kAzimuths + azimuth); }
  std::vector<double> cells_ = std::vector<double>(static_cast<size_t>(kSines) * kAzimuths);
};

/// Returns the distance between two distributions after normalisation: 0 when they are equal, 1 when they are
/// disjoint.
double total_variation(const std::vector<double>& a, const std::vector<double>& b);

/// A fibre model and its reference: the same fibre for brute-force tracing.
struct FibreOracle {
  /// Parameters of the model, without tilt and with the given absorption.
  MaterialParams params;
  TracedFibre traced;
  float absorption = 0;  ///< absorption per radius, of cortex and medulla
  /// Standard deviations in radians for R, TT and all internal reflections. The scattering of the traced
  /// fibre, whose surface is smooth, is blurred with these to match the roughness of the model. Light that
  /// the medulla scatters is not blurred.
  std::array<float, 3> longitudinal{}, azimuthal{};
  /// Whether the model is opaque; the traced fibre is then the clear fibre that the model approximates.
  bool opaque = false;

  /// Function that model() and trace() call from time to time. It may throw to stop them.
  using Look = std::function<void()>;
  /// Returns the distribution of the model for light at the inclination theta_o, in radians.
  FibreHistogram model(
      float theta_o, int samples, const Look& look = [] {}) const;
  /// Returns the distribution of the traced fibre.
  FibreHistogram trace(
      float theta_o, int paths, const Look& look = [] {}) const;
};

/// Makes the oracle of a fibre material, with its absorption per radius replaced by `absorption`. An opaque
/// material gets the albedo of a clear fibre with this absorption. `params` must belong to a fibre model.
FibreOracle fibre_oracle(const MaterialParams& params, float absorption);

/// Names in scene files of all fibre models, from the simplest to the most complex.
const std::vector<std::string>& fibre_model_names();
/// Returns a fibre material of the named model, with the colour and opacity of `other`. Returns `other`
/// itself if it already has this model. The name must be one of fibre_model_names().
MaterialParams with_fibre_model(const MaterialParams& other, const std::string& model);

}  // namespace pelage
