// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <Imath/ImathMatrixAlgo.h>

#include "base/nearest_name.h"
#include "rib/document/rib_values.h"

namespace pelage {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kDistantAngle = 0.5f;  // degrees; shadows of distant lights are nearly sharp
// The names of maps end with these, see TextureLibrary. Maps of other renderers are not lat-long images.
constexpr const char* kMapEndings[] = {".hdr", ".exr", ".tif", ".tiff", ".tx", ".png", ".jpg", ".jpeg"};

V3f color_setting(const RibShader& shader, const char* name, const V3f& otherwise) {
  const RibSetting* setting = shader.find(name);
  if (!setting || setting->numbers.size() != 3) return otherwise;
  return {setting->numbers[0], setting->numbers[1], setting->numbers[2]};
}

float float_setting(const RibShader& shader, const char* name, float otherwise) {
  const RibSetting* setting = shader.find(name);
  return setting && setting->numbers.size() == 1 ? setting->numbers[0] : otherwise;
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// Builds the block of one light.
class LightBlock {
 public:
  explicit LightBlock(const RibLight& light)
      : light_(light),
        shader_(*light.shader),
        name_(lower(shader_.name)),
        matrix_(light.to_world.at(0)),
        block_(Value::map(shader_.position, {})) {
    radiance_ = color_setting(shader_, light.is_ris ? "lightColor" : "lightcolor", V3f(1)) *
                float_setting(shader_, "intensity", 1) * std::exp2(float_setting(shader_, "exposure", 0));
  }

  /// Why the block is only similar to the light; empty if it is not.
  const std::string& difference() const { return difference_; }

  std::optional<Value> make() {
    for (int c = 0; c < 3; ++c) {
      if (!std::isfinite(radiance_[c]))
        difference_ = "is black, because its radiance is too large for a float";
      radiance_[c] = std::isfinite(radiance_[c]) ? std::max(radiance_[c], 0.0f) : 0;
    }
    if (!(light_.is_ris ? ris() : light_.shape == RibLight::Shape::kPoint ? by_name() : area())) return {};
    if (float_setting(shader_, "enableTemperature", 0) != 0) {
      // Those of the renderer are clamped, too.
      put("temperature", std::clamp(float_setting(shader_, "temperature", 6500), 1667.0f, 25000.0f));
    }
    if (float_setting(shader_, "enableShadows", 1) == 0) put("shadows", "false");
    const bool visible = light_.visible && !contains("distant");
    if (visible || is("environment")) put("visible", visible ? "true" : "false");
    return std::move(block_);
  }

 private:
  bool contains(const char* part) const { return name_.find(part) != std::string::npos; }
  bool is(const char* type) const { return block_.find("type")->text() == type; }
  void put(const char* key, Value value) { add_entry(block_, key, std::move(value)); }
  void put(const char* key, const V3f& v) { put(key, rib_vector(shader_.position, v)); }
  void put(const char* key, float x) { put(key, rib_number(shader_.position, x)); }
  void put(const char* key, const char* text) { put(key, Value::scalar(shader_.position, text)); }

  bool area() {
    if (light_.shape == RibLight::Shape::kPolygon) return polygon(light_.corners);
    if (light_.shape != RibLight::Shape::kSphere) return false;
    sphere(V3f(0) * matrix_, light_.radius * scale(), radiance_);
    return true;
  }

  /// The names of the standard shaders, and what shaders of other programs usually have in their names.
  bool by_name() {
    const bool from = shader_.find("from"), to = shader_.find("to");
    if (contains("ambient") || contains("env") || contains("dome") || contains("sky") || contains("hemi")) {
      environment();
    } else if (contains("distant") || contains("direction") || contains("dirlight") || contains("sun")) {
      return distant(color_setting(shader_, "from", V3f(0)), color_setting(shader_, "to", V3f(0, 0, 1)),
                     kDistantAngle);
    } else if (contains("spot") || (to && (from || is_unknown()))) {
      return spot();
    } else if (contains("point") || from || is_unknown()) {
      if (is_unknown() && !from) difference_ = "is not known; it shines from its origin in all directions";
      lamp("point");
    } else if (contains("area")) {
      return square(0.5f, 1);
    } else {
      return false;
    }
    return true;
  }

  /// Whether the name says only that this is a light; "uberlight" is in many scenes.
  bool is_unknown() const {
    return (contains("light") || contains("uber")) && !contains("point") && !contains("spot") &&
           !contains("area");
  }

  /// A square around the origin. `along`: the z axis along which it shines, 1 or -1.
  bool square(float half, float along) {
    std::vector<V3f> corners;
    for (const V2f& p : {V2f(-1, -1), V2f(1, -1), V2f(1, 1), V2f(-1, 1)})
      corners.push_back(half * V3f(p.x, along * p.y, 0) * matrix_);
    return polygon(corners);
  }

  /// The lights of RIS have the size 1 and shine along -z.
  bool ris() {
    if (contains("dome") || contains("env")) {
      environment();
    } else if (contains("rect") || contains("portal")) {
      return square(0.5f, -1);
    } else if (contains("disk")) {
      return disk();
    } else if (contains("distant")) {
      return distant(V3f(0), V3f(0, 0, -1), float_setting(shader_, "angleExtent", 0.53f));
    } else if (contains("sphere") || contains("cylinder")) {
      if (contains("cylinder")) difference_ = "is a sphere";
      sphere(V3f(0) * matrix_, 0.5f * scale(), radiance_);
    } else {
      return false;
    }
    return true;
  }

  float scale() const { return std::cbrt(std::abs(matrix_.determinant())); }

  /// Its irradiance is `radiance_` times pi, whatever its size. `angle`: diameter in degrees.
  bool distant(V3f from, V3f to, float angle) {
    matrix_.multVecMatrix(V3f(from), from);
    matrix_.multVecMatrix(V3f(to), to);
    if (!((to - from).length() > 0)) return false;
    put("type", "sun");
    put("direction", (to - from).normalized());
    put("angle", std::clamp(angle, 0.02f, 120.0f));
    put("irradiance", kPi);
    put("radiance", radiance_);
    return true;
  }

  /// A small lamp of the radiant intensity pi * radiance_.
  void lamp(const char* type) {
    V3f position;
    matrix_.multVecMatrix(color_setting(shader_, "from", V3f(0)), position);
    put("type", type);
    put("position", position);
    put("power", 4 * kPi * kPi);
    put("radiance", radiance_);
  }

  /// The standard shader's cosine between the borders of its cone has the same cubic step as ours.
  bool spot() {
    V3f from = color_setting(shader_, "from", V3f(0)), to = color_setting(shader_, "to", V3f(0, 0, 1));
    matrix_.multVecMatrix(V3f(from), from);
    matrix_.multVecMatrix(V3f(to), to);
    if (!((to - from).length() > 0)) return false;
    const float half = std::clamp(float_setting(shader_, "coneangle", kPi / 6), 1e-3f, 85 * kPi / 180);
    lamp("spot");
    put("look_at", to);
    put("cone", half * (360 / kPi));
    put("softness", std::clamp(float_setting(shader_, "conedeltaangle", kPi / 36) / half, 0.0f, 1.0f));
    if (float_setting(shader_, "beamdistribution", 0) > 0)
      difference_ = "is as bright beside its axis as on it";
    return true;
  }

  bool disk() {
    V3f center = V3f(0) * matrix_, forward;
    matrix_.multDirMatrix(V3f(0, 0, -1), forward);
    const float area = matrix_.determinant() / forward.length();
    if (!(forward.length() > 0) || !(std::abs(area) > 0)) return false;
    put("type", "disk");
    put("position", center);
    put("look_at", center + forward);
    put("radius", 0.5f * std::sqrt(std::abs(area)));
    put("radiance", radiance_);
    return true;
  }

  void sphere(const V3f& position, float radius, const V3f& radiance) {
    put("type", "sphere");
    put("position", position);
    put("radius", radius);
    put("radiance", radiance);
  }

  /// The emitting side is that from which the corners are counterclockwise in a right-handed space. Each
  /// mirror in the transform exchanges the sides, because it also makes the object's space left-handed. A
  /// polygon that is no rectangle becomes a square of the same area.
  bool polygon(const std::vector<V3f>& corners) {
    const size_t n = corners.size();
    if (n < 3) return false;
    V3f center(0), normal(0);  // the length of `normal` is twice the area
    for (size_t i = 0; i < n; ++i) {
      center += corners[i] / static_cast<float>(n);
      normal += (corners[i] - corners[0]).cross(corners[(i + 1) % n] - corners[0]);
    }
    const float area = 0.5f * normal.length();
    if (!(area > 0)) return false;
    V3f across = corners[1] - corners[0], up = corners[n - 1] - corners[0];
    float width = across.length(), height = up.length();
    const float error = (corners[0] + corners[2] - corners[1] - corners[n - 1]).length();
    if (n != 4 || error > 1e-3f * (width + height) || std::abs(across.dot(up)) > 1e-3f * width * height) {
      width = height = std::sqrt(area);
      up = normal.cross(across);
      difference_ = "is a square of the same area";
    }
    if (matrix_.determinant() < 0) normal = -normal;
    put("type", "rectangle");
    put("position", center);
    put("look_at", center + normal.normalized() * std::max(width, height));
    put("up", up);
    put("size", Value::list(shader_.position,
                            {rib_number(shader_.position, width), rib_number(shader_.position, height)}));
    put("radiance", radiance_);
    return true;
  }

  void environment() {
    put("type", "environment");
    if (!light_.map.empty()) {
      const std::string ending = lower(light_.map.extension().string());
      if (std::find(std::begin(kMapEndings), std::end(kMapEndings), ending) == std::end(kMapEndings)) {
        difference_ = "has constant light, because its map " + quote(light_.map.filename().string()) +
                      " is no lat-long image";
      } else {
        put("file", rib_text(shader_.position, light_.map.string()));
      }
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
  const std::string name_;  // of the shader, in lower case
  const M44f matrix_;
  V3f radiance_;
  Value block_;
  std::string difference_;
};

}  // namespace

std::optional<Value> RibLights::light(const RibLight& light, std::vector<Problem>& warnings) {
  const RibSetting* own = light.shader->find("pelage");
  if (own && own->strings.size() == 1) return rib_block(*own);
  LightBlock maker(light);
  std::optional<Value> block = maker.make();
  const std::string why = block ? maker.difference() : "with this shape is not supported; skipped";
  if (!why.empty() && warned_.insert(light.shader->name + why).second)
    warnings.push_back(
        {light.shader->position,
         "light " + (block ? quote(light.shader->name) : "shader " + quote(light.shader->name)) + " " + why});
  return block;
}

}  // namespace pelage
