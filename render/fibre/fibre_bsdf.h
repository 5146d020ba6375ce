// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>
#include <variant>

#include "render/fibre/chiang.h"
#include "render/fibre/cone_shell_bsdf.h"
#include "render/fibre/deon.h"
#include "render/fibre/fibre_value.h"
#include "render/fibre/kajiya_kay.h"
#include "render/fibre/lambert_cylinder.h"
#include "render/fibre/marschner.h"
#include "render/fibre/yan.h"

namespace pelage {

/// Scattering by one fibre, at one point and for one outgoing direction, with any of the models. A plain
/// value that does not allocate. It may refer to the FibreMaterial that made it.
///
/// Conventions: directions are unit vectors in world space that point away from the strand. wo points to the
/// viewer or previous vertex and is fixed on construction; wi points to the light or next vertex and is
/// sampled. Inclination theta is measured from the normal plane: sin theta = dot(w, T), T the unit tangent
/// from root to tip.
class FibreBsdf {
 public:
  using Model = std::variant<ConeShellBsdf, LambertCylinderBsdf, KajiyaKayBsdf, ChiangBsdf, DeonBsdf,
                             MarschnerBsdf, YanFastBsdf, YanBsdf>;

  template <class AnyModel>
  requires std::is_constructible_v<Model, AnyModel> FibreBsdf(AnyModel&& model)
      : model_(std::forward<AnyModel>(model)) {}

  FibreValue eval(const V3f& wi) const {
    return std::visit([&](const auto& model) { return model.eval(wi); }, model_);
  }
  /// Samples wi from the mixture of lobes; `u`: three random numbers in [0, 1). Empty when the direction
  /// has no density, for example because the fibre absorbs everything.
  std::optional<FibreSample> sample(const V3f& u) const {
    return std::visit([&](const auto& model) { return model.sample(u); }, model_);
  }
  /// Integral of rho over all directions wi; approximate for MarschnerBsdf.
  Rgb albedo() const {
    return std::visit([](const auto& model) { return model.albedo(); }, model_);
  }

 private:
  Model model_;
};

}  // namespace pelage
