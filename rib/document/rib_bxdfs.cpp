// SPDX-License-Identifier: Apache-2.0
// Materials for the shaders of RenderMan's RIS.
#include <algorithm>
#include <cmath>

#include "rib/document/rib_values.h"

namespace pelage {
namespace {

/// Builds the block of one material.
class BxdfBlock {
 public:
  explicit BxdfBlock(const RibMaterial& material)
      : material_(material), shader_(*material.shader), block_(Value::map(shader_.position, {})) {}

  std::optional<Value> make() {
    const std::string& name = shader_.name;
    const bool hair = name == "PxrMarschnerHair" || name == "PxrHair";
    if (hair && material_.fibre) {
      marschner();
    } else if (hair || name == "PxrDiffuse" || name == "PxrLMDiffuse") {
      diffuse({"diffuseColor", "frontColor", "specularColorTT", "specularColorTRT"}, "diffuseGain");
    } else if (name == "PxrSurface" || name == "PxrLayerSurface") {
      const bool gloss = brightest("specularFaceColor", 0) > 0 || brightest("specularEdgeColor", 0) > 0;
      surface("diffuseColor", "diffuseGain", gloss, "specularRoughness", "specularIor");
    } else if (name == "PxrDisney" || name == "PxrDisneyBsdf") {
      surface("baseColor", "", brightest("specular", 0.5f) > 0, "roughness", "ior");
    } else {
      return {};
    }
    RibMaterial presence = material_;
    presence.opacity *= std::clamp(number("presence", 1), 0.0f, 1.0f);
    add_opacity(block_, presence, shader_.position);
    return std::move(block_);
  }

 private:
  float number(const char* name, float otherwise) const {
    const RibSetting* setting = shader_.find(name);
    return setting && setting->numbers.size() == 1 ? setting->numbers[0] : otherwise;
  }
  float brightest(const char* name, float otherwise) const {
    const RibSetting* setting = shader_.find(name);
    if (!setting || setting->numbers.empty()) return otherwise;
    return *std::max_element(setting->numbers.begin(), setting->numbers.end());
  }
  void put(const char* key, const char* text) { add_entry(block_, key, rib_text(shader_.position, text)); }
  void put(const char* key, float number) { add_entry(block_, key, rib_number(shader_.position, number)); }

  /// The first colour among parameters that is not black; that of the strands or of the request Color if none
  /// is stated.
  Value color(std::initializer_list<const char*> names, float gain) const {
    bool stated = false;
    for (const char* name : names) {
      const RibSetting* setting = shader_.find(name);
      if (!setting) continue;
      if (setting->type == "primvar") return rib_color(material_, setting->position);
      if (setting->numbers.size() != 3) continue;
      stated = true;
      V3f value(setting->numbers[0], setting->numbers[1], setting->numbers[2]);
      if (!(brightest(name, 0) > 0)) continue;
      value *= gain;
      for (int c = 0; c < 3; ++c) value[c] = std::clamp(value[c], 0.0f, 1.0f);
      return rib_vector(setting->position, value);
    }
    return stated ? rib_vector(shader_.position, V3f(0)) : rib_color(material_, shader_.position);
  }

  void diffuse(std::initializer_list<const char*> names, const char* gain) {
    put("model", material_.fibre ? "cone-shell" : "lambert");
    add_entry(block_, "color", color(names, number(gain, 1)));
  }

  void surface(const char* color_name, const char* gain, bool gloss, const char* roughness, const char* ior) {
    diffuse({color_name}, gain);
    if (material_.fibre || !gloss) return;
    block_ = Value::map(shader_.position, {});
    put("model", "glossy");
    add_entry(block_, "color", color({color_name}, number(gain, 1)));
    put("roughness", std::clamp(number(roughness, 0.2f), 0.0f, 1.0f));
    put("ior", std::clamp(brightest(ior, 1.5f), 1.0f, 3.0f));
  }

  /// The lobes have the meaning of [Marschner03]; only their gains are not those of a real fibre.
  void marschner() {
    put("model", "marschner");
    add_entry(block_, "color", color({"diffuseColor", "specularColorTT", "specularColorTRT"}, 1));
    if (shader_.find("specularIor")) put("eta", std::clamp(brightest("specularIor", 1.55f), 1.1f, 2.5f));
    if (shader_.find("specularOffset")) put("alpha", std::clamp(number("specularOffset", -3), -20.0f, 20.0f));
    if (shader_.find("specularConeAngleR"))
      put("beta", std::clamp(number("specularConeAngleR", 8), 0.5f, 45.0f));
  }

  const RibMaterial& material_;
  const RibShader& shader_;
  Value block_;
};

}  // namespace

std::optional<Value> rib_bxdf(const RibMaterial& material) {
  return material.shader ? BxdfBlock(material).make() : std::nullopt;
}

}  // namespace pelage
