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

}  // namespace

FibreAverageTable::Step::Step(float place, int nodes) {
  const float inside = std::clamp(place, 0.0f, static_cast<float>(nodes - 1));
  first = std::min(static_cast<int>(inside), nodes - 2);
  share = inside - static_cast<float>(first);
}

FibreAverageTable::Cell::Cell(const FibreAverages& of) {
  for (int c = 0; c < 3; ++c)
    channels[static_cast<size_t>(c)] = {of.forward[c],
                                        of.backward[c],
                                        of.forward_shift / 3,
                                        of.backward_shift / 3,
                                        of.forward_variance / 3,
                                        of.backward_variance / 3,
                                        0,
                                        0};
}

FibreAverageTable::FibreAverageTable(const FibreMaterial& material) {
  for (int a = 0; a < kAngles; ++a) {
    const float theta = kSteepestAverage * (2 * static_cast<float>(a) / (kAngles - 1) - 1);
    for (int c = 0; c < kColors; ++c) {
      const float root = static_cast<float>(c) / (kColors - 1);
      cells_.emplace_back(averages_of(material, theta, root * root));
    }
  }
}

FibreAverageTable::ColorSteps FibreAverageTable::steps_of(const Rgb& color) {
  const auto step = [&](int channel) {
    return Step(std::sqrt(std::max(color[channel], 0.0f)) * (kColors - 1), kColors);
  };
  return {step(0), step(1), step(2)};
}

FibreAverages FibreAverageTable::at(float sin_theta, const ColorSteps& color) const {
  const float theta = std::asin(std::clamp(sin_theta, -1.0f, 1.0f));
  const Step angle(0.5f * (kAngles - 1) * (theta / kSteepestAverage + 1), kAngles);
  FibreAverages result;
  for (int channel = 0; channel < 3; ++channel) {
    const auto c = static_cast<size_t>(channel);
    const Step& paint = color[c];
    const Lanes& a = cell(angle.first, paint.first).channels[c];
    const Lanes& b = cell(angle.first + 1, paint.first).channels[c];
    const Lanes& a_next = cell(angle.first, paint.first + 1).channels[c];
    const Lanes& b_next = cell(angle.first + 1, paint.first + 1).channels[c];
    Lanes mixed;
    for (size_t k = 0; k < mixed.size(); ++k) {
      const float here = a[k] + angle.share * (b[k] - a[k]);
      const float next = a_next[k] + angle.share * (b_next[k] - a_next[k]);
      mixed[k] = here + paint.share * (next - here);
    }
    // Samples may sum up to more light than there is.
    const float scale = kMostLight / std::max(mixed[0] + mixed[1], kMostLight);
    result.forward[channel] = mixed[0] * scale;
    result.backward[channel] = mixed[1] * scale;
    result.forward_shift += mixed[2];
    result.backward_shift += mixed[3];
    result.forward_variance += mixed[4];
    result.backward_variance += mixed[5];
  }
  return result;
}

}  // namespace pelage
