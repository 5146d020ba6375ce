// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <variant>

#include "base/job.h"
#include "render/fibre/coat_color.h"
#include "render/fibre/fibre_bsdf.h"
#include "render/material/material.h"

namespace pelage {

/// A point on a fibre where light is scattered, with the inputs of all models.
struct FibrePoint {
  LobeTangents tangents;  ///< the first is the tangent at the point; only cone shells use the others
  V3f wo{0};              ///< unit, towards the viewer or previous vertex
  float h = 0;            ///< position across the fibre, -1 to 1, in the frame of FibreFrame
  Rgb color{0};           ///< the material's colour at the point
};

/// Returns `params` together with the tables that the model and the colour need. Loads or computes the
/// tables. Call this once per run rather than once per frame. Throws Error (kStopped) when the job is
/// stopped.
MaterialParams with_tables(MaterialParams params, const Job& job);

/// A fibre material: the data that all its points share. Thread safety: const members may be called from any
/// thread.
class FibreMaterial {
 public:
  /// Whether the parameters belong to a fibre model.
  static bool is_one(const MaterialParams& params) { return fibre_params(params) != nullptr; }
  /// `params` must belong to a fibre model. Computes the tables that with_tables() has not added. Calls
  /// `look` often while it computes a CoatColor; `look` may throw to stop the computation.
  explicit FibreMaterial(
      const MaterialParams& params, const Workers& workers = Workers::alone(),
      const std::function<void()>& look = [] {});

  /// Returns the scattering at a point. The result refers to this material.
  FibreBsdf at(const FibrePoint& point) const;

  /// Returns the signed distance along the tangent, in radii, from `point` to the place where most of the
  /// light that has crossed the fibre leaves. 0 for opaque models, which reflect light at the hit.
  float farther(const FibrePoint& point) const;

  /// The cone-shell model, whose lobes use tangents from shifted positions on the strand; null for all other
  /// models.
  const ConeShellMaterial* cone_shell() const { return std::get_if<ConeShellMaterial>(&model_); }
  /// Whether FibrePoint::h should be sampled uniformly for each point instead of taken from the hit.
  bool far_field() const { return far_field_; }
  /// Converts colour to absorption. Null for models that have a formula for this, and for materials that do
  /// not use the colour.
  const std::shared_ptr<const CoatColor>& coat_color() const { return coat_color_; }

 private:
  struct LambertCylinder {
    std::optional<Rgb> albedo;
  };
  using Model = std::variant<ConeShellMaterial, LambertCylinder, KajiyaKayMaterial, ChiangMaterial,
                             DeonMaterial, MarschnerMaterial, YanFastMaterial, YanMaterial>;
  static Model make(const MaterialParams& params);
  FibreBsdf at_absorbing(const FibrePoint& point, const Rgb& absorption) const;
  /// Opaque models use `albedo`, translucent ones `paint`: a colour or an absorption, depending on the model.
  FibreBsdf at(const FibrePoint& point, const Rgb& albedo, const Rgb& paint) const;

  Model model_;
  std::shared_ptr<const CoatColor> coat_color_;
  bool far_field_;
  std::optional<float> eta_;  // index of refraction; empty: opaque
};

}  // namespace pelage
