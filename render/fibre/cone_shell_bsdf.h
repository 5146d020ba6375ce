// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "render/fibre/cone_shell.h"
#include "render/fibre/fibre_value.h"

namespace pelage {

/// What all points of a fibre material share, computed once.
struct ConeShellMaterial {
  explicit ConeShellMaterial(const ConeShellParams& params);

  /// Where along its strand (0 root, 1 tip) a lobe of a point at `v` takes its tangent: shifted by a fixed
  /// amount and by a random one that is the strand's own and never changes, so that highlights differ from
  /// hair to hair but do not boil in time. Never wraps around.
  float tangent_place(LobeGroup lobe, float v, uint64_t strand_id, uint64_t seed) const;

  float diffuse;  ///< where none is given, what the highlights of a white fibre leave
  float balance;
  Rgb primary;
  Rgb secondary;
  ShellVariant variant;
  ShellShape primary_shape;
  ShellShape secondary_shape;
  std::array<float, kLobeGroups> shift;
  std::array<float, kLobeGroups> jitter;
};

/// Unit tangents by lobe, taken at ConeShellMaterial::tangent_place().
using LobeTangents = std::array<V3f, kLobeGroups>;

/// The cone-shell model at a point of a fibre: a diffuse lobe (the shell that is the whole sphere) with a
/// choice between forward and back scatter, and two specular shells about tangents of their own [Neulander10,
/// Neulander13].
///
/// Never gives back more than it gets: albedos whose sum exceeds one in a channel are scaled down together. A
/// plain value, cheap to make for every vertex of a path: no memory is allocated, trigonometry happens only
/// in sample() and where a literal shell is cut at a pole.
class ConeShellBsdf {
 public:
  /// `color` is the material's colour at the point; `wo` points to the viewer or previous vertex.
  ConeShellBsdf(const ConeShellMaterial& material, const Rgb& color, const LobeTangents& tangents,
                const V3f& wo);

  FibreValue eval(const V3f& wi) const;
  /// Stratification of (u.x, u.y) survives: u.x picks the lobe and, stretched, the polar angle, u.y the
  /// azimuth; u.z balances forward and back scatter.
  std::optional<FibreSample> sample(const V3f& u) const;
  Rgb albedo() const { return albedos_[0] + albedos_[1] + albedos_[2]; }

 private:
  LobeTangents tangents_;
  V3f toward_viewer_;  ///< unit, perpendicular to the diffuse tangent, on the side of wo
  float balance_;
  std::array<ConeShell, kLobeGroups - 1> shells_;
  std::array<Rgb, kLobeGroups> albedos_;
  std::array<float, kLobeGroups> choice_;  ///< probability of each lobe; all zero for a black fibre
};

}  // namespace pelage
