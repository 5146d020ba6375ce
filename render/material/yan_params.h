// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "render/material/fibre_params.h"

namespace pelage {

/// Fur to start from. No table of measured animals could be had: rows A to C are parameters that
/// implementations of the model carry as measured, of animals unknown; all others are guesses.
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

/// A fibre in the terms of [Yan15]: a cortex under a cuticle and about a scattering medulla. Coefficients per
/// radius of the fibre, angles in degrees.
struct YanOptics {
  float alpha = 2;    ///< tilt of the cuticle's scales
  float beta_m = 8;   ///< width of the lobes along the fibre
  float beta_n = 10;  ///< and around it
  float eta = 1.55f;
  float kappa = 0.8f;           ///< radius of the medulla over that of the fibre
  float sigma_ms = 2.5f;        ///< scattering of the medulla
  float g = 0.5f;               ///< its mean cosine
  float layers = 0.5f;          ///< of cuticle; half a layer is one smooth interface
  std::optional<Rgb> sigma_ca;  ///< absorption of the cortex; none: from the colour
  std::optional<Rgb> sigma_ma;  ///< of the medulla
};

/// What both models with a medulla are given. Every number that is not given is the preset's.
struct MedullaParams : FibreParams {
  YanPreset preset = YanPreset::kNone;
  std::optional<float> alpha, beta_m, beta_n, eta, kappa, sigma_ms, g, layers;
  std::optional<Rgb> sigma_ca, sigma_ma;
  FibreField field = FibreField::kNear;

  YanOptics optics() const;
};

/// Lobes of [Yan17] with one analytic lobe for what the medulla scatters.
struct YanFastParams : MedullaParams {
  static constexpr const char* kTypeKey = "model";
  static constexpr const char* kTypeName = "yan-fast";
  static const Schema<YanFastParams>& schema();
};

class MedullaTables;

/// The same with tables of what the medulla scatters.
struct YanParams : MedullaParams {
  static constexpr const char* kTypeKey = "model";
  static constexpr const char* kTypeName = "yan";
  AssetPath tables;  ///< folder in which they are kept
  /// What prepare_fibre() found or made. Null: made when the material is.
  std::shared_ptr<const MedullaTables> made;
  static const Schema<YanParams>& schema();
};

}  // namespace pelage
