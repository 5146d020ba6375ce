// SPDX-License-Identifier: Apache-2.0
#include "render/material/material.h"

#include "render/material/fibre_keys.h"

namespace pelage {

namespace {

constexpr double kNarrowest = 1;  // degrees; below, float directions cannot resolve a shell at the poles
constexpr double kWidest =
    90;  // the half width of the whole sphere; the literal weight would be negative beyond

}  // namespace

const Schema<LambertParams>& LambertParams::schema() {
  static const Schema<LambertParams> table = [] {
    Schema<LambertParams> s("lambert", "A diffuse surface: skin, eyes, ground.");
    s.set_example(R"(materials:
  hide: {model: lambert, color: [0.5, 0.35, 0.3]})");
    s.key("color", &LambertParams::color,
          {.help = "Fraction of the light that is reflected, per channel", .min = 0, .max = 1});
    s.key("shadow_catcher", &LambertParams::shadow_catcher,
          {.help = "true: the camera sees the background through the surface, darkened by the shadows of "
                   "direct light on it; alpha is the fraction of light that is lost, so that the picture can "
                   "be composited over a photograph. Other rays meet a surface of this colour. No data layer "
                   "shows it"});
    return s;
  }();
  return table;
}

const Schema<GlossyParams>& GlossyParams::schema() {
  static const Schema<GlossyParams> table = [] {
    Schema<GlossyParams> s("glossy", "A diffuse surface under a clear coat: eyes, noses.");
    s.set_example(R"(materials:
  eye: {model: glossy, color: 0.02, roughness: 0.05})");
    s.key("color", &GlossyParams::color,
          {.help = "Fraction of the light that the base reflects, per channel", .min = 0, .max = 1});
    s.key("roughness", &GlossyParams::roughness,
          {.help = "Roughness of the coat: 0 is a mirror, 1 is matt", .min = 0, .max = 1});
    s.key("ior", &GlossyParams::ior, {.help = "Index of refraction of the coat", .min = 1, .max = 3});
    return s;
  }();
  return table;
}

const Schema<ConeShellParams>& ConeShellParams::schema() {
  static const Schema<ConeShellParams> table = [] {
    using P = ConeShellParams;
    Schema<P> s("cone-shell",
                "Fur by the cone-shell model of 'Rendering Fur in Life of Pi': a diffuse lobe and two "
                "highlights. Each highlight is a shell between two cones about the strand. Albedos that sum "
                "to more than 1 are scaled down.");
    s.set_example(R"(materials:
  fur: {model: cone-shell, color: {attribute: color}})");
    add_color_keys(
        s,
        "Colour of a dense coat, converted to albedo. If diffuse is given, color is not converted but used "
        "as the colour of the fibre's lobes");
    s.key("diffuse", &P::diffuse,
          {.help = "Albedo of the diffuse lobe, multiplied by color. Without this key, Pelage computes the "
                   "albedo from color, so that a white fibre absorbs nothing",
           .min = 0,
           .max = 1});
    s.key("balance", &P::balance,
          {.help = "Direction of diffuse scattering: 1 reflects light mostly to the side that it comes from, "
                   "0 scatters it evenly around the fibre, -1 transmits it mostly through the fibre",
           .min = -1,
           .max = 1});
    s.key("primary", &P::primary,
          {.help = "Albedo of the primary highlight, independent of color", .min = 0, .max = 1});
    s.key("primary_width", &P::primary_width,
          {.unit = "degrees",
           .help = "Half width of the primary highlight",
           .min = kNarrowest,
           .max = kWidest});
    s.key("primary_shift", &P::primary_shift,
          {.unit = "fractions of the strand",
           .help = "Shift of the highlight along the strand: negative values move it toward the tip, "
                   "positive values toward the root. To move it toward the tip, shading uses the tangent of "
                   "a point nearer the root, and vice versa",
           .min = -1,
           .max = 1});
    s.key("primary_jitter", &P::primary_jitter,
          {.unit = "fractions of the strand",
           .help = "Maximum random change of primary_shift per strand, in either direction; it breaks up "
                   "the highlight",
           .min = 0,
           .max = 1});
    s.key("primary_tilt", &P::primary_tilt,
          {.unit = "degrees",
           .help = "Tilt of the highlight's cone: positive toward the root, negative toward the tip. It "
                   "works on straight strands too, where primary_shift changes nothing",
           .min = -45,
           .max = 45});
    s.key("secondary", &P::secondary,
          {.help = "Albedo of the secondary highlight, multiplied by color", .min = 0, .max = 1});
    s.key("secondary_width", &P::secondary_width,
          {.unit = "degrees",
           .help = "Half width of the secondary highlight",
           .min = kNarrowest,
           .max = kWidest});
    s.key("secondary_shift", &P::secondary_shift,
          {.unit = "fractions of the strand",
           .help = "As primary_shift; positive values move the highlight toward the root",
           .min = -1,
           .max = 1});
    s.key("secondary_jitter", &P::secondary_jitter,
          {.unit = "fractions of the strand", .help = "As primary_jitter", .min = 0, .max = 1});
    s.key("secondary_tilt", &P::secondary_tilt,
          {.unit = "degrees", .help = "As primary_tilt", .min = -45, .max = 45});
    s.key("variant", &P::variant,
          {.help = "Profile across a shell: `wigner` has soft edges and is sampled exactly; `literal` is the "
                   "published cosine"});
    return s;
  }();
  return table;
}

const FibreParams* fibre_params(const MaterialParams& material) {
  return std::visit(
      []<class P>(const P& params) -> const FibreParams* {
        if constexpr (std::is_base_of_v<FibreParams, P>) return &params;
        return nullptr;
      },
      material);
}

MaterialParams with_textures(MaterialParams material, const FieldSources& sources) {
  std::visit(
      [&](auto& params) {
        params.color = params.color.with_textures(sources);
        if constexpr (requires { params.opacity; }) params.opacity = params.opacity.with_textures(sources);
      },
      material);
  return material;
}

}  // namespace pelage
