// SPDX-License-Identifier: Apache-2.0
// Bxdf and Pattern: the shaders of RIS, as surfaces whose inputs are constant.
#include <cmath>

#include "base/nearest_name.h"
#include "rib/scene/rib_interpreter.h"

namespace pelage {
namespace {

bool is_reference(const RibSetting& setting) {
  return setting.type.starts_with(kRibReference) && setting.strings.size() == 1;
}

/// The colour that a fibre with these pigments has in a dense coat [Chiang16, equation 9 with a roughness of
/// 0.3; pigments by d'Eon].
std::vector<float> hair_color(float melanin, float redness) {
  constexpr float kEumelanin[] = {0.419f, 0.697f, 1.37f}, kPheomelanin[] = {0.187f, 0.4f, 1.05f};
  const float amount = -std::log(std::max(1 - melanin, 1e-4f));
  std::vector<float> color;
  for (int c = 0; c < 3; ++c) {
    const float absorption = amount * ((1 - redness) * kEumelanin[c] + redness * kPheomelanin[c]);
    color.push_back(std::exp(-5.888f * std::sqrt(absorption)));
  }
  return color;
}

}  // namespace

// Pattern "PxrHairColor" "handle" ...
void RibInterpreter::pattern(const Call& call) {
  RibStatement& request = call.request();
  if (request.arguments.size() < 2 || request.arguments[1].strings.size() != 1)
    request.fail("expected a type and a handle");
  const std::string handle = request.arguments[1].strings[0];
  // Blocks share the patterns of the blocks around them until they have one of their own.
  if (now_.patterns.use_count() > 1) now_.patterns = std::make_shared<RibPatterns>(*now_.patterns);
  (*now_.patterns)[handle] = shader_of(request, 2);
}

/// Returns the value of a parameter that a pattern computes; empty if Pelage does not know it. A primitive
/// variable is a setting of the type "primvar" with its name.
std::optional<RibSetting> RibInterpreter::value_of(const RibSetting& reference, int depth) const {
  constexpr int kMaxDepth = 20;
  const std::string& text = reference.strings[0];
  const size_t colon = text.find(':');
  const auto found = now_.patterns->find(text.substr(0, colon));
  if (found == now_.patterns->end() || depth > kMaxDepth) return {};
  const RibShader& node = *found->second;
  const auto number = [&](const char* name, float otherwise) {
    const RibSetting* setting = node.find(name);
    return setting && setting->numbers.size() == 1 ? setting->numbers[0] : otherwise;
  };
  RibSetting value{
      reference.name, reference.type.substr(kRibReference.size()), reference.position, false, {}, {}};
  if (node.name == "PxrPrimvar") {
    const RibSetting* name = node.find("varname");
    value.type = "primvar";
    if (name) value.strings = name->strings;
    return name ? std::optional(value) : std::nullopt;
  }
  if (node.name == "PxrHairColor" && node.find("melanin")) {
    value.numbers = hair_color(number("melanin", 0.5f), number("melaninRedness", number("redness", 0)));
    return value;
  }
  const std::string output = colon == std::string::npos ? "" : text.substr(colon + 1);
  for (const std::string& input : {output, std::string("color"), std::string("inputRGB"),
                                   std::string("value"), std::string("input"), std::string("baseColor")}) {
    const RibSetting* setting = node.find(input);
    if (!setting) continue;
    if (is_reference(*setting)) {
      std::optional<RibSetting> inner = value_of(*setting, depth + 1);
      if (inner) inner->name = reference.name;
      return inner;
    }
    value.numbers = setting->numbers;
    value.strings = setting->strings;
    return value;
  }
  return {};
}

// Bxdf "PxrMarschnerHair" "handle" ...
void RibInterpreter::bxdf(const Call& call) {
  RibStatement& request = call.request();
  const bool handle = request.arguments.size() > 1 && request.arguments.size() % 2 == 0;
  const std::string name =
      handle && request.arguments[1].strings.size() == 1 ? request.arguments[1].strings[0] : std::string();
  RibShader shader = *shader_of(request, handle ? 2 : 1);
  std::vector<RibSetting> settings;
  for (RibSetting& setting : shader.settings) {
    if (!is_reference(setting)) {
      settings.push_back(std::move(setting));
    } else if (std::optional<RibSetting> value = value_of(setting)) {
      settings.push_back(std::move(*value));
    } else {
      warn_once("reference " + setting.strings[0], setting.position,
                "the pattern " + quote(setting.strings[0]) + " of " + setting.name +
                    " is not supported; the parameter has its default");
    }
  }
  if (!name.empty()) settings.push_back({"name", "string", shader.position, false, {}, {name}});
  shader.settings = std::move(settings);
  now_.surface = std::make_shared<const RibShader>(std::move(shader));
}

}  // namespace pelage
