// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/dual_scattering.h"

#include <algorithm>
#include <cmath>

#include "render/fibre/longitudinal.h"

namespace pelage {
namespace {

constexpr float kNoLightLeft = 0.03f;  // fraction of light that is as good as none
constexpr float kMaxStrands = 64;

/// Mean shift and variance of the light that the fibres around a point scatter back [Zinke08, equations 16
/// and 17], with the means of a_f and a_b over the channels.
struct BackscatterShape {
  float shift = 0, variance = 0;

  explicit BackscatterShape(const FibreAverages& of) {
    const float f = (of.forward.x + of.forward.y + of.forward.z) / 3;
    const float b = (of.backward.x + of.backward.y + of.backward.z) / 3;
    const float f2 = f * f, b2 = b * b, left = std::max(1 - f2, 1e-3f);
    shift = of.backward_shift * (1 - 2 * b2 / (left * left)) +
            of.forward_shift * (2 * left * left + 4 * f2 * b2) / (left * left * left);
    // Further than a quarter turn, the first terms of the series mean nothing.
    shift = std::clamp(shift, -0.5f * kPi, 0.5f * kPi);
    const float vf = of.forward_variance, vb = of.backward_variance;
    const float deviation = (1 + 0.7f * f2) *
                            (b * std::sqrt(2 * vf + vb) + b * b2 * std::sqrt(2 * vf + 3 * vb)) /
                            std::max(b + b * b2 * (2 * std::sqrt(vf) + 3 * std::sqrt(vb)), 1e-6f);
    variance = deviation * deviation;
  }
};

}  // namespace

float stack_backscatter(float forward, float backward) {
  if (!(backward > 0)) return 0;
  const float b = 1 + backward * backward - forward * forward;
  const float reflectance = (b - std::sqrt(std::max(0.0f, b * b - 4 * backward * backward))) / (2 * backward);
  return forward * forward * reflectance / (1 - backward * reflectance);
}

DualScattering::DualScattering(const FibreAverageTable& table, const V3f& tangent, const V3f& wo,
                               const Rgb& color)
    : table_(&table), frame_(tangent, wo), color_(FibreAverageTable::steps_of(color)) {}

Rgb DualScattering::likely(const V3f& wi) const {
  const FibreAngles in = frame_.angles(wi);
  const FibreAverages fibre = table_->at(in.sin_theta, color_);
  const BackscatterShape shape(fibre);
  // Lobes that are wider by their tilts, instead of tilted ones.
  const auto lobe = [&](float variance) {
    return LongitudinalLobe(variance).density(in.sin_theta, in.cos_theta, frame_.sin_theta_o(),
                                              frame_.cos_theta_o());
  };
  const float narrow =
      lobe(fibre.forward_variance + fibre.backward_variance + fibre.forward_shift * fibre.forward_shift +
           fibre.backward_shift * fibre.backward_shift);
  const float wide = lobe(fibre.forward_variance + shape.variance + shape.shift * shape.shift);
  const float backward = (1 + std::cos(in.phi)) / (2 * kPi), forward = (1 - std::cos(in.phi)) / (2 * kPi);
  Rgb scattered;
  for (int c = 0; c < 3; ++c) {
    const float around = stack_backscatter(fibre.forward[c], fibre.backward[c]);
    scattered[c] = fibre.forward[c] * (narrow * (forward * fibre.forward[c] + backward * fibre.backward[c]) +
                                       wide * backward * around);
  }
  return scattered;
}

DualScattering::Arriving::Arriving(const DualScattering& dual, const V3f& wi)
    : frame_(dual.frame_), in_(frame_.angles(wi)), fibre_(dual.table_->at(in_.sin_theta, dual.color_)) {}

float DualScattering::Arriving::max_strands() const {
  const float left = max_component(fibre_.forward);
  if (!(left > 0)) return 1;
  return std::clamp(std::ceil(std::log(kNoLightLeft) / std::log(std::min(left, 0.999f))), 1.0f, kMaxStrands);
}

FibreValue DualScattering::Arriving::eval(const FibreValue& direct, float strands, float through) const {
  FibreValue value = direct;
  for (Rgb& lobes : value.lobes) lobes *= through;
  const bool arrives = std::isfinite(strands);
  if (!arrives && !(through > 0)) return value;
  const BackscatterShape shape(fibre_);
  const float backward = (1 + std::cos(in_.phi)) / (2 * kPi), forward = (1 - std::cos(in_.phi)) / (2 * kPi);
  // The lobes are tilted by turning the view.
  const auto lobe = [&](float shift, float variance) {
    const float sine = frame_.sin_theta_o() * std::cos(shift) - frame_.cos_theta_o() * std::sin(shift);
    const float cosine = std::sqrt(std::max(0.0f, 1 - sine * sine));
    return LongitudinalLobe(variance).density(in_.sin_theta, in_.cos_theta, sine, cosine);
  };
  const float spread = arrives ? strands * fibre_.forward_variance : 0;
  const float back_now = through > 0 ? backward * lobe(shape.shift, shape.variance) : 0;
  const float back_spread =
      arrives && strands > 0 ? backward * lobe(shape.shift, shape.variance + spread) : 0;
  const float on = forward * lobe(fibre_.forward_shift, fibre_.forward_variance + spread);
  const float returned = backward * lobe(fibre_.backward_shift, fibre_.backward_variance + spread);
  for (int c = 0; c < 3; ++c) {
    const float around = stack_backscatter(fibre_.forward[c], fibre_.backward[c]);
    const float crossed = arrives ? std::pow(fibre_.forward[c], strands) : 0;
    const float scattered = std::max(0.0f, crossed - through);
    value[LobeGroup::kDiffuse][c] +=
        through * around * back_now +
        scattered * (fibre_.forward[c] * on + fibre_.backward[c] * returned + around * back_spread);
  }
  return value;
}

}  // namespace pelage
