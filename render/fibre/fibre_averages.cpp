// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/fibre_averages.h"

#include <algorithm>
#include <cmath>

namespace pelage {
namespace {

constexpr float kSteepestAverage = 85 * kPi / 180;
// Sum of both fractions at most: the series of scatterings between fibres converges.
constexpr float kMostLight = 0.999f;

/// Sums over the samples that go into one half.
struct HalfSums {
  Rgb light{0};
  double weight = 0, shift = 0, squares = 0;

  void add(const Rgb& part, double angle) {
    light += part;
    const double w = double{part.x} + double{part.y} + double{part.z};
    weight += w;
    shift += w * angle;
    squares += w * angle * angle;
  }
  void finish(Rgb& fraction, float& mean, float& variance) const {
    fraction = light / static_cast<float>(FibreAverageTable::kSamples);
    if (!(weight > 0)) return;
    mean = static_cast<float>(shift / weight);
    variance = static_cast<float>(std::max(0.0, squares / weight - shift / weight * (shift / weight)));
  }
};

/// Point `i` of a four-dimensional lattice that covers the unit cube evenly, one coordinate of it.
float average_lattice(int i, double step) {
  const double x = 0.5 + (i + 1) * step;
  return std::min(static_cast<float>(x - std::floor(x)), kBelowOne);
}

FibreAverages averages_of(const FibreMaterial& material, float theta, float color) {
  FibrePoint point;
  point.tangents.fill(V3f(1, 0, 0));
  point.wo = V3f(std::sin(theta), std::cos(theta), 0);
  point.color = Rgb(color);
  const FibreFrame frame(point.tangents[0], point.wo);
  HalfSums forward, backward;
  for (int i = 0; i < FibreAverageTable::kSamples; ++i) {
    point.h = 2 * average_lattice(i, 0.8566748838545029) - 1;
    const V3f u(average_lattice(i, 0.733891856627126), average_lattice(i, 0.6287067210378087),
                average_lattice(i, 0.5385972572236101));
    const auto sample = material.at(point).sample(u);
    if (!sample || !(sample->value.pdf > 0)) continue;
    const Rgb weight = sample->value.total() / sample->value.pdf;
    const FibreAngles wi = frame.angles(sample->wi);
    // Light that is turned by the angle psi stays in the half plane opposite to where it came from for the
    // part 1 - psi / pi of all azimuths of incidence.
    const float back = 1 - std::abs(wi.phi) / kPi;
    const double shift = std::asin(std::clamp(wi.sin_theta, -1.0f, 1.0f)) + double{theta};
    forward.add(weight * (1 - back), shift);
    backward.add(weight * back, shift);
  }
  FibreAverages result;
  forward.finish(result.forward, result.forward_shift, result.forward_variance);
  backward.finish(result.backward, result.backward_shift, result.backward_variance);
  return result;
}

/// A place between two nodes of a table.
struct TableStep {
  int first;
  float share;  // of the next node

  TableStep(float place, int nodes) {
    const float inside = std::clamp(place, 0.0f, static_cast<float>(nodes - 1));
    first = std::min(static_cast<int>(inside), nodes - 2);
    share = inside - static_cast<float>(first);
  }
};

}  // namespace

FibreAverageTable::FibreAverageTable(const FibreMaterial& material) {
  for (int a = 0; a < kAngles; ++a) {
    const float theta = kSteepestAverage * (2 * static_cast<float>(a) / (kAngles - 1) - 1);
    for (int c = 0; c < kColors; ++c) {
      const float root = static_cast<float>(c) / (kColors - 1);
      cells_.push_back(averages_of(material, theta, root * root));
    }
  }
}

FibreAverages FibreAverageTable::at(float sin_theta, const Rgb& color) const {
  const float theta = std::asin(std::clamp(sin_theta, -1.0f, 1.0f));
  const TableStep angle(0.5f * (kAngles - 1) * (theta / kSteepestAverage + 1), kAngles);
  FibreAverages result;
  for (int channel = 0; channel < 3; ++channel) {
    const TableStep paint(std::sqrt(std::max(color[channel], 0.0f)) * (kColors - 1), kColors);
    for (int corner = 0; corner < 4; ++corner) {
      const int next_angle = corner & 1, next_color = corner >> 1;
      const float weight =
          (next_angle ? angle.share : 1 - angle.share) * (next_color ? paint.share : 1 - paint.share);
      const FibreAverages& from = cell(angle.first + next_angle, paint.first + next_color);
      result.forward[channel] += weight * from.forward[channel];
      result.backward[channel] += weight * from.backward[channel];
      result.forward_shift += weight / 3 * from.forward_shift;
      result.backward_shift += weight / 3 * from.backward_shift;
      result.forward_variance += weight / 3 * from.forward_variance;
      result.backward_variance += weight / 3 * from.backward_variance;
    }
    const float sum = result.forward[channel] + result.backward[channel];
    if (sum > kMostLight) {
      result.forward[channel] *= kMostLight / sum;
      result.backward[channel] *= kMostLight / sum;
    }
  }
  return result;
}

}  // namespace pelage
