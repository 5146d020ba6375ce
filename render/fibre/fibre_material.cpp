// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/fibre_material.h"

#include <cmath>

#include "base/check.h"

namespace pelage {
namespace {

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

bool is_far(const MaterialParams& params) {
  return std::visit(
      []<class P>(const P& p) {
        if constexpr (requires { p.field; }) {
          return p.field == FibreField::kFar;
        } else {
          return std::is_same_v<P, MarschnerParams>;
        }
      },
      params);
}

std::optional<float> index_of(const MaterialParams& params) {
  return std::visit(
      []<class P>(const P& p) -> std::optional<float> {
        if constexpr (std::is_base_of_v<MedullaParams, P>) return p.optics().eta;
        if constexpr (requires { p.eta; }) return p.eta;
        return std::nullopt;
      },
      params);
}

bool has_given_absorption(const MedullaParams& params) {
  const YanOptics optics = params.optics();
  return optics.sigma_ca && optics.sigma_ma;
}

/// Whether the colour is converted to absorption through the colour of dense fur. Chiang fibres, which define
/// that colour, and d'Eon fibres, which look the same from afar, have a formula instead.
bool takes_coat_color(const MaterialParams& params) {
  return std::visit(Overloaded{[](const ConeShellParams& p) { return !p.diffuse; },
                               [](const LambertCylinderParams& p) { return !p.albedo; },
                               [](const KajiyaKayParams& p) { return !p.diffuse; },
                               [](const MarschnerParams& p) { return !given_absorption(p); },
                               [](const YanFastParams& p) { return !has_given_absorption(p); },
                               [](const YanParams& p) { return !has_given_absorption(p); },
                               [](const auto&) { return false; }},
                    params);
}

Rgb passed(const Rgb& absorption) {
  return {std::exp(-absorption.x), std::exp(-absorption.y), std::exp(-absorption.z)};
}

}  // namespace

MaterialParams with_tables(MaterialParams params, const Job& job) {
  if (auto* yan = std::get_if<YanParams>(&params); yan && !yan->made) {
    const YanOptics optics = yan->optics();
    yan->made = yan->tables.path.empty()
                    ? MedullaTables::make(optics, job)
                    : MedullaTables::find_or_make(optics, ContentStore(yan->tables.path), job);
  }
  if (takes_coat_color(params)) {
    auto made = FibreMaterial(params, job.workers, [&] { job.check_stop(); }).coat_color();
    std::visit(
        [&]<class P>(P& p) {
          if constexpr (std::is_base_of_v<FibreParams, P>) p.coat_color = std::move(made);
        },
        params);
  }
  return params;
}

FibreMaterial::Model FibreMaterial::make(const MaterialParams& params) {
  PELAGE_CHECK(is_one(params));
  return std::visit(
      Overloaded{[](const ConeShellParams& p) -> Model { return ConeShellMaterial(p); },
                 [](const LambertCylinderParams& p) -> Model { return LambertCylinder{p.albedo}; },
                 [](const KajiyaKayParams& p) -> Model { return KajiyaKayMaterial(p); },
                 [](const ChiangParams& p) -> Model { return ChiangMaterial(p); },
                 [](const DeonParams& p) -> Model { return DeonMaterial(p); },
                 [](const MarschnerParams& p) -> Model { return MarschnerMaterial(p); },
                 [](const YanFastParams& p) -> Model { return YanFastMaterial(p); },
                 [](const YanParams& p) -> Model { return YanMaterial(p); },
                 [](const auto&) -> Model { return LambertCylinder{}; }},
      params);
}

FibreMaterial::FibreMaterial(const MaterialParams& params, const Workers& workers,
                             const std::function<void()>& look)
    : model_(make(params)), far_field_(is_far(params)), eta_(index_of(params)) {
  if (!takes_coat_color(params)) return;
  coat_color_ = fibre_params(params)->coat_color;
  if (coat_color_) return;
  coat_color_ = std::make_shared<CoatColor>(
      [this, &look](float t, const TangleHit& hit, const V3f& u) {
        look();
        FibrePoint point;
        point.tangents.fill(hit.tangent);
        point.wo = hit.wo;
        point.h = hit.h;
        return at_absorbing(point, Rgb(t)).sample(u);
      },
      workers);
}

float FibreMaterial::farther(const FibrePoint& point) const {
  if (!eta_) return 0;
  const FibreFrame frame(point.tangents[0], point.wo);
  const FibreCrossing crossing(*eta_, 0, frame.sin_theta_o(), frame.cos_theta_o(), point.h);
  return -crossing.leg() * frame.sin_theta_o() / *eta_;
}

FibreBsdf FibreMaterial::at(const FibrePoint& point) const {
  if (!coat_color_) return at(point, point.color, point.color);
  return at_absorbing(point, (*coat_color_)(point.color));
}

FibreBsdf FibreMaterial::at_absorbing(const FibrePoint& point, const Rgb& absorption) const {
  return at(point, passed(absorption), absorption);
}

FibreBsdf FibreMaterial::at(const FibrePoint& point, const Rgb& albedo, const Rgb& paint) const {
  const auto frame = [&] { return FibreFrame(point.tangents[0], point.wo); };
  return std::visit(
      Overloaded{[&](const ConeShellMaterial& m) -> FibreBsdf {
                   return ConeShellBsdf(m, albedo, point.tangents, point.wo);
                 },
                 [&](const LambertCylinder& m) -> FibreBsdf {
                   return LambertCylinderBsdf(m.albedo.value_or(albedo), frame(), point.h);
                 },
                 [&](const KajiyaKayMaterial& m) -> FibreBsdf { return KajiyaKayBsdf(m, albedo, frame()); },
                 [&](const auto& m) -> FibreBsdf { return m.at(frame(), point.h, paint); }},
      model_);
}

}  // namespace pelage
