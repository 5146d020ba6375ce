// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/yan.h"

#include <algorithm>
#include <cmath>

namespace pelage {
MedullaCrossing::MedullaCrossing(const YanOptics& optics, float sin_theta, float cos_theta, float h)
    : surface(optics.eta, optics.layers, sin_theta, cos_theta, h) {
  const float half2 = optics.kappa * optics.kappa - surface.sin_gamma_t * surface.sin_gamma_t;
  in_medulla = 2 * std::sqrt(std::max(0.0f, half2)) / surface.cos_theta_t;
  in_cortex = std::max(0.0f, surface.leg() - in_medulla);
  unscattered = std::exp(-optics.sigma_ms * in_medulla);
}

MedullaFibre::MedullaFibre(const YanOptics& optics) : optics_(optics) {
  const float beta_m = optics.beta_m * (kPi / 180), beta_n = optics.beta_n * (kPi / 180);
  const float wider = 1.5f * beta_m;
  widths_.longitudinal = {LongitudinalLobe(beta_m * beta_m), LongitudinalLobe(beta_m * beta_m),
                          LongitudinalLobe(wider * wider), LongitudinalLobe(wider * wider)};
  for (int p = 0; p < 3; ++p)
    widths_.azimuthal[p] = WrappedGaussian(std::sqrt(static_cast<float>(p + 1)) * beta_n);
  const float alpha = optics.alpha * (kPi / 180);
  widths_.set_tilt(0, 2 * alpha);
  widths_.set_tilt(1, -alpha);
  widths_.set_tilt(2, -3 * alpha);
}

SeparableBsdf<WrappedGaussian> MedullaFibre::straight(const FibreFrame& frame, const MedullaCrossing& c,
                                                      const Rgb& sigma_ca, const Rgb& sigma_ma) const {
  Rgb leg;
  for (int k = 0; k < 3; ++k)
    leg[k] = c.unscattered * std::exp(-sigma_ca[k] * c.in_cortex - sigma_ma[k] * c.in_medulla);
  const FibreCrossing& s = c.surface;
  return {widths_,
          frame,
          {s.exit_azimuth(0), s.exit_azimuth(1), s.exit_azimuth(2)},
          attenuations(s.reflectance, leg)};
}

namespace {

TracedFibre traced(const YanOptics& o) { return {o.eta, o.layers, o.kappa, o.sigma_ms, o.g}; }

}  // namespace

YanFastMaterial::YanFastMaterial(const YanFastParams& params)
    : fibre_(params.optics()), scattering_([&] {
        constexpr int kPaths = 8192;
        std::array<Scattering, kInclinations> all;
        for (int i = 0; i < kInclinations; ++i) {
          const float sine = 0.98f * static_cast<float>(i) / (kInclinations - 1);
          Scattering& s = all[i];
          std::vector<FibrePath> scattered;
          for (int k = 0; k < kPaths; ++k) {
            const float h = 2 * (static_cast<float>(k) + 0.5f) / kPaths - 1;
            const FibrePath path = trace_fibre(traced(fibre_.optics()), sine, h, i, k);
            if (!path.scattered) continue;
            scattered.push_back(path);
            s.balance += 2 * path.wi.y / std::max(1e-6f, std::hypot(path.wi.y, path.wi.z));
          }
          const auto count = std::max(1.0f, static_cast<float>(scattered.size()));
          s.balance = std::clamp(s.balance / count, -1.0f, 1.0f);
          s.lengths = PathLengths(std::move(scattered));
        }
        return all;
      }()) {}

YanFastMaterial::Scattering YanFastMaterial::scattering_at(float sin_theta) const {
  const float x = std::min(std::abs(sin_theta) / 0.98f, 1.0f) * (kInclinations - 1);
  const int i = std::min(static_cast<int>(x), kInclinations - 2);
  const float t = x - static_cast<float>(i);
  return {PathLengths::mix(scattering_[i].lengths, scattering_[i + 1].lengths, t),
          scattering_[i].balance + t * (scattering_[i + 1].balance - scattering_[i].balance)};
}

YanFastBsdf YanFastMaterial::at(const FibreFrame& frame, float h, const Rgb& absorption) const {
  const YanOptics& o = fibre_.optics();
  const MedullaCrossing crossing(o, frame.sin_theta_o(), frame.cos_theta_o(), h);
  const Rgb sigma_ca = o.sigma_ca.value_or(absorption), sigma_ma = o.sigma_ma.value_or(absorption);
  const Scattering s = scattering_at(frame.sin_theta_o());
  return {fibre_.straight(frame, crossing, sigma_ca, sigma_ma), WignerScatter(s.balance),
          s.lengths.transmittance(sigma_ca, sigma_ma) * crossing.scattered()};
}

YanMaterial::YanMaterial(const YanParams& params)
    : fibre_(params.optics()),
      tables_(params.made ? params.made : MedullaTables::make(fibre_.optics(), Workers::alone())) {}

YanBsdf YanMaterial::at(const FibreFrame& frame, float h, const Rgb& absorption) const {
  const YanOptics& o = fibre_.optics();
  const MedullaCrossing crossing(o, frame.sin_theta_o(), frame.cos_theta_o(), h);
  const Rgb sigma_ca = o.sigma_ca.value_or(absorption), sigma_ma = o.sigma_ma.value_or(absorption);
  const TabulatedScatter scatter(*tables_, frame.sin_theta_o(), h);
  return {fibre_.straight(frame, crossing, sigma_ca, sigma_ma), scatter,
          scatter.lengths().transmittance(sigma_ca, sigma_ma) * crossing.scattered()};
}

}  // namespace pelage
