// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <Imath/ImathMatrixAlgo.h>

#include "base/nearest_name.h"
#include "rib/document/rib_values.h"

namespace pelage {
namespace {

// Distant and point lights are small spheres.
constexpr float kDistance = 10'000, kDistantHalfAngle = 0.25f, kPointRadius = 0.05f;

V3f color_setting(const RibShader& shader, const char* name, const V3f& otherwise) {
  const RibSetting* setting = shader.find(name);
  if (!setting || setting->numbers.size() != 3) return otherwise;
  return {setting->numbers[0], setting->numbers[1], setting->numbers[2]};
}

float float_setting(const RibShader& shader, const char* name, float otherwise) {
  const RibSetting* setting = shader.find(name);
  return setting && setting->numbers.size() == 1 ? setting->numbers[0] : otherwise;
}

/// Builds the block of one light.
class LightBlock {
 public:
  explicit LightBlock(const RibLight& light)
      : light_(light), shader_(*light.shader), matrix_(light.to_world.at(0)) {
    radiance_ = color_setting(shader_, "lightcolor", V3f(1)) * float_setting(shader_, "intensity", 1);
    block_ = Value::map(shader_.position, {});
  }

  std::optional<Value> make() {
    const std::string& name = shader_.name;
    const auto contains = [&](const char* part) { return name.find(part) != std::string::npos; };
    if (light_.shape == RibLight::Shape::kSphere) {
      sphere(V3f(0) * matrix_, light_.radius * std::cbrt(std::abs(matrix_.determinant())), radiance_);
    } else if (light_.shape == RibLight::Shape::kQuad) {
      if (!quad()) return {};
    } else if (name == "distantlight") {
      const float sine = std::sin(kDistantHalfAngle * std::numbers::pi_v<float> / 180);
      V3f from, to;
      matrix_.multVecMatrix(color_setting(shader_, "from", V3f(0)), from);
      matrix_.multVecMatrix(color_setting(shader_, "to", V3f(0, 0, 1)), to);
      if (!((to - from).length() > 0)) return {};
      sphere(-(to - from).normalized() * kDistance, kDistance * sine, radiance_ / (sine * sine));
    } else if (name == "pointlight") {
      V3f from;
      matrix_.multVecMatrix(color_setting(shader_, "from", V3f(0)), from);
      sphere(from, kPointRadius, radiance_ / (kPointRadius * kPointRadius));
    } else if (name == "ambientlight" || contains("env") || contains("dome") || contains("Dome")) {
      environment();
    } else {
      return {};
    }
    return std::move(block_);
  }

 private:
  void put(const char* key, Value value) { add_entry(block_, key, std::move(value)); }
  void put(const char* key, const V3f& v) { put(key, rib_vector(shader_.position, v)); }
  void put(const char* key, float x) { put(key, rib_number(shader_.position, x)); }
  void put(const char* key, const char* text) { put(key, rib_text(shader_.position, text)); }

  void sphere(const V3f& position, float radius, const V3f& radiance) {
    put("type", "sphere");
    put("position", position);
    put("radius", radius);
    put("radiance", radiance);
  }

  // Counterclockwise as seen from the emitting side.
  bool quad() {
    if (light_.corners.size() != 4) return false;
    const V3f *c = light_.corners.data(), across = c[1] - c[0], up = c[3] - c[0];
    const V3f center = 0.25f * (c[0] + c[1] + c[2] + c[3]), normal = across.cross(up);
    if (!(normal.length() > 0)) return false;
    put("type", "rectangle");
    put("position", center);
    put("look_at", center + normal.normalized() * std::max(across.length(), up.length()));
    put("up", up);
    put("size", Value::list(shader_.position, {rib_number(shader_.position, across.length()),
                                               rib_number(shader_.position, up.length())}));
    put("radiance", radiance_);
    return true;
  }

  void environment() {
    put("type", "environment");
    for (const char* key : {"filename", "texname", "map", "lightColorMap"}) {
      const RibSetting* file = shader_.find(key);
      if (!file || file->strings.size() != 1 || file->strings[0].empty()) continue;
      put("file", rib_text(file->position, file->strings[0]));
      break;
    }
    put("radiance", radiance_);
    M44f rotation = matrix_, mirror;
    mirror.setScale(V3f(1, 1, -1));  // of a left-handed world
    if (rotation.determinant() < 0) rotation = mirror * rotation;
    V3f angles(0);
    if (Imath::removeScalingAndShear(rotation, false)) Imath::extractEulerXYZ(rotation, angles);
    put("rotate", angles * (180 / std::numbers::pi_v<float>));
  }

  const RibLight& light_;
  const RibShader& shader_;
  const M44f matrix_;
  V3f radiance_;
  Value block_;
};

}  // namespace

std::optional<Value> rib_light(const RibLight& light, std::vector<Problem>& warnings) {
  const RibSetting* own = light.shader->find("pelage");
  if (own && own->strings.size() == 1) return rib_block(*own);
  std::optional<Value> block = LightBlock(light).make();
  if (!block)
    warnings.push_back({light.shader->position, "light shader " + quote(light.shader->name) +
                                                    " with this shape is not supported; skipped"});
  return block;
}

}  // namespace pelage
