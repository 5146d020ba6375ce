// SPDX-License-Identifier: Apache-2.0
#include "rib/host/shading_rib.h"

#include <numbers>
#include <optional>

#include "base/value_readers.h"
#include "render/sampling/warp.h"
#include "rib/host/yaml_text.h"

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

  void parameters(const Rgb& radiance, float intensity) const {
    rib.parameter("string name").texts({name});
    rib.parameter("color lightcolor").numbers({radiance.x, radiance.y, radiance.z});
    rib.parameter("float intensity").numbers({intensity});
    rib.parameter("string pelage").texts({yaml_text(block)});
  }
  /// `axis`: direction of emission; 0 for all directions. `area`: as seen from there.
  void begin_area(const Rgb& radiance, float intensity, const V3f& from, const V3f& axis, float area) const {
    rib.request("AttributeBegin");
    rib.request("Attribute").text("identifier").parameter("string name").texts({name});
    rib.request("AreaLightSource").text("arealight").integer(handle);
    parameters(radiance, intensity);
    // For renderers whose lights are points.
    rib.parameter("point from").numbers({from.x, from.y, from.z});
    rib.parameter("vector axis").numbers({axis.x, axis.y, axis.z});
    rib.parameter("float area").numbers({area});
  }
  void end_area() const {
    rib.request("AttributeEnd");
    rib.request("Illuminate").integer(handle).integer(1);
  }

  void operator()(const RectangleLightParams& p) const {
    const V3f center = p.position.at(frame), normal = (p.look_at.at(frame) - center).normalized();
    begin_area(p.radiance, p.intensity.at(frame), center, normal, p.size.x * p.size.y);
    V3f x = p.up.cross(normal), y;
    if (x.length() > 1e-6f * p.up.length()) {
      x.normalize();
    } else {
      complete_frame(normal, x, y);
    }
    y = normal.cross(x);
    x *= 0.5f * p.size.x;
    y *= 0.5f * p.size.y;
    std::vector<float> corners;
    for (const V3f& corner : {center - x - y, center + x - y, center + x + y, center - x + y})
      corners.insert(corners.end(), {corner.x, corner.y, corner.z});
    rib.request("Polygon").parameter("P").numbers(corners);
    end_area();
  }
  void operator()(const SphereLightParams& p) const {
    const V3f center = p.position.at(frame);
    begin_area(p.radiance, p.intensity.at(frame), center, V3f(0),
               std::numbers::pi_v<float> * p.radius * p.radius);
    rib.request("Translate").number(center.x).number(center.y).number(center.z);
    rib.request("Sphere").number(p.radius).number(-p.radius).number(p.radius).number(360);
    end_area();
  }
  void operator()(const EnvironmentLightParams& p) const {
    rib.request("LightSource").text("envlight").integer(handle);
    if (const Value* file = block.find("file"); file && !p.file.empty())
      rib.parameter("string filename").texts({file->text()});
    parameters(p.radiance, p.intensity.at(frame));
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
    const Value& block = *document.find("lights")->find(name);
    std::visit(LightWriter{rib, name, block, frame, ++handle}, light);
  }
}

}  // namespace pelage
