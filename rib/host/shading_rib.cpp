// SPDX-License-Identifier: Apache-2.0
#include "rib/host/shading_rib.h"

#include <cmath>
#include <optional>
#include <vector>

#include "base/value_readers.h"
#include "render/sampling/warp.h"
#include "scene/yaml_text.h"

namespace pelage {
namespace {

std::optional<Rgb> color_of(const Value& value) {
  if (value.is_scalar() && !value.quoted()) {
    const std::optional<double> grey = parse_number(value.text());
    return grey ? std::optional(Rgb(static_cast<float>(*grey))) : std::nullopt;
  }
  if (!value.is_list() || value.items().size() != 3) return {};
  Rgb color;
  for (int c = 0; c < 3; ++c) {
    const Value& item = value.items()[static_cast<size_t>(c)];
    const std::optional<double> number = item.is_scalar() ? parse_number(item.text()) : std::nullopt;
    if (!number) return {};
    color[c] = static_cast<float>(*number);
  }
  return color;
}

void write_parameter(RibWriter& rib, const Value::Entry& entry) {
  const Value& value = entry.value;
  if (value.is_list()) {
    if (const std::optional<Rgb> color = color_of(value))
      rib.parameter("color " + entry.key).numbers({color->x, color->y, color->z});
  } else if (value.is_scalar()) {
    const std::optional<double> number = value.quoted() ? std::nullopt : parse_number(value.text());
    if (number && entry.key == "color") {
      const auto grey = static_cast<float>(*number);
      rib.parameter("color color").numbers({grey, grey, grey});
    } else if (number) {
      rib.parameter("float " + entry.key).numbers({static_cast<float>(*number)});
    } else {
      rib.parameter("string " + entry.key).texts({value.text()});
    }
  }
}

/// Writes the requests of one light.
struct LightWriter {
  RibWriter& rib;
  const std::string& name;
  const Value& block;
  double frame;
  int32_t handle;

  /// `factor`: of the radiance, for shaders whose intensity is no radiance.
  template <class Params>
  void parameters(const Params& p, float factor = 1) const {
    const Rgb color = p.color() * (radiance_without_spread(p) * factor);
    rib.parameter("string name").texts({name});
    rib.parameter("color lightcolor").numbers({color.x, color.y, color.z});
    rib.parameter("float intensity").numbers({p.strength(frame)});
    rib.parameter("string pelage").texts({yaml_text(block)});
  }
  /// `axis`: direction of emission; 0 for all directions. `area`: as seen from there.
  template <class Params>
  void begin_area(const Params& p, const V3f& axis, float area) const {
    const V3f from = p.position.at(frame);
    rib.request("AttributeBegin");
    rib.request("Attribute").text("identifier").parameter("string name").texts({name});
    rib.request("AreaLightSource").text("arealight").integer(handle);
    parameters(p);
    // For renderers whose lights are points.
    rib.parameter("point from").numbers({from.x, from.y, from.z});
    rib.parameter("vector axis").numbers({axis.x, axis.y, axis.z});
    rib.parameter("float area").numbers({area});
  }
  void end_area() const {
    rib.request("AttributeEnd");
    rib.request("Illuminate").integer(handle).integer(1);
  }

  void polygon(const std::vector<V3f>& points) const {
    std::vector<float> corners;
    for (const V3f& corner : points) corners.insert(corners.end(), {corner.x, corner.y, corner.z});
    rib.request("Polygon").parameter("P").numbers(corners);
  }
  template <class Params>
  void sphere(const Params& p) const {
    const V3f center = p.position.at(frame);
    begin_area(p, V3f(0), kPi * p.radius * p.radius);
    rib.request("Translate").number(center.x).number(center.y).number(center.z);
    rib.request("Sphere").number(p.radius).number(-p.radius).number(p.radius).number(360);
    end_area();
  }

  void operator()(const RectangleLightParams& p) const {
    const V3f center = p.position.at(frame), normal = (p.look_at.at(frame) - center).normalized();
    begin_area(p, normal, p.size.x * p.size.y);
    V3f x = p.up.cross(normal), y;
    if (x.length() > 1e-6f * p.up.length()) {
      x.normalize();
    } else {
      complete_frame(normal, x, y);
    }
    y = normal.cross(x);
    x *= 0.5f * p.size.x;
    y *= 0.5f * p.size.y;
    polygon({center - x - y, center + x - y, center + x + y, center - x + y});
    end_area();
  }
  void operator()(const DiskLightParams& p) const {
    const V3f center = p.position.at(frame), normal = (p.look_at.at(frame) - center).normalized();
    begin_area(p, normal, kPi * p.radius * p.radius);
    V3f x, y;
    complete_frame(normal, x, y);
    constexpr int kCorners = 32;
    std::vector<V3f> corners;
    for (int i = 0; i < kCorners; ++i) {
      const float turn = 2 * kPi * static_cast<float>(i) / kCorners;
      corners.push_back(center + p.radius * (std::cos(turn) * x + std::sin(turn) * y));
    }
    polygon(corners);
    end_area();
  }
  void operator()(const SphereLightParams& p) const { sphere(p); }
  void operator()(const PointLightParams& p) const { sphere(p); }
  // Surfaces of the standard shaders reflect color * intensity of these lights, without a factor 1 / pi.
  void operator()(const SpotLightParams& p) const {
    const V3f from = p.position.at(frame), to = p.look_at.at(frame);
    const float half_angle = 0.5f * p.cone * (kPi / 180);
    rib.request("LightSource").text("spotlight").integer(handle);
    parameters(p, p.radius * p.radius);
    rib.parameter("point from").numbers({from.x, from.y, from.z});
    rib.parameter("point to").numbers({to.x, to.y, to.z});
    rib.parameter("float coneangle").numbers({half_angle});
    rib.parameter("float conedeltaangle").numbers({half_angle * p.softness});
    rib.parameter("float beamdistribution").numbers({0});
  }
  void operator()(const SunLightParams& p) const {
    const V3f to = p.direction.at(frame);
    const float sine = std::sin(0.5f * p.angle * (kPi / 180));
    rib.request("LightSource").text("distantlight").integer(handle);
    parameters(p, sine * sine);
    rib.parameter("point from").numbers({0, 0, 0});
    rib.parameter("point to").numbers({to.x, to.y, to.z});
  }
  // Only Pelage knows the mesh; to other renderers, the light is a point where the file's origin is.
  void operator()(const MeshLightParams& p) const {
    const V3f from = V3f(0) * p.transform.matrix();
    rib.request("LightSource").text("pointlight").integer(handle);
    parameters(p);
    rib.parameter("point from").numbers({from.x, from.y, from.z});
  }
  void operator()(const EnvironmentLightParams& p) const {
    rib.request("LightSource").text("envlight").integer(handle);
    if (const Value* file = block.find("file"); file && !p.file.empty())
      rib.parameter("string filename").texts({file->text()});
    parameters(p);
  }
};

}  // namespace

void write_material(RibWriter& rib, const SceneDescription& scene, const Value& document,
                    const std::string& name, const Rgb& tint, const std::optional<Rgb>& mean) {
  const Value& block = *document.find("materials")->find(name);
  std::optional<Rgb> color = mean;
  if (const Value* own = block.find("color")) {
    if (const std::optional<Rgb> constant = color_of(*own)) color = constant;
  }
  if (color) {
    const Rgb tinted = *color * tint;
    rib.request("Color").numbers({tinted.x, tinted.y, tinted.z});
  }
  const bool fibre = fibre_params(scene.materials.find(name)->value) != nullptr;
  rib.request("Surface").text(fibre ? "pelage_fur" : "pelage_skin");
  rib.parameter("string name").texts({name});
  for (const Value::Entry& entry : block.entries()) write_parameter(rib, entry);
  rib.parameter("string pelage").texts({yaml_text(block)});
}

void write_lights(RibWriter& rib, const SceneDescription& scene, const Value& document, double frame) {
  int32_t handle = 0;
  for (const auto& [name, position, light] : scene.lights.items) {
    // A RIB file has other names for the parts that lights are linked to, so it has no links.
    const Value& written = *document.find("lights")->find(name);
    std::vector<Value::Entry> entries = written.entries();
    std::erase_if(entries, [](const Value::Entry& entry) {
      return entry.key == "illuminates" || entry.key == "shadowed_by";
    });
    const Value block = Value::map(written.position(), std::move(entries));
    std::visit(LightWriter{rib, name, block, frame, ++handle}, light);
  }
}

}  // namespace pelage
