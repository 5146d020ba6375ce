// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "render/material/fibre_params.h"

namespace pelage {

/// Presets of fibre parameters. No table of measured animals was available. Rows A to C come from other
/// implementations of the model, which call them measured and do not name the animals. All others are
/// guesses.
enum class YanPreset {
  kNone,
  kRowA,
  kRowB,
  kRowC,
  kTigerOrange,
  kTigerBlack,
  kTigerWhite,
  kPolarBear,
  kMouse,
  kHuman
};
template <>
struct EnumNames<YanPreset> {
  static constexpr const char* names[] = {"none",        "row-a",       "row-b",      "row-c", "tiger-orange",
                                          "tiger-black", "tiger-white", "polar-bear", "mouse", "human"};
};

/// The parameters of a fibre in [Yan15]: a scattering medulla, surrounded by a cortex, which a cuticle
/// covers. Coefficients are per radius of the fibre, angles in degrees.
struct YanOptics {
  float alpha = 2;    ///< tilt of the cuticle's scales
  float beta_m = 8;   ///< width of the lobes along the fibre
  float beta_n = 10;  ///< width of the lobes around the fibre
  float eta = 1.55f;
  float kappa = 0.8f;           ///< radius of the medulla / radius of the fibre
  float sigma_ms = 2.5f;        ///< scattering coefficient of the medulla
  float g = 0.5f;               ///< mean cosine of the medulla's scattering
  float layers = 0.5f;          ///< count of cuticle layers; 0.5 is one smooth interface
  std::optional<Rgb> sigma_ca;  ///< absorption coefficient of the cortex; empty: derived from the colour
  std::optional<Rgb> sigma_ma;  ///< absorption coefficient of the medulla; empty: derived from the colour
};

/// Parameters of the two models with a medulla. A member that is empty takes its value from the preset.
struct MedullaParams : FibreParams {
  YanPreset preset = YanPreset::kNone;
  std::optional<float> alpha, beta_m, beta_n, eta, kappa, sigma_ms, g, layers;
  std::optional<Rgb> sigma_ca, sigma_ma;
  std::optional<MelaninParams>
      melanin;  ///< absorption of cortex and medulla, if sigma_ca and sigma_ma are empty
  FibreField field = FibreField::kNear;

  /// Returns the preset, with the members that are given in place of its values.
  YanOptics optics() const;
};

/// The lobes of [Yan17], with one analytic lobe for scattering by the medulla.
struct YanFastParams : MedullaParams {
  static constexpr const char* kTypeKey = "model";
  static constexpr const char* kTypeName = "yan-fast";
  static const Schema<YanFastParams>& schema();
};

class MedullaTables;

/// The lobes of [Yan17], with tables for scattering by the medulla.
struct YanParams : MedullaParams {
  static constexpr const char* kTypeKey = "model";
  static constexpr const char* kTypeName = "yan";
  AssetPath tables;  ///< folder that keeps the tables
  /// with_tables() loads or computes the tables. If this is null, FibreMaterial computes them.
  std::shared_ptr<const MedullaTables> made;
  static const Schema<YanParams>& schema();
};

}  // namespace pelage
