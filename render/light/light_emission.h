// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "base/keyed.h"
#include "base/schema.h"
#include "base/value_readers.h"
#include "base/vector.h"

namespace pelage {

/// Temperatures in kelvin for which black_body_color() is defined.
inline constexpr double kCoolestBlackBody = 1667, kHottestBlackBody = 25000;

/// Returns the linear Rec. 709 colour of a black body, scaled to luminance 1. `kelvin`: clamped to the range
/// above. The chromaticity is a cubic fit to the Planckian locus [Kang02]. Below about 1900 K, the colour is
/// outside Rec. 709; then its blue is 0.
Rgb black_body_color(float kelvin);

/// The keys that all kinds of lights have.
struct LightEmission {
  Rgb radiance{1};
  Keyed<float> intensity{1.0f};      ///< factor of the radiance
  Keyed<float> exposure{0.0f};       ///< stops: a factor of 2^exposure of the radiance
  std::optional<float> temperature;  ///< K; the radiance is multiplied by black_body_color()
  bool visible = false;              ///< whether the camera sees the light
  bool shadows = true;
  std::optional<std::vector<NameReference>> illuminates;  ///< empty: all characters and coats
  std::optional<std::vector<NameReference>> shadowed_by;  ///< empty: all characters and coats

  /// Returns the radiance without intensity and exposure.
  Rgb color() const;
  /// Returns the factor of intensity and exposure at a frame.
  float strength(double frame) const;
};

/// Adds the common keys to the table of a kind of light.
template <class P>
void add_emission_keys(Schema<P>& s, std::string_view radiance_help, std::string_view radiance_unit = {}) {
  const auto key = [&]<class T>(std::string_view name, T LightEmission::*member, const KeyOptions& options) {
    s.key(name, static_cast<T P::*>(member), options);
  };
  key("radiance", &LightEmission::radiance, {.unit = radiance_unit, .help = radiance_help, .min = 0});
  key("intensity", &LightEmission::intensity, {.help = "Factor on the radiance", .min = 0});
  key("exposure", &LightEmission::exposure,
      {.unit = "stops", .help = "Each stop doubles the radiance", .min = -100, .max = 100});
  key("temperature", &LightEmission::temperature,
      {.unit = "K",
       .help = "Colour of a black body of this temperature, with luminance 1; multiplies the radiance. 2700: "
               "bulb, 6500: daylight",
       .min = kCoolestBlackBody,
       .max = kHottestBlackBody});
  key("visible", &LightEmission::visible,
      {.help = "Whether camera rays see the light; it always lights fur and skin"});
  key("shadows", &LightEmission::shadows, {.help = "Whether anything casts a shadow in this light"});
  key("illuminates", &LightEmission::illuminates,
      {.help =
           "Names of what the light illuminates: characters, crowds, archives, and coats or skins such as "
           "`rat.under`",
       .default_text = "everything"});
  key("shadowed_by", &LightEmission::shadowed_by,
      {.help = "Names of what casts shadows in this light, as for `illuminates`",
       .default_text = "everything"});
}

}  // namespace pelage
