// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "base/schema.h"
#include "base/value_readers.h"
#include "image/field.h"

namespace pelage {

class CoatColor;

/// Parameters that every fibre model has. A user can therefore change the model of a material by changing
/// only the name of the model.
struct FibreParams {
  Field color{Rgb(0.5f, 0.3f, 0.15f)};
  Field opacity{1.0f};
  /// Table that converts `color`. with_tables() loads or computes it for models that need it. If it is null,
  /// FibreMaterial computes it.
  std::shared_ptr<const CoatColor> coat_color = {};
};

/// Near field: scattering depends on where across the fibre a ray hits. Far field: scattering is the mean
/// over the width of the fibre, as if the fibre were too thin to see. To compute this mean, each sample uses
/// a random position across the fibre.
enum class FibreField { kNear, kFar };
template <>
struct EnumNames<FibreField> {
  static constexpr const char* names[] = {"near", "far"};
};

/// A fibre as an opaque diffuse cylinder: the baseline for comparing the other models.
struct LambertCylinderParams : FibreParams {
  static constexpr const char* kTypeKey = "model";
  static constexpr const char* kTypeName = "lambert-cylinder";
  std::optional<Rgb> albedo;  ///< empty: derived from the colour
  FibreField field = FibreField::kNear;
  static const Schema<LambertCylinderParams>& schema();
};

/// Kajiya and Kay's diffuse and specular terms, normalised.
struct KajiyaKayParams : FibreParams {
  static constexpr const char* kTypeKey = "model";
  static constexpr const char* kTypeName = "kajiya-kay";
  std::optional<float> diffuse;  ///< albedo, multiplied by the colour; empty: derived from the colour
  Rgb specular{0.08f};
  float exponent = 40;
  static const Schema<KajiyaKayParams>& schema();
};

/// Presets of pigment concentrations in hair. The absorption of the pigments was measured. The concentrations
/// in human hair are taken from other programs; those in animals are guesses.
enum class HairPreset {
  kNone,
  kHumanBlond,
  kHumanBrown,
  kHumanRed,
  kHumanBlack,
  kPolarBear,
  kFox,
  kMouse,
  kPanther
};
template <>
struct EnumNames<HairPreset> {
  static constexpr const char* names[] = {"none",      "human-blond", "human-brown",
                                          "human-red", "human-black", "polar-bear",
                                          "fox",       "mouse",       "panther"};
};

/// Concentrations of both pigments of hair.
struct MelaninParams {
  float eumelanin = 0, pheomelanin = 0;
  static const Schema<MelaninParams>& schema();
};

/// Absorption of a translucent fibre. If none of these is given, the absorption follows from
/// FibreParams::color.
struct AbsorptionParams {
  HairPreset preset = HairPreset::kNone;  ///< provides the concentrations of pigments that are not given
  /// Coefficient per radius. The absorption of a given pigment is added to it. If it is given, `preset` is
  /// not used.
  std::optional<Rgb> absorption;
  std::optional<MelaninParams> melanin;  ///< both pigments; replaces those of `preset`
  std::optional<float> eumelanin;        ///< concentration of the black and brown pigment
  std::optional<float> pheomelanin;      ///< concentration of the red and yellow pigment
};

/// Height of the lobes: the published height; half of it, which roughly conserves energy; or a height at
/// which a fibre without absorption scatters all light, at every inclination.
enum class MarschnerVariant { kPublished, kHalved, kConserving };
template <>
struct EnumNames<MarschnerVariant> {
  static constexpr const char* names[] = {"published", "halved", "conserving"};
};

struct MarschnerParams : FibreParams, AbsorptionParams {
  static constexpr const char* kTypeKey = "model";
  static constexpr const char* kTypeName = "marschner";
  float eta = 1.55f;
  float alpha = -7.5f;         ///< shift of the R lobe, degrees
  float beta = 7.5f;           ///< width of the R lobe, degrees
  float azimuthal_width = 15;  ///< degrees
  MarschnerVariant variant = MarschnerVariant::kConserving;
  static const Schema<MarschnerParams>& schema();
};

struct DeonParams : FibreParams, AbsorptionParams {
  static constexpr const char* kTypeKey = "model";
  static constexpr const char* kTypeName = "deon";
  float eta = 1.55f;
  float alpha = -2;
  float beta = 10;
  float azimuthal_width = 15;
  FibreField field = FibreField::kFar;
  static const Schema<DeonParams>& schema();
};

struct ChiangParams : FibreParams, AbsorptionParams {
  static constexpr const char* kTypeKey = "model";
  static constexpr const char* kTypeName = "chiang";
  float eta = 1.55f;
  float beta_m = 0.3f;
  float beta_n = 0.3f;
  float alpha = 2;
  FibreField field = FibreField::kNear;
  static const Schema<ChiangParams>& schema();
};

/// Returns the absorption coefficient per radius that follows from `absorption`, the pigments and the preset;
/// empty when none of these is given.
std::optional<Rgb> given_absorption(const AbsorptionParams& params);
class ColorToAbsorption;
/// Returns given_absorption(). When that is empty, returns the absorption that `by_color` computes from
/// `color`.
Rgb fibre_absorption(const AbsorptionParams& params, const ColorToAbsorption& by_color, const Rgb& color);

}  // namespace pelage
