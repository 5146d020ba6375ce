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
/// only its name.
struct FibreParams {
  Field color{Rgb(0.5f, 0.3f, 0.15f)};
  Field opacity{1.0f};
  /// Loaded or computed by with_tables() for models that need it. Null: computed with the material.
  std::shared_ptr<const CoatColor> coat_color = {};
};

/// Near field: scattering depends on where a ray hits across the fibre. Far field: it is averaged across the
/// fibre, as if the fibre were too thin to see; each sample draws one position, so that the mean is the far
/// field.
enum class FibreField { kNear, kFar };
template <>
struct EnumNames<FibreField> {
  static constexpr const char* names[] = {"near", "far"};
};

/// The opaque baseline: a diffuse cylinder.
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
  std::optional<float> diffuse;  ///< times the colour; empty: derived from the colour
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

/// Absorption of a translucent fibre. If none of these is given, it follows from FibreParams::color.
struct AbsorptionParams {
  HairPreset preset = HairPreset::kNone;  ///< used for pigments that are not given
  std::optional<Rgb> absorption;          ///< per radius
  std::optional<float> eumelanin;         ///< concentration of the black and brown pigment
  std::optional<float> pheomelanin;       ///< concentration of the red and yellow pigment
};

/// Height of the lobes: as published, or half of it. Half the height roughly conserves energy.
enum class MarschnerVariant { kPublished, kHalved };
template <>
struct EnumNames<MarschnerVariant> {
  static constexpr const char* names[] = {"published", "halved"};
};

struct MarschnerParams : FibreParams, AbsorptionParams {
  static constexpr const char* kTypeKey = "model";
  static constexpr const char* kTypeName = "marschner";
  float eta = 1.55f;
  float alpha = -7.5f;         ///< shift of the R lobe, degrees
  float beta = 7.5f;           ///< width of the R lobe, degrees
  float azimuthal_width = 15;  ///< degrees
  MarschnerVariant variant = MarschnerVariant::kHalved;
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

/// Absorption per radius from the coefficient or the pigments; empty when neither is given.
std::optional<Rgb> given_absorption(const AbsorptionParams& params);
/// given_absorption() or, when that is empty, the absorption for a material colour.
class ColorToAbsorption;
Rgb fibre_absorption(const AbsorptionParams& params, const ColorToAbsorption& by_color, const Rgb& color);

}  // namespace pelage
