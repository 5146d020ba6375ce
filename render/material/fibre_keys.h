// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/material/fibre_params.h"

// Schema keys that several fibre models share.

namespace pelage {

inline constexpr const char* kColorHelp =
    "Colour of a dense coat, converted to absorption. Unused if a preset, absorption, melanin, eumelanin "
    "or pheomelanin is given";

template <class P>
void add_color_keys(Schema<P>& s, const char* help) {
  s.key("color", static_cast<Field P::*>(&P::color), {.help = help, .min = 0, .max = 1});
  s.key("opacity", static_cast<Field P::*>(&P::opacity),
        {.help = "Opacity of a strand: 1 hides everything behind it, 0 nothing", .min = 0, .max = 1});
}

template <class P>
void add_absorption_keys(Schema<P>& s) {
  using Amount = std::optional<float> P::*;
  s.key(
      "preset", static_cast<HairPreset P::*>(&P::preset),
      {.help =
           "Pigment concentrations to start from. If eumelanin or pheomelanin is set, it replaces the "
           "preset's concentration of that pigment. If absorption is set, it replaces the whole preset. The "
           "absorption of the pigments is measured [dEon11, after Donner and Jensen 2006]. The "
           "concentrations are guide values for people (blond, brown, black), and guesses for red "
           "hair and all animals"});
  s.key("absorption", static_cast<std::optional<Rgb> P::*>(&P::absorption),
        {.unit = "per radius of the fibre",
         .help = "Absorption coefficient. If eumelanin or pheomelanin is also set, the absorption of that "
                 "pigment is added",
         .min = 0,
         .max = 1000});
  s.key("melanin", static_cast<std::optional<MelaninParams> P::*>(&P::melanin),
        {.help = "Both pigments in one block; replaces those of the preset", .default_text = "none"});
  s.key("eumelanin", static_cast<Amount>(&P::eumelanin),
        {.help = "Concentration of the black and brown pigment: 0.3 is blond, 1.3 brown, 8 black",
         .min = 0,
         .max = 100});
  s.key("pheomelanin", static_cast<Amount>(&P::pheomelanin),
        {.help = "Concentration of the red and yellow pigment", .min = 0, .max = 100});
}

template <class P>
void add_eta_key(Schema<P>& s) {
  s.key("eta", &P::eta, {.help = "Index of refraction of the fibre", .min = 1.05, .max = 3});
}

inline KeyOptions field_key() {
  return {.help =
              "`near`: shading depends on where across the fibre a ray hits it; `far`: shading averages over "
              "the width of the fibre"};
}
template <class P>
void add_field_key(Schema<P>& s) {
  s.key("field", &P::field, field_key());
}

}  // namespace pelage
