// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "render/fibre/fibre_material.h"

namespace pelage {

/// What one fibre does to the light that hits it, on average over the places and azimuths at which light from
/// one half of the directions hits it [Zinke08, section 4].
struct FibreAverages {
  Rgb forward{0};           ///< a_f: fraction of the light that goes on into the other half
  Rgb backward{0};          ///< a_b: fraction that goes back into the half it came from
  float forward_shift = 0;  ///< alpha_f: mean of theta_i + theta_o of the light that goes on, in radians
  float backward_shift = 0;
  float forward_variance = 0;  ///< beta_f squared: variance of theta_i + theta_o, in radians squared
  float backward_variance = 0;
};

/// The averages of a material by inclination and colour, integrated numerically over samples of its model.
/// A function of the material only. Thread safety: const members from any thread.
class FibreAverageTable {
 public:
  explicit FibreAverageTable(const FibreMaterial& material);

  /// A place between two nodes of one axis of the table.
  struct Step {
    int first = 0;
    float share = 0;  ///< of the next node

    Step() = default;
    Step(float place, int nodes);
  };
  /// The places of a colour's three channels, each of which is looked up by itself.
  using ColorSteps = std::array<Step, 3>;

  static ColorSteps steps_of(const Rgb& color);

  /// Returns the averages for light of inclination theta (sin_theta = dot(wi, tangent)) on a fibre of this
  /// colour. The fractions of light that goes on and back sum up to at most 1, also for models that gain
  /// light.
  FibreAverages at(float sin_theta, const ColorSteps& color) const;
  FibreAverages at(float sin_theta, const Rgb& color) const { return at(sin_theta, steps_of(color)); }

  static constexpr int kAngles = 12;    ///< evenly spaced from -85 to 85 degrees
  static constexpr int kColors = 9;     ///< square roots of colours, evenly spaced from 0 to 1
  static constexpr int kSamples = 512;  ///< per angle and colour: the error of a fraction is about 0.005

 private:
  // Of one channel: both fractions, then a third of both shifts and of both variances, which are those of all
  // channels together. Two lanes are empty, so that a row fills vectors of four.
  using Lanes = std::array<float, 8>;
  struct Cell {
    std::array<Lanes, 3> channels;

    explicit Cell(const FibreAverages& of);
  };
  const Cell& cell(int angle, int color) const {
    return cells_[static_cast<size_t>(angle * kColors + color)];
  }

  std::vector<Cell> cells_;
};

}  // namespace pelage
