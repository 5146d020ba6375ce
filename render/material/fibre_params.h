// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "base/schema.h"
#include "base/value_readers.h"
#include "image/field.h"

namespace pelage {

class CoatColor;

/// What every model of a fibre has, so that one may be put in another's place by its name alone.
struct FibreParams {
  Field color{Rgb(0.5f, 0.3f, 0.15f)};
  Field opacity{1.0f};
  /// What with_tables() found or made for models that need it. Null: made when the material is.
  std::shared_ptr<const CoatColor> coat_color = {};
};

/// Whether the place across the fibre matters that a ray meets, or all places count alike, as if the fibre
/// were too thin to see. Each sample of a far field draws one place, so that the average is the far field.
enum class FibreField { kNear, kFar };
template <>
struct EnumNames<FibreField> {
  static constexpr const char* names[] = {"near", "far"};
};

/// The non-translucent baseline: a tube that reflects evenly.
struct LambertCylinderParams : FibreParams {
  static constexpr const char* kTypeKey = "model";
  static constexpr const char* kTypeName = "lambert-cylinder";
  std::optional<Rgb> albedo;  ///< none: from the colour
  FibreField field = FibreField::kNear;
  static const Schema<LambertCylinderParams>& schema();
};

/// Kajiya and Kay's diffuse and specular terms, normalised.
struct KajiyaKayParams : FibreParams {
  static constexpr const char* kTypeKey = "model";
  static constexpr const char* kTypeName = "kajiya-kay";
  std::optional<float> diffuse;  ///< times the colour; none: from the colour
  Rgb specular{0.08f};
  float exponent = 40;
  static const Schema<KajiyaKayParams>& schema();
};

/// Hair to start from, by its pigments. How much a pigment absorbs was measured; how much of it is in the
/// hair is a guide of other programs' for people, and a guess for animals.
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

/// How the colour of a translucent fibre is given: by what it absorbs, or else by `color`.
struct AbsorptionParams {
  HairPreset preset = HairPreset::kNone;  ///< counts for pigments that are not given
  std::optional<Rgb> absorption;          ///< per radius
  std::optional<float> eumelanin;         ///< concentration of the black and brown pigment
  std::optional<float> pheomelanin;       ///< of the red and yellow one
};

/// Whether the lobes are those of the paper or half as high, about what
/// energy calls for.
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

/// Absorption per radius by coefficient and pigments; nothing where neither is given.
std::optional<Rgb> given_absorption(const AbsorptionParams& params);
/// The same, or else that of a point whose material has the given colour there.
class ColorToAbsorption;
Rgb fibre_absorption(const AbsorptionParams& params, const ColorToAbsorption& by_color, const Rgb& color);

}  // namespace pelage
