// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "render/fibre/cone_shell.h"
#include "render/fibre/fibre_value.h"

namespace pelage {

/// Constants that all points of a fibre material share.
struct ConeShellMaterial {
  explicit ConeShellMaterial(const ConeShellParams& params);

  /// Returns the position along the strand (0 root, 1 tip) from which a lobe takes its tangent when the point
  /// at position `v` is shaded. The result is `v` plus a fixed shift of the lobe plus a random shift, clamped
  /// to [0, 1]. The random shift is constant per strand and lobe, so highlights differ from hair to hair but
  /// do not flicker.
  float tangent_place(LobeGroup lobe, float v, uint64_t strand_id, uint64_t seed) const;

  float diffuse;  ///< albedo; by default 1 minus the max components of `primary` and `secondary`
  float balance;
  Rgb primary;
  Rgb secondary;
  ShellVariant variant;
  ShellShape primary_shape;
  ShellShape secondary_shape;
  std::array<float, kLobeGroups> shift;
  std::array<float, kLobeGroups> jitter;
};

/// Unit tangents by lobe, looked up at ConeShellMaterial::tangent_place().
using LobeTangents = std::array<V3f, kLobeGroups>;

/// The cone-shell model at a point of a fibre: a diffuse lobe (the shell that covers the whole sphere) with a
/// balance between forward and back scattering, and two specular shells, each about a separate tangent
/// [Neulander10, Neulander13].
///
/// Never gains energy: albedos whose sum exceeds one in a channel are scaled down together. A plain value
/// that is cheap to construct at every vertex of a path: it does not allocate, and it calls trigonometric
/// functions only in sample() and for a literal shell that is cut off at a pole.
class ConeShellBsdf {
 public:
  /// `color` is the material's colour at the point; `wo` points to the viewer or previous vertex.
  ConeShellBsdf(const ConeShellMaterial& material, const Rgb& color, const LobeTangents& tangents,
                const V3f& wo);

  FibreValue eval(const V3f& wi) const;
  /// Preserves the stratification of (u.x, u.y). u.x selects the lobe and, rescaled, the polar angle; u.y
  /// selects the azimuth; u.z decides between forward and back scattering.
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
