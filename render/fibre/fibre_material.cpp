// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/fibre_material.h"

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

}  // namespace

MaterialParams with_tables(MaterialParams params, const Workers& workers, const WarningSink& warn) {
  if (auto* yan = std::get_if<YanParams>(&params)) {
    const YanOptics optics = yan->optics();
    yan->made = yan->tables.path.empty()
                    ? MedullaTables::make(optics, workers)
                    : MedullaTables::find_or_make(optics, ContentStore(yan->tables.path), workers, warn);
  }
  return params;
}

FibreMaterial::Model FibreMaterial::make(const MaterialParams& params) {
  PELAGE_CHECK(is_one(params));
  return std::visit(Overloaded{[](const ConeShellParams& p) -> Model { return ConeShellMaterial(p); },
                               [](const KajiyaKayParams& p) -> Model { return KajiyaKayMaterial(p); },
                               [](const ChiangParams& p) -> Model { return ChiangMaterial(p); },
                               [](const DeonParams& p) -> Model { return DeonMaterial(p); },
                               [](const MarschnerParams& p) -> Model { return MarschnerMaterial(p); },
                               [](const YanFastParams& p) -> Model { return YanFastMaterial(p); },
                               [](const YanParams& p) -> Model { return YanMaterial(p); },
                               [](const auto&) -> Model { return LambertCylinder{}; }},
                    params);
}

FibreMaterial::FibreMaterial(const MaterialParams& params)
    : model_(make(params)), far_field_(is_far(params)) {}

FibreBsdf FibreMaterial::at(const FibrePoint& point) const {
  const auto frame = [&] { return FibreFrame(point.tangents[0], point.wo); };
  return std::visit(
      Overloaded{
          [&](const ConeShellMaterial& m) -> FibreBsdf {
            return ConeShellBsdf(m, point.color, point.tangents, point.wo);
          },
          [&](const LambertCylinder&) -> FibreBsdf {
            return LambertCylinderBsdf(point.color, frame(), point.h);
          },
          [&](const KajiyaKayMaterial& m) -> FibreBsdf { return KajiyaKayBsdf(m, point.color, frame()); },
          [&](const auto& m) -> FibreBsdf { return m.at(frame(), point.h, point.color); }},
      model_);
}

}  // namespace pelage
