// SPDX-License-Identifier: Apache-2.0
#include "rib/document/rib_values.h"

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "scene/document.h"
#include "scene/yaml_reader.h"

namespace pelage {
namespace {

/// The parameters of a shader as a block. Names are the same as in a scene.
Value settings_block(const RibShader& shader) {
  Value block = Value::map(shader.position, {});
  for (const RibSetting& setting : shader.settings) {
    if (setting.name == "name" || setting.name == "__name") continue;
    if (std::optional<Value> value = rib_setting(setting)) add_entry(block, setting.name, std::move(*value));
  }
  return block;
}

bool is_block(const RibSetting* setting) {
  return setting && setting->strings.size() == 1 && setting->strings[0].starts_with('{');
}

Value attribute_field(const SourcePosition& position, const char* name) {
  Value field = Value::map(position, {});
  add_entry(field, "attribute", rib_text(position, name));
  return field;
}

}  // namespace

Value rib_color(const RibMaterial& material, const SourcePosition& at) {
  return material.strand_color ? attribute_field(at, "color")
                               : rib_vector(at, V3f(material.color.x, material.color.y, material.color.z));
}

void add_opacity(Value& block, const RibMaterial& material, const SourcePosition& at) {
  if (!material.fibre || (material.opacity >= 1 && !material.strand_opacity)) return;
  Value constant = rib_number(at, material.opacity);
  if (!material.strand_opacity) {
    add_entry(block, "opacity", std::move(constant));
    return;
  }
  Value product = Value::map(at, {});
  add_entry(product, "product", Value::list(at, {std::move(constant), attribute_field(at, "opacity")}));
  add_entry(block, "opacity", std::move(product));
}

Value rib_text(const SourcePosition& position, std::string text) {
  return Value::scalar(position, std::move(text), true);
}
Value rib_number(const SourcePosition& position, double number) {
  return Value::scalar(position, fmt::format("{:.9g}", number));
}
Value rib_vector(const SourcePosition& position, const V3f& v) {
  return Value::list(position,
                     {rib_number(position, v.x), rib_number(position, v.y), rib_number(position, v.z)});
}
void add_entry(Value& map, std::string key, Value value) {
  const SourcePosition position = value.position();
  map.entries().push_back({std::move(key), position, std::move(value)});
}

std::optional<Value> rib_setting(const RibSetting& setting) {
  if (setting.strings.size() == 1) return rib_text(setting.position, setting.strings[0]);
  if (setting.numbers.size() == 1) return rib_number(setting.position, setting.numbers[0]);
  if (setting.numbers.empty()) return {};
  std::vector<Value> items;
  for (const float x : setting.numbers) items.push_back(rib_number(setting.position, x));
  return Value::list(setting.position, std::move(items));
}

Value rib_block(const RibSetting& setting) {
  Problems problems;
  DocumentLimits limits;
  std::optional<Value> value;
  if (setting.strings.size() == 1)
    value = read_yaml(setting.strings[0], {}, setting.position, limits, problems);
  problems.throw_if_any();
  if (!value || !value->is_map())
    throw Error(ErrorKind::kInput, setting.position, "expected a block as YAML, such as \"{width: 640}\"");
  return std::move(*value);
}

void RibMaterials::note(const RibMaterial& material) {
  names_.insert(material.name);
  if (material.shader) names_.insert(material.shader->name);
}

Value RibMaterials::material(const RibMaterial& material, std::vector<Problem>& warnings) {
  note(material);
  const RibShader* shader = material.shader.get();
  if (std::optional<Value> own = table_.find(material)) return std::move(*own);
  if (shader && is_block(shader->find("pelage"))) return rib_block(*shader->find("pelage"));
  if (shader && shader->find("model")) return settings_block(*shader);
  if (std::optional<Value> bxdf = rib_bxdf(material)) return std::move(*bxdf);
  const SourcePosition position = shader ? shader->position : SourcePosition{};
  Value block = Value::map(position, {});
  add_entry(block, "model", rib_text(position, material.fibre ? "cone-shell" : "lambert"));
  add_entry(block, "color", rib_color(material, position));
  add_opacity(block, material, position);
  if (shader && unknown_.insert(shader->name).second)
    warnings.push_back(
        {position, "shader " + quote(shader->name) + " is not known; it is rendered as " +
                       (material.fibre ? "cone-shell" : "lambert") +
                       " with the colour of the file (--materials maps shaders to materials)"});
  return block;
}

}  // namespace pelage
