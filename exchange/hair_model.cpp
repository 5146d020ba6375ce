// SPDX-License-Identifier: Apache-2.0
#include "exchange/hair_model.h"

#include <cmath>
#include <numbers>

#include "render/material/absorption.h"

namespace pelage {
namespace {

float longitudinal_deviation(float beta) {
  return 0.726f * beta + 0.812f * beta * beta + 3.7f * std::pow(beta, 20.0f);
}
float logistic_scale(float beta) {
  return 0.265f * beta + 1.194f * beta * beta + 5.372f * std::pow(beta, 22.0f);
}

/// Returns where an increasing function of [0, 1] has a value.
template <class F>
float inverse(const F& f, float value) {
  float low = 0, high = 1;
  for (int i = 0; i < 40; ++i) {
    const float middle = 0.5f * (low + high);
    (f(middle) < value ? low : high) = middle;
  }
  return 0.5f * (low + high);
}

/// Roughness whose lobes have these widths: standard deviations in degrees.
void set_widths(float along, float around, HairModel& hair) {
  constexpr float kRadiansPerDegree = std::numbers::pi_v<float> / 180;
  hair.beta_m = inverse(longitudinal_deviation, along * kRadiansPerDegree);
  // A logistic distribution of scale s has the deviation s pi / sqrt(3).
  const float per_scale =
      std::sqrt(std::numbers::pi_v<float> / 8) * std::numbers::pi_v<float> / std::sqrt(3.0f);
  hair.beta_n = inverse(logistic_scale, around * kRadiansPerDegree / per_scale);
}

struct HairModelOf {
  const Rgb& color;
  const std::string& subject;
  ExportNotes& notes;

  HairModel operator()(const ChiangParams& p) const {
    HairModel hair{.eta = p.eta, .beta_m = p.beta_m, .beta_n = p.beta_n, .alpha = p.alpha};
    hair.absorption = fibre_absorption(p, ColorToAbsorption(p.beta_n), color);
    return hair;
  }
  HairModel operator()(const DeonParams& p) const { return from_gaussian(p, p.beta, "deon"); }
  HairModel operator()(const MarschnerParams& p) const {
    return from_gaussian(p, 2 * p.beta, "marschner");  // its lobes are in half angles
  }
  template <class Params>
  HairModel operator()(const Params&) const {
    HairModel hair;
    hair.absorption = ColorToAbsorption(hair.beta_n)(color);
    notes.add(subject, std::string("the model `") + Params::kTypeName +
                           "` became hair after Chiang et al. 2016 with the same colour of a dense coat");
    return hair;
  }

 private:
  /// Both models state the tilt of the highlight, which is opposite to that of the scales.
  template <class Params>
  HairModel from_gaussian(const Params& p, float along, const char* model) const {
    HairModel hair{.eta = p.eta, .alpha = -p.alpha};
    set_widths(along, p.azimuthal_width, hair);
    hair.absorption = fibre_absorption(p, ColorToAbsorption(hair.beta_n), color);
    notes.add(subject, std::string("the model `") + model +
                           "` became hair after Chiang et al. 2016 with lobes of the same widths");
    return hair;
  }
};

}  // namespace

float HairModel::longitudinal_variance() const {
  const float deviation = longitudinal_deviation(beta_m);
  return deviation * deviation;
}
float HairModel::azimuthal_scale() const { return logistic_scale(beta_n); }

HairModel hair_model(const MaterialParams& material, const Rgb& color, const std::string& name,
                     ExportNotes& notes) {
  const std::string subject = "material '" + name + "'";
  HairModel hair = std::visit(HairModelOf{color, subject, notes}, material);
  bool gains = false;
  for (int c = 0; c < 3; ++c) {
    gains |= hair.absorption[c] < 0;
    hair.absorption[c] = std::max(hair.absorption[c], 0.0f);
  }
  if (gains) notes.add(subject, "a negative absorption became 0");
  return hair;
}

}  // namespace pelage
