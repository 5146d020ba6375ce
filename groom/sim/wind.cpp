// SPDX-License-Identifier: Apache-2.0
#include "groom/sim/wind.h"

#include <array>
#include <cmath>

#include "base/hash.h"

namespace pelage {

const Schema<WindParams>& WindParams::schema() {
  static const Schema<WindParams> table = [] {
    Schema<WindParams> s("wind", "The air that moves a coat with `dynamics`.");
    s.set_example(R"(grooms:
  coat:
    skin: rat
    strands: 20000
    dynamics:
      wind: {velocity: {keys: {1: [2, 0, 0], 24: [6, 0, 1]}}, gusts: 0.6, turbulence: 1.5})");
    s.key("velocity", &WindParams::velocity, {.unit = "m / s", .help = "Mean velocity of the air"});
    s.key("gusts", &WindParams::gusts,
          {.help = "How much gusts change the mean velocity: 0.5 gives 50 to 150 %", .min = 0, .max = 1});
    s.key("gust_seconds", &WindParams::gust_seconds,
          {.unit = "s", .help = "Time from one gust to the next, roughly", .min = 0, .above_min = true});
    s.key("turbulence", &WindParams::turbulence,
          {.unit = "m / s", .help = "Root mean square of the velocity of eddies", .min = 0});
    s.key("eddy_size", &WindParams::eddy_size,
          {.unit = "m", .help = "Size of the eddies", .min = 0, .above_min = true});
    s.key("seed", &WindParams::seed, {.help = "Seed of gusts and eddies"});
    return s;
  }();
  return table;
}

namespace {

struct Smooth {
  double value, slope;
};

/// 0 at t = 0 and 1 at t = 1, with continuous second derivatives.
Smooth smooth_step(double t) { return {t * t * t * (t * (t * 6 - 15) + 10), 30 * t * t * (t - 1) * (t - 1)}; }

/// A whole number of limited size, so that hostile values do not overflow.
int64_t lattice(double x) { return static_cast<int64_t>(std::floor(std::clamp(x, -1e15, 1e15))); }

/// Smooth noise over time, between -1 and 1.
double gust(uint64_t seed, double t) {
  const int64_t cell = lattice(t);
  const double s = smooth_step(t - static_cast<double>(cell)).value;
  const double a = signed_float(hash64(seed, cell, random_use("gust")));
  const double b = signed_float(hash64(seed, cell + 1, random_use("gust")));
  return a + (b - a) * s;
}

/// Random potentials at the corners of a cell.
const std::array<V3d, 8>& corner_potentials(uint64_t seed, const std::array<int64_t, 3>& cell,
                                            Wind::Cell::Corners& known) {
  if (known.is_known && known.seed == seed && known.place == cell) return known.potentials;
  known.is_known = true;
  known.seed = seed;
  known.place = cell;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const unsigned i = corner & 1, j = (corner >> 1) & 1, k = corner >> 2;
    const uint64_t h = mix64(seed + static_cast<uint64_t>(cell[0] + i) * 0x9e3779b97f4a7c15ull +
                             static_cast<uint64_t>(cell[1] + j) * 0xc2b2ae3d27d4eb4full +
                             static_cast<uint64_t>(cell[2] + k) * 0x165667b19e3779f9ull);
    known.potentials[corner] = V3d(signed_float(h), signed_float(h << 21), signed_float(h << 42));
  }
  return known.potentials;
}

/// Curl of a vector of three smooth noises, in cells of size 1. Root mean square 1, measured.
V3d curl_noise(uint64_t seed, const V3d& x, Wind::Cell::Corners& known) {
  std::array<int64_t, 3> cell;
  std::array<std::array<double, 2>, 3> weight, slope;
  for (unsigned k = 0; k < 3; ++k) {
    cell[k] = lattice(x[k]);
    const Smooth s = smooth_step(std::clamp(x[k] - static_cast<double>(cell[k]), 0.0, 1.0));
    weight[k] = {1 - s.value, s.value};
    slope[k] = {-s.slope, s.slope};
  }
  const std::array<V3d, 8>& potentials = corner_potentials(seed, cell, known);
  V3d curl(0);
  for (unsigned corner = 0; corner < 8; ++corner) {
    const unsigned i = corner & 1, j = (corner >> 1) & 1, k = corner >> 2;
    const V3d gradient(slope[0][i] * weight[1][j] * weight[2][k], weight[0][i] * slope[1][j] * weight[2][k],
                       weight[0][i] * weight[1][j] * slope[2][k]);
    curl += gradient.cross(potentials[corner]);
  }
  constexpr double kRms = 1.855;
  return curl / kRms;
}

}  // namespace

Wind::Wind(const WindParams& params, double frame, double seconds)
    : params_(params),
      mean_(params.velocity.at(frame)),
      seconds_(seconds),
      gusts_(params.gusts.at(frame)),
      turbulence_(params.turbulence.at(frame)),
      is_still_(mean_ == V3d(0) && turbulence_ == 0) {}

V3d Wind::at(const V3d& place, Cell& known) const {
  if (is_still_) return V3d(0);
  const auto seed = static_cast<uint64_t>(params_.seed);
  V3d velocity = mean_;
  if (gusts_ > 0 && mean_ != V3d(0)) {
    const double arrives = mean_.dot(place) / mean_.length2();  // seconds after the origin
    velocity *= 1 + gusts_ * gust(seed, (seconds_ - arrives) / params_.gust_seconds);
  }
  if (turbulence_ > 0) {
    // Eddies live as long as a gust. A sum of fields without divergence has none either.
    const double age = seconds_ / params_.gust_seconds;
    const int64_t cell = lattice(age);
    const double s = smooth_step(age - static_cast<double>(cell)).value;
    const V3d x = place / params_.eddy_size;
    const V3d a = curl_noise(hash64(seed, cell, random_use("turbulence")), x, known.older),
              b = curl_noise(hash64(seed, cell + 1, random_use("turbulence")), x, known.newer);
    // Keeps the root mean square of independent fields.
    velocity += (a * (1 - s) + b * s) * (turbulence_ / std::sqrt((1 - s) * (1 - s) + s * s));
  }
  return velocity;
}

}  // namespace pelage
