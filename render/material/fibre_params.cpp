// SPDX-License-Identifier: Apache-2.0
#include "render/material/fibre_params.h"

#include "render/material/absorption.h"
#include "render/material/fibre_keys.h"

namespace pelage {

const Schema<LambertCylinderParams>& LambertCylinderParams::schema() {
  static const Schema<LambertCylinderParams> table = [] {
    using P = LambertCylinderParams;
    Schema<P> s("lambert-cylinder",
                "Fur as opaque diffuse cylinders that transmit no light. The baseline for comparing the "
                "other models.");
    s.set_example(R"(materials:
  fur: {model: lambert-cylinder, color: [0.5, 0.3, 0.15]})");
    add_color_keys(s, "Colour of a dense coat, converted to albedo. Unused if albedo is given");
    s.key("albedo", &P::albedo,
          {.help = "Fraction of the light that a fibre reflects, per channel", .min = 0, .max = 1});
    add_field_key(s);
    return s;
  }();
  return table;
}

const Schema<KajiyaKayParams>& KajiyaKayParams::schema() {
  static const Schema<KajiyaKayParams> table = [] {
    using P = KajiyaKayParams;
    Schema<P> s("kajiya-kay",
                "Fur by Kajiya and Kay (1989), normalised: a diffuse term and one highlight about the "
                "strand. Albedos that sum to more than 1 are scaled down.");
    s.set_example(R"(materials:
  fur: {model: kajiya-kay, color: [0.5, 0.3, 0.15], exponent: 60})");
    add_color_keys(
        s,
        "Colour of a dense coat, converted to albedo. If diffuse is given, color is not converted but used "
        "as the colour of the diffuse term");
    s.key("diffuse", &P::diffuse,
          {.help = "Albedo of the diffuse term, multiplied by color. Without this key, Pelage computes the "
                   "albedo from color",
           .min = 0,
           .max = 1});
    s.key("specular", &P::specular,
          {.help = "Albedo of the highlight, independent of color", .min = 0, .max = 1});
    s.key("exponent", &P::exponent,
          {.help = "Exponent of the highlight; larger values make it sharper", .min = 1, .max = 1000});
    return s;
  }();
  return table;
}

const Schema<MarschnerParams>& MarschnerParams::schema() {
  static const Schema<MarschnerParams> table = [] {
    using P = MarschnerParams;
    Schema<P> s("marschner",
                "Hair by Marschner et al. (2003), far field: lobes R, TT and TRT. The published model "
                "returns nearly twice the light it receives; by default, `variant` corrects this.");
    s.set_example(R"(materials:
  fur: {model: marschner, eumelanin: 1.3})");
    add_color_keys(s, kColorHelp);
    add_absorption_keys(s);
    add_eta_key(s);
    s.key("alpha", &P::alpha,
          {.unit = "degrees",
           .help = "Shift of the R lobe; negative values shift it toward the root. TT is shifted by -1/2 "
                   "and TRT by -3/2 of this angle",
           .min = -20,
           .max = 20});
    s.key("beta", &P::beta,
          {.unit = "degrees",
           .help = "Width of the R lobe in theta_h; TT has half and TRT twice this width",
           .min = 0.5,
           .max = 45});
    s.key(
        "azimuthal_width", &P::azimuthal_width,
        {.unit = "degrees",
         .help = "Blur of all lobes around the fibre. It replaces the special case for caustics in the paper",
         .min = 0.5,
         .max = 60});
    s.key("variant", &P::variant,
          {.help = "`published`: the lobes as published; `halved`: half as high, which nearly restores "
                   "energy conservation; `conserving`: scaled at each inclination so that a fibre without "
                   "absorption scatters all light"});
    return s;
  }();
  return table;
}

const Schema<DeonParams>& DeonParams::schema() {
  static const Schema<DeonParams> table = [] {
    using P = DeonParams;
    Schema<P> s("deon",
                "Hair by d'Eon et al. (2011): lobes R, TT, TRT and all longer paths. Conserves energy.");
    s.set_example(R"(materials:
  fur: {model: deon, preset: human-blond})");
    add_color_keys(s, kColorHelp);
    add_absorption_keys(s);
    add_eta_key(s);
    s.key("alpha", &P::alpha,
          {.unit = "degrees",
           .help =
               "Shift of the lobes, as in marschner: the R lobe has its peak at theta_i = -theta_o + 2 alpha",
           .min = -20,
           .max = 20});
    s.key("beta", &P::beta,
          {.unit = "degrees",
           .help = "Width of the R lobe in theta_i; TT has half and TRT twice this width",
           .min = 0.1,
           .max = 60});
    s.key("azimuthal_width", &P::azimuthal_width,
          {.unit = "degrees", .help = "Blur of the lobes around the fibre", .min = 0.1, .max = 90});
    add_field_key(s);
    return s;
  }();
  return table;
}

const Schema<ChiangParams>& ChiangParams::schema() {
  static const Schema<ChiangParams> table = [] {
    using P = ChiangParams;
    Schema<P> s("chiang",
                "Hair and fur by Chiang et al. (2016): the lobes of deon in the near field, with "
                "perceptually uniform roughness.");
    s.set_example(R"(materials:
  fur: {model: chiang, color: [0.5, 0.3, 0.15], beta_m: 0.25, beta_n: 0.3})");
    add_color_keys(s, kColorHelp);
    add_absorption_keys(s);
    add_eta_key(s);
    s.key("beta_m", &P::beta_m, {.help = "Roughness along the fibre", .min = 0.02, .max = 1});
    s.key("beta_n", &P::beta_n, {.help = "Roughness around the fibre", .min = 0.02, .max = 1});
    s.key("alpha", &P::alpha,
          {.unit = "degrees",
           .help = "Tilt of the cuticle scales: moves the primary highlight toward the tip and the secondary "
                   "toward the root",
           .min = -10,
           .max = 10});
    add_field_key(s);
    return s;
  }();
  return table;
}

namespace {

struct Pigments {
  float eumelanin = 0, pheomelanin = 0;
};
Pigments pigments_of(HairPreset preset) {
  switch (preset) {
    case HairPreset::kNone:
    case HairPreset::kPolarBear:
      return {};
    case HairPreset::kHumanBlond:
      return {0.3f, 0};
    case HairPreset::kHumanBrown:
      return {1.3f, 0};
    case HairPreset::kHumanRed:
      return {0.2f, 0.6f};
    case HairPreset::kHumanBlack:
    case HairPreset::kPanther:
      return {8, 0};
    case HairPreset::kFox:
      return {0.1f, 0.9f};
    case HairPreset::kMouse:
      return {0.5f, 0.15f};
  }
  return {};
}

}  // namespace

const Schema<MelaninParams>& MelaninParams::schema() {
  static const Schema<MelaninParams> table = [] {
    Schema<MelaninParams> s(
        "melanin",
        "Pigments of hair, as a way to give its colour: eumelanin is black to brown, "
        "pheomelanin red to yellow. The fibre absorbs per radius eumelanin x (0.419, 0.697, "
        "1.37) + pheomelanin x (0.187, 0.4, 1.05) [dEon11, after Donner and Jensen 2006].");
    s.set_example(R"(materials:
  hair: {model: chiang, melanin: {eumelanin: 0.2, pheomelanin: 0.6}}   # red)");
    s.key("eumelanin", &MelaninParams::eumelanin,
          {.help = "Concentration of the black and brown pigment: 0.3 is blond, 1.3 brown, 8 black",
           .min = 0,
           .max = 100});
    s.key("pheomelanin", &MelaninParams::pheomelanin,
          {.help = "Concentration of the red and yellow pigment", .min = 0, .max = 100});
    return s;
  }();
  return table;
}

std::optional<Rgb> given_absorption(const AbsorptionParams& params) {
  if (!params.absorption && !params.melanin && !params.eumelanin && !params.pheomelanin &&
      params.preset == HairPreset::kNone)
    return std::nullopt;
  // A given absorption overrides the preset.
  Pigments pigments = params.absorption ? Pigments{} : pigments_of(params.preset);
  if (params.melanin) pigments = {params.melanin->eumelanin, params.melanin->pheomelanin};
  return params.absorption.value_or(Rgb(0)) +
         melanin_absorption(params.eumelanin.value_or(pigments.eumelanin),
                            params.pheomelanin.value_or(pigments.pheomelanin));
}

Rgb fibre_absorption(const AbsorptionParams& params, const ColorToAbsorption& by_color, const Rgb& color) {
  const std::optional<Rgb> given = given_absorption(params);
  return given ? *given : by_color(color);
}

}  // namespace pelage
