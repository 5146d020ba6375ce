// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "base/schema.h"
#include "base/value_readers.h"
#include "image/field.h"
#include "render/material/fibre_params.h"
#include "render/material/yan_params.h"

namespace pelage {

/// A diffuse skin.
struct LambertParams {
  static constexpr const char* kTypeKey = "model";
  static constexpr const char* kTypeName = "lambert";
  Field color{Rgb(0.5f)};
  bool shadow_catcher = false;  ///< the camera sees only the shadows on it (class ShadowCatcher)
  static const Schema<LambertParams>& schema();
};

/// A diffuse skin under a clear coat, for eyes and noses.
struct GlossyParams {
  static constexpr const char* kTypeKey = "model";
  static constexpr const char* kTypeName = "glossy";
  Field color{Rgb(0.5f)};
  float roughness = 0.1f;
  float ior = 1.5f;
  static const Schema<GlossyParams>& schema();
};

/// Profile across the shells of the two highlights, see render/fibre/cone_shell.h.
enum class ShellVariant { kWigner, kLiteral };
template <>
struct EnumNames<ShellVariant> {
  static constexpr const char* names[] = {"wigner", "literal"};
};

/// Fur, using the cone-shell model of "Rendering Fur in Life of Pi".
struct ConeShellParams : FibreParams {
  static constexpr const char* kTypeKey = "model";
  static constexpr const char* kTypeName = "cone-shell";
  std::optional<float> diffuse;  ///< albedo of the diffuse lobe, times color; empty: derived from color
  float balance = 0;             ///< direction of the diffuse lobe: 1 back to the light, 0 even, -1 forward
  Rgb primary{0.08f};            ///< albedo of the primary highlight, not coloured by the fibre
  float primary_width = 12;      ///< half width of the highlight, degrees
  /// Shading takes the tangent not at the shaded point, but at this distance from it, as a fraction of the
  /// strand; positive: towards the tip. The highlight therefore moves the opposite way.
  float primary_shift = -0.03f;
  float primary_jitter = 0.05f;  ///< max random change of primary_shift per strand
  float primary_tilt = 0;        ///< added to the inclination of the highlight, degrees
  Rgb secondary{0.12f};          ///< albedo of the secondary highlight, multiplied by color
  float secondary_width = 20;
  float secondary_shift = 0.08f;
  float secondary_jitter = 0.08f;
  float secondary_tilt = 0;
  ShellVariant variant = ShellVariant::kWigner;
  static const Schema<ConeShellParams>& schema();
};

using MaterialParams =
    std::variant<LambertParams, GlossyParams, ConeShellParams, LambertCylinderParams, KajiyaKayParams,
                 MarschnerParams, DeonParams, ChiangParams, YanFastParams, YanParams>;

/// Returns the parameters that all fibre models share; null for a skin material.
const FibreParams* fibre_params(const MaterialParams& material);

struct FieldSources;

/// Returns the material with the textures of its fields loaded. Throws Error (kInput) when a texture that the
/// scene names is missing.
MaterialParams with_textures(MaterialParams material, const FieldSources& sources);

}  // namespace pelage
