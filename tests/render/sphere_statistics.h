// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <optional>

#include "base/vector.h"
#include "render/sampling/warp.h"
#include "tests/support/chi_square.h"

namespace pelage {

/// Coordinates on the sphere about an axis: z = dot(w, axis) and the azimuth, an equal-area map.
struct SphereGrid {
  explicit SphereGrid(const V3f& sphere_axis) : axis(sphere_axis) { complete_frame(axis, x, y); }
  V3f axis, x, y;

  V3f direction(double z, double turn) const {
    return polar_direction(x, y, axis, static_cast<float>(z), static_cast<float>(turn));
  }
  double z_of(const V3f& w) const { return w.dot(axis); }
  double turn_of(const V3f& w) const {
    const double turn = std::atan2(w.dot(y), w.dot(x)) / (2 * std::numbers::pi);
    return turn < 0 ? turn + 1 : turn;
  }
};

/// Integral over the sphere by the midpoint rule over (z, azimuth).
template <class Function>
double sphere_integral(const SphereGrid& grid, Function&& f, int z_steps = 512, int turn_steps = 1024) {
  double sum = 0;
  for (int i = 0; i < z_steps; ++i) {
    const double z = -1 + 2 * (i + 0.5) / z_steps;
    for (int j = 0; j < turn_steps; ++j) sum += f(grid.direction(z, (j + 0.5) / turn_steps));
  }
  return sum * 4 * std::numbers::pi / (static_cast<double>(z_steps) * turn_steps);
}

struct SphereTestSize {
  int samples = 200000;
  int z_cells = 40, turn_cells = 80;
  int z_steps = 16, turn_steps = 16;  ///< of the midpoint rule in each cell
  double z_low = -1, z_high = 1;  ///< part of the sphere that the cells divide; one more cell takes the rest
};

/// Samples directions and compares their counts in cells of the sphere with the integral of the density
/// there. `sample` is called with 0 .. samples-1 and gives an optional direction; `pdf` is per solid angle.
/// Directions that were not sampled belong to the rest cell, as does density outside the cells.
template <class Sample, class Pdf>
ChiSquare sphere_chi_square(const SphereGrid& grid, Sample&& sample, Pdf&& pdf,
                            const SphereTestSize& size = {}) {
  const int cells = size.z_cells * size.turn_cells;
  std::vector<double> observed(cells + 1, 0.0), expected(cells + 1, 0.0);
  const double z_range = size.z_high - size.z_low;
  for (int k = 0; k < size.samples; ++k) {
    const std::optional<V3f> w = sample(k);
    int cell = cells;
    if (w) {
      const int i = static_cast<int>(std::floor((grid.z_of(*w) - size.z_low) / z_range * size.z_cells));
      const int j = std::min(static_cast<int>(grid.turn_of(*w) * size.turn_cells), size.turn_cells - 1);
      if (i >= 0 && i < size.z_cells) cell = i * size.turn_cells + j;
      if (i == size.z_cells && size.z_high == 1) cell = (i - 1) * size.turn_cells + j;
    }
    observed[cell] += 1;
  }
  const double area =
      2 * std::numbers::pi * z_range / (static_cast<double>(cells) * size.z_steps * size.turn_steps);
  double sum = 0;
  for (int i = 0; i < size.z_cells * size.z_steps; ++i) {
    const double z = size.z_low + z_range * (i + 0.5) / (size.z_cells * size.z_steps);
    for (int j = 0; j < size.turn_cells * size.turn_steps; ++j) {
      const double turn = (j + 0.5) / (size.turn_cells * size.turn_steps);
      const double mass = pdf(grid.direction(z, turn)) * area * size.samples;
      expected[(i / size.z_steps) * size.turn_cells + j / size.turn_steps] += mass;
      sum += mass;
    }
  }
  expected[cells] = std::max(0.0, size.samples - sum);
  return chi_square(observed, expected);
}

}  // namespace pelage
