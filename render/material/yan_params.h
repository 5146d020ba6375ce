// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "render/material/fibre_params.h"

namespace pelage {

/// Starting points for fur. No table of measured animals was available: rows A to C are parameters that
/// implementations of the model describe as measured, from unknown animals; all others are guesses.
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

/// A fibre in the terms of [Yan15]: a cortex covered by a cuticle, around a scattering medulla. Coefficients
/// are per radius of the fibre, angles in degrees.
struct YanOptics {
  float alpha = 2;    ///< tilt of the cuticle's scales
  float beta_m = 8;   ///< width of the lobes along the fibre
  float beta_n = 10;  ///< width of the lobes around the fibre
  float eta = 1.55f;
  float kappa = 0.8f;           ///< radius of the medulla / radius of the fibre
  float sigma_ms = 2.5f;        ///< scattering of the medulla
  float g = 0.5f;               ///< mean cosine of the medulla's scattering
  float layers = 0.5f;          ///< layers of the cuticle; half a layer is one smooth interface
  std::optional<Rgb> sigma_ca;  ///< absorption of the cortex; empty: derived from the colour
  std::optional<Rgb> sigma_ma;  ///< absorption of the medulla
};

/// Parameters of both models with a medulla. A number that is not given comes from the preset.
struct MedullaParams : FibreParams {
  YanPreset preset = YanPreset::kNone;
  std::optional<float> alpha, beta_m, beta_n, eta, kappa, sigma_ms, g, layers;
  std::optional<Rgb> sigma_ca, sigma_ma;
  FibreField field = FibreField::kNear;

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
  /// Loaded or computed by with_tables(). Null: computed with the material.
  std::shared_ptr<const MedullaTables> made;
  static const Schema<YanParams>& schema();
};

}  // namespace pelage
