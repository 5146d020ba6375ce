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

/// Distribution of the light that a fibre scatters, as energy by cells of sin(theta_i) and phi. The light
/// arrives at one inclination, uniformly over the width of the fibre. One colour channel.
class FibreHistogram {
 public:
  static constexpr int kSines = 40, kAzimuths = 72;

  /// `wi` in the frame of FibreFrame: x along the fibre, wo in the half plane of x and y.
  void add(const V3f& wi, double weight);
  double cell(int sine, int azimuth) const { return cells_[index(sine, azimuth)]; }
  double total() const;
  std::vector<double> by_azimuth() const;  ///< energy by azimuth, from -pi to pi; light arrives from azimuth
                                           ///< 0
  std::vector<double> by_sine() const;     ///< from -1 to 1

 private:
  static size_t index(int sine, int azimuth) { return static_cast<size_t>(sine * kAzimuths + azimuth); }
  std::vector<double> cells_ = std::vector<double>(static_cast<size_t>(kSines) * kAzimuths);
};

/// Distance of two normalised distributions: 0 when equal, 1 when disjoint.
double total_variation(const std::vector<double>& a, const std::vector<double>& b);

/// The parameters of a model, and the matching fibre for brute-force tracing, its reference.
struct FibreOracle {
  /// The model without tilt, with given absorption.
  MaterialParams params;
  TracedFibre traced;
  float absorption = 0;  ///< absorption of cortex and medulla, per radius
  /// Blur of a smooth fibre's scattering that matches the model's roughness: deviations in radians for R, TT
  /// and all internal reflections. Light scattered by the medulla is not blurred.
  std::array<float, 3> longitudinal{}, azimuthal{};
  bool opaque = false;  ///< whether the model is opaque; the traced fibre is then the fibre that the model
                        ///< approximates

  /// Called from time to time by model() and trace(); may throw to stop them.
  using Look = std::function<void()>;
  FibreHistogram model(
      float theta_o, int samples, const Look& look = [] {}) const;
  FibreHistogram trace(
      float theta_o, int paths, const Look& look = [] {}) const;
};

/// The oracle of a fibre material whose absorption per radius is replaced by `absorption`. An opaque material
/// becomes as bright as a clear fibre with this absorption. `params` must belong to a fibre model.
FibreOracle fibre_oracle(const MaterialParams& params, float absorption);

/// Scene names of all fibre models, from the simplest to the most complex.
const std::vector<std::string>& fibre_model_names();
/// A fibre material of the named model, with the colour and opacity of `other`; `other` itself if it already
/// has that model. The name must be one of fibre_model_names().
MaterialParams with_fibre_model(const MaterialParams& other, const std::string& model);

}  // namespace pelage
