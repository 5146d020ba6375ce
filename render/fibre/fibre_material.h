// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <variant>

#include "base/job.h"
#include "render/fibre/coat_color.h"
#include "render/fibre/fibre_bsdf.h"
#include "render/material/material.h"

namespace pelage {

/// Where light meets a fibre, in terms of what models ask.
struct FibrePoint {
  LobeTangents tangents;  ///< the first is the strand's own; the others matter to cone shells alone
  V3f wo{0};              ///< unit, to the viewer or previous vertex
  float h = 0;            ///< across the fibre, -1 to 1, in the frame of FibreFrame
  Rgb color{0};           ///< the material's colour there
};

/// The parameters with the tables that their model and their colour need found or made: once per run rather
/// than once per frame. Throws Error (kStopped) as Job does.
MaterialParams with_tables(MaterialParams params, const Job& job);

/// A material for fibres: what all its points share, made once. Thread safety: const members may be called
/// from any thread.
class FibreMaterial {
 public:
  /// Whether the parameters are of a model for fibres.
  static bool is_one(const MaterialParams& params) { return fibre_params(params) != nullptr; }
  /// `params` must be of a model for fibres. Tables that with_tables() has not made are made here.
  /// `look` is called often meanwhile and may throw.
  explicit FibreMaterial(
      const MaterialParams& params, const Workers& workers = Workers::alone(),
      const std::function<void()>& look = [] {});

  /// Refers to this material.
  FibreBsdf at(const FibrePoint& point) const;

  /// Where most light leaves a fibre that it met at `point`: so many radii farther along the tangent. It goes
  /// through, or is reflected where it is where the model is opaque.
  float farther(const FibrePoint& point) const;

  /// The cone-shell model, whose lobes take their tangents from places of their own; null for all others.
  const ConeShellMaterial* cone_shell() const { return std::get_if<ConeShellMaterial>(&model_); }
  /// Whether FibrePoint::h should be drawn anew for each point, uniformly, in place of that of the hit.
  bool far_field() const { return far_field_; }
  /// What colours mean; null for models with a formula of their own, and where the colour does not count.
  const std::shared_ptr<const CoatColor>& coat_color() const { return coat_color_; }

 private:
  struct LambertCylinder {
    std::optional<Rgb> albedo;
  };
  using Model = std::variant<ConeShellMaterial, LambertCylinder, KajiyaKayMaterial, ChiangMaterial,
                             DeonMaterial, MarschnerMaterial, YanFastMaterial, YanMaterial>;
  static Model make(const MaterialParams& params);
  FibreBsdf at_absorbing(const FibrePoint& point, const Rgb& absorption) const;
  /// Opaque models look at `albedo`, translucent ones at `paint`: a colour or an absorption, whichever their
  /// at() takes.
  FibreBsdf at(const FibrePoint& point, const Rgb& albedo, const Rgb& paint) const;

  Model model_;
  std::shared_ptr<const CoatColor> coat_color_;
  bool far_field_;
  std::optional<float> eta_;  // index of refraction; none: opaque
};

}  // namespace pelage
