// SPDX-License-Identifier: Apache-2.0
#include "render/material/yan_params.h"

#include "render/material/absorption.h"
#include "render/material/fibre_keys.h"

namespace pelage {
namespace {

YanOptics preset_optics(YanPreset preset) {
  const auto fibre = [](float alpha, float beta_m, float beta_n, float eta, float kappa, float sigma_ms,
                        float g, float layers, const Rgb& sigma_ca, const Rgb& sigma_ma) {
    return YanOptics{alpha, beta_m, beta_n, eta, kappa, sigma_ms, g, layers, sigma_ca, sigma_ma};
  };
  switch (preset) {
    case YanPreset::kNone:
      break;
    case YanPreset::kRowA:
      return fibre(2.64f, 9.45f, 17.63f, 1.49f, 0.86f, 3.15f, 0.79f, 0.68f, {0.2f, 0.4f, 0.6f}, Rgb(0.21f));
    case YanPreset::kRowB:
      return fibre(1.81f, 7.44f, 6.88f, 1.19f, 0.65f, 2.30f, 0.08f, 2, {0.12f, 0.25f, 0.37f}, Rgb(0.14f));
    case YanPreset::kRowC:
      return fibre(5.48f, 11.64f, 7.49f, 1.55f, 0.88f, 1.69f, 0.44f, 0.47f, Rgb(0.64f), Rgb(0.17f));
    case YanPreset::kTigerOrange:
      return fibre(2.64f, 9.45f, 17.63f, 1.49f, 0.86f, 3.15f, 0.79f, 0.68f, {0.12f, 0.45f, 1.4f},
                   {0.05f, 0.15f, 0.4f});
    case YanPreset::kTigerBlack:
      return fibre(2.64f, 9.45f, 17.63f, 1.49f, 0.86f, 3.15f, 0.79f, 0.68f, {2.5f, 2.8f, 3.2f}, Rgb(1.5f));
    case YanPreset::kTigerWhite:
    case YanPreset::kPolarBear:
      return fibre(2.64f, 9.45f, 17.63f, 1.49f, 0.8f, 3, 0.6f, 0.68f, Rgb(0.01f), Rgb(0.01f));
    case YanPreset::kMouse:
      return fibre(2.64f, 9.45f, 17.63f, 1.49f, 0.85f, 2.5f, 0.5f, 0.68f, {0.5f, 0.65f, 0.85f}, Rgb(0.2f));
    case YanPreset::kHuman:
      return fibre(2, 8, 10, 1.55f, 0.3f, 1, 0.5f, 0.5f, melanin_absorption(1.3f, 0), Rgb(0.2f));
  }
  return {};
}

template <class P>
void add_medulla_keys(Schema<P>& s) {
  const auto angle = [&](const char* name, std::optional<float> MedullaParams::*member, const char* help,
                         double min, double max) {
    s.key(name, static_cast<std::optional<float> P::*>(member),
          {.unit = "degrees", .help = help, .min = min, .max = max});
  };
  const auto number = [&](const char* name, std::optional<float> MedullaParams::*member, const char* help,
                          double min, double max, const char* unit = "") {
    s.key(name, static_cast<std::optional<float> P::*>(member),
          {.unit = unit, .help = help, .min = min, .max = max});
  };
  const auto absorption = [&](const char* name, std::optional<Rgb> MedullaParams::*member, const char* help) {
    s.key(name, static_cast<std::optional<Rgb> P::*>(member),
          {.unit = "per radius of the fibre", .help = help, .min = 0, .max = 1000});
  };
  add_color_keys(s,
                 "Colour of a dense coat, converted to the absorption of cortex and medulla. Unused if a "
                 "preset, melanin, or sigma_ca and sigma_ma, are given");
  s.key("preset", static_cast<YanPreset P::*>(&P::preset),
        {.help = "Fibre parameters to start from; the keys below change them. row-a, row-b and row-c are "
                 "parameter sets from other implementations of this model. Those implementations say that "
                 "the values were measured, but not on which animals. The other presets are guesses"});
  angle("alpha", &MedullaParams::alpha, "Tilt of the cuticle scales; 2 without a preset", -15, 15);
  angle("beta_m", &MedullaParams::beta_m, "Width of the lobes along the fibre; 8 without a preset", 0.1, 45);
  angle("beta_n", &MedullaParams::beta_n, "Width of the lobes around the fibre; 10 without a preset", 0.1,
        60);
  number("eta", &MedullaParams::eta, "Index of refraction; 1.55 without a preset", 1.05, 3);
  number("kappa", &MedullaParams::kappa, "Radius of the medulla relative to the fibre; 0.8 without a preset",
         0, 0.98);
  number("sigma_ms", &MedullaParams::sigma_ms, "Scattering coefficient of the medulla; 2.5 without a preset",
         0, 40, "per radius of the fibre");
  number("g", &MedullaParams::g, "Mean cosine of scattering in the medulla; 0.5 without a preset", -0.95,
         0.95);
  number("layers", &MedullaParams::layers,
         "Number of cuticle layers. A layer has two interfaces, so 0.5, the value without a preset, is a "
         "single smooth interface",
         0.05, 10);
  absorption("sigma_ca", &MedullaParams::sigma_ca, "Absorption coefficient of the cortex");
  absorption("sigma_ma", &MedullaParams::sigma_ma, "Absorption coefficient of the medulla");
  s.key("melanin", static_cast<std::optional<MelaninParams> P::*>(&P::melanin),
        {.help = "Pigments, in place of sigma_ca and sigma_ma", .default_text = "none"});
  s.key("field", static_cast<FibreField P::*>(&P::field), field_key());
}

}  // namespace

YanOptics MedullaParams::optics() const {
  YanOptics o = preset_optics(preset);
  o.alpha = alpha.value_or(o.alpha);
  o.beta_m = beta_m.value_or(o.beta_m);
  o.beta_n = beta_n.value_or(o.beta_n);
  o.eta = eta.value_or(o.eta);
  o.kappa = kappa.value_or(o.kappa);
  o.sigma_ms = sigma_ms.value_or(o.sigma_ms);
  o.g = g.value_or(o.g);
  o.layers = layers.value_or(o.layers);
  if (melanin) o.sigma_ca = o.sigma_ma = melanin_absorption(melanin->eumelanin, melanin->pheomelanin);
  if (sigma_ca) o.sigma_ca = sigma_ca;
  if (sigma_ma) o.sigma_ma = sigma_ma;
  return o;
}

const Schema<YanFastParams>& YanFastParams::schema() {
  static const Schema<YanFastParams> table = [] {
    Schema<YanFastParams> s("yan-fast",
                            "Fur by Yan et al. (2017): lobes R, TT and TRT of a fibre with a medulla, and "
                            "one analytic lobe for scattering in the medulla.");
    s.set_example(R"(materials:
  fur: {model: yan-fast, preset: tiger-orange})");
    add_medulla_keys(s);
    return s;
  }();
  return table;
}

const Schema<YanParams>& YanParams::schema() {
  static const Schema<YanParams> table = [] {
    using P = YanParams;
    Schema<P> s("yan",
                "Fur by Yan et al. (2015): as yan-fast, but medulla scattering comes from tables, which "
                "Pelage makes by tracing light through the fibre.");
    s.set_example(R"(materials:
  fur: {model: yan, preset: mouse, tables: fibre_tables})");
    add_medulla_keys(s);
    s.key("tables", &P::tables,
          {.help = "Folder that stores the tables between runs. Without it each run makes them anew",
           .default_text = "none",
           .written = true});
    return s;
  }();
  return table;
}

}  // namespace pelage
