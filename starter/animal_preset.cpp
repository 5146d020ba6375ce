// SPDX-License-Identifier: Apache-2.0
#include "starter/animal_preset.h"

#include <algorithm>

#include <fmt/format.h>

namespace pelage {
namespace {

/// Above this coverage, more strands do not make a coat look denser.
constexpr double kDense = 8;

double coverage(const AnimalCoat& animal) {
  return animal.density / 100 * animal.length_mm * animal.diameter_um / 1000;
}

std::string digits(double value) { return fmt::format("{:.4g}", value); }

}  // namespace

std::string groom_text(const AnimalCoat& a, double units_per_mm, double part) {
  const auto length = [&](double millimetres) { return digits(millimetres * units_per_mm); };
  const double thicker = std::max(1.0, std::min(1.0, kDense / coverage(a)) / part);
  // Wider than this, strands are needles.
  const double width =
      std::min(thicker * a.diameter_um / 1000, std::max(a.length_mm / 12.0, 1e-3 * a.diameter_um));
  std::string text = fmt::format(
      "{{density: {}, points: {}, operators: [{{length: {{value: {}, variation: {}}}}}, "
      "{{comb: {{lift: {}, curve: 0.4}}}}, ",
      digits(a.density * part * 0.01 / (units_per_mm * units_per_mm)), a.points, length(a.length_mm),
      digits(a.variation), digits(a.lift));
  if (a.bend > 0) text += fmt::format("{{bend: {{angle: {}, variation: 0.5}}}}, ", digits(a.bend));
  text += fmt::format(
      "{{noise: {{amplitude: {}, frequency: {}}}}}, {{clump: {{spacing: {}, amount: {}, profile: 0.9, "
      "variation: 0.5, "
      "strays: 0.15, levels: [{{spacing: {}, amount: {}}}]}}}}, ",
      length(a.waves_mm), digits(0.25 / (a.clump_mm * units_per_mm)), length(a.clump_mm), digits(a.clumped),
      length(0.35 * a.clump_mm), digits(a.clumped));
  if (a.curl_mm > 0) {
    text += fmt::format("{{curl: {{radius: {}, turns: {}, angle_variation: 0.3, start: 0.2}}}}, ",
                        length(a.curl_mm), digits(a.turns));
  }
  text += fmt::format(
      "{{frizz: {{amplitude: {}, frequency: 2}}}}, {{width: {{root: {}, tip: {}, profile: 2.5, variation: "
      "0.3}}}}",
      length(a.frizz_mm), length(width), length(width * a.tip));
  if (*a.knots) {
    text += fmt::format(", {{color: {{variation: 0.2, value: {{ramp: {{along: strand, knots: {}}}}}}}}}",
                        a.knots);
  }
  return text + "]}";
}

std::string material_text(const AnimalCoat& animal) {
  return fmt::format("{{{}{}}}", animal.optics, *animal.knots ? ", color: {attribute: color}" : "");
}

CoatLook proportional_look(const AnimalCoat& a) {
  CoatLook look{};
  look.name = a.name;
  look.help = a.help;
  look.length = a.length_mm / a.body_mm;
  look.coverage = static_cast<float>(std::clamp(coverage(a), 5.0, 10.0));
  look.strands = 250000;
  look.lift = a.lift;
  look.droop = a.bend > 20 ? 0.8f : 0.45f;
  look.bend = a.bend;
  look.waves = a.waves_mm / a.length_mm;
  look.clump = a.clump_mm / a.body_mm;
  look.clumped = a.clumped;
  look.frizz = a.frizz_mm / a.length_mm;
  look.curl = a.curl_mm / a.length_mm;
  look.turns = a.turns;
  look.points = a.points;
  look.root = a.root;
  look.animal = &a;
  return look;
}

}  // namespace pelage
