// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/sampler_variance.h"

#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "render/light/direct_light.h"
#include "render/sampling/sample_stream.h"
#include "render/sampling/warp.h"

namespace pelage {
namespace {

constexpr ShellSampler kShellSamplers[] = {ShellSampler::kMatched, ShellSampler::kTent,
                                           ShellSampler::kUniform};

/// Variance over mean squared of numbers that are added one by one.
struct SampleSpread {
  double sum = 0, squares = 0;
  int count = 0;
  void add(double x) {
    sum += x;
    squares += x * x;
    ++count;
  }
  double mean() const { return sum / count; }
  double relative() const { return squares / count / (mean() * mean()) - 1; }
};

/// A shell about the x axis, and an even light around the direction that mirrors the view.
class LitShell {
 public:
  LitShell(const ShellShape& shape, float theta_o, float light)
      : shell_(shape, ShellVariant::kWigner, std::sin(theta_o)),
        middle_(-std::sin(theta_o), std::cos(theta_o), 0),
        cos_light_(std::cos(light)) {
    complete_frame(middle_, across_, beside_);
  }

  /// The scattering, per solid angle, where there is light; else 0.
  double value(const V3f& wi) const { return lit(wi) ? double{shell_.density(wi.x)} : 0; }
  double light_pdf(const V3f& wi) const {
    return lit(wi) ? 1 / (2 * double{kPi} * (1 - double{cos_light_})) : 0;
  }
  V3f sample_light(const V2f& u) const {
    const float z = 1 - u.x * (1 - cos_light_), r = std::sqrt(std::max(0.0f, 1 - z * z));
    return z * middle_ + r * std::cos(2 * kPi * u.y) * across_ + r * std::sin(2 * kPi * u.y) * beside_;
  }
  double shell_pdf(ShellSampler sampler, const V3f& wi) const {
    if (sampler == ShellSampler::kMatched) return double{shell_.density(wi.x)};
    const double half = 0.5 * (double{shell_.z_max()} - double{shell_.z_min()});
    const double u = (double{wi.x} - 0.5 * (double{shell_.z_max()} + double{shell_.z_min()})) / half;
    if (std::abs(u) > 1) return 0;
    const double pdf = sampler == ShellSampler::kTent ? double{tent_pdf(static_cast<float>(u))} : 0.5;
    return pdf / half / (2 * double{kPi});
  }
  V3f sample_shell(ShellSampler sampler, const V2f& u) const {
    const float z = std::clamp(shell_.sample(sampler, u.x).z, -1.0f, 1.0f),
                r = std::sqrt(std::max(0.0f, 1 - z * z));
    return {z, r * std::cos(2 * kPi * u.y), r * std::sin(2 * kPi * u.y)};
  }

 private:
  bool lit(const V3f& wi) const { return wi.dot(middle_) >= cos_light_; }

  ConeShell shell_;
  V3f middle_, across_, beside_;
  float cos_light_;
};

double weighted(double value, double pdf) { return pdf > 0 ? value / pdf : 0; }

}  // namespace

TechniqueVariance technique_variance(const ShellShape& shape, float theta_o, float light, int samples) {
  const LitShell fibre(shape, theta_o, light);
  SampleSpread of_light;
  std::array<SampleSpread, 3> of_shell, of_both;
  for (int i = 0; i < samples; ++i) {
    SampleStream stream(11, static_cast<uint64_t>(i), 0, 0);
    const V3f to_light = fibre.sample_light(stream.next2d());
    const V2f u = stream.next2d();
    const double value_there = fibre.value(to_light), light_pdf = fibre.light_pdf(to_light);
    of_light.add(weighted(value_there, light_pdf));
    for (size_t k = 0; k < 3; ++k) {
      const V3f wi = fibre.sample_shell(kShellSamplers[k], u);
      const double value = fibre.value(wi), pdf = fibre.shell_pdf(kShellSamplers[k], wi);
      of_shell[k].add(weighted(value, pdf));
      const auto weight = [](double own, double other) {
        return double{power_weight(static_cast<float>(own), static_cast<float>(other))};
      };
      of_both[k].add(weighted(value, pdf) * weight(pdf, fibre.light_pdf(wi)) +
                     weighted(value_there, light_pdf) *
                         weight(light_pdf, fibre.shell_pdf(kShellSamplers[k], to_light)));
    }
  }
  TechniqueVariance result;
  result.light = of_light.relative();
  result.mean = of_light.mean();
  for (size_t k = 0; k < 3; ++k) {
    const bool found = of_shell[k].sum > 0;
    result.shell[k] = found ? of_shell[k].relative() : std::numeric_limits<double>::quiet_NaN();
    result.both[k] = 2 * of_both[k].relative();
  }
  return result;
}

Table integrand_variances() {
  constexpr int kSamples = 1 << 16;
  constexpr float kDegree = kPi / 180;
  Table table;
  table.caption = "Variance per ray, divided by the square of the mean.";
  for (const auto& [key, title] : {std::pair("light", "light alone"),
                                   {"wigner", "Wigner alone"},
                                   {"tent", "tent alone"},
                                   {"uniform", "uniform alone"},
                                   {"wigner_mis", "Wigner, MIS"},
                                   {"tent_mis", "tent, MIS"},
                                   {"uniform_mis", "uniform, MIS"}})
    table.columns.push_back({key, title, Quantity::kRatio});
  table.columns.insert(table.columns.begin(), {"integrand", "shell and light", Quantity::kRatio});
  for (const float width : {2.0f, 10.0f, 40.0f, 90.0f}) {
    for (const float light : {1.0f, 10.0f, 40.0f, 180.0f}) {
      const TechniqueVariance v = technique_variance({width, 0}, 30 * kDegree, light * kDegree, kSamples);
      table.rows.push_back({Text{fmt::format("shell {:g}°, {}", width,
                                             light < 180 ? fmt::format("light {:g}°", light) : "even sky")},
                            v.light, v.shell[0], v.shell[1], v.shell[2], v.both[0], v.both[1], v.both[2]});
    }
  }
  return table;
}

}  // namespace pelage
