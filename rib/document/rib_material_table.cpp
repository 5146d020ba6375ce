// SPDX-License-Identifier: Apache-2.0
#include "rib/document/rib_material_table.h"

#include "base/file.h"
#include "base/nearest_name.h"
#include "rib/document/rib_values.h"
#include "scene/document.h"
#include "scene/yaml_reader.h"

namespace pelage {
namespace {

constexpr size_t kMaxBytes = size_t(16) << 20;

/// The value of a parameter; nullopt if the shader lacks it.
std::optional<Value> parameter(const RibMaterial& material, const std::string& name,
                               const SourcePosition& at) {
  if (name == "Color") {
    if (!material.strand_color)
      return rib_vector(at, V3f(material.color.x, material.color.y, material.color.z));
    Value field = Value::map(at, {});
    add_entry(field, "attribute", rib_text(at, "color"));
    return field;
  }
  const RibSetting* setting = material.shader ? material.shader->find(name) : nullptr;
  return setting ? rib_setting(*setting) : std::nullopt;
}

/// A copy of `value` with the parameters; nullopt if it is a parameter that the shader lacks.
std::optional<Value> filled(const Value& value, const RibMaterial& material) {
  if (value.is_scalar() && value.text().starts_with('$'))
    return parameter(material, value.text().substr(1), value.position());
  Value copy = value;
  if (copy.is_map()) {
    copy.entries().clear();
    for (const Value::Entry& entry : value.entries()) {
      if (std::optional<Value> own = filled(entry.value, material))
        copy.entries().push_back({entry.key, entry.key_position, std::move(*own)});
    }
  } else if (copy.is_list()) {
    copy.items().clear();
    for (const Value& item : value.items()) {
      if (std::optional<Value> own = filled(item, material)) copy.items().push_back(std::move(*own));
    }
  }
  return copy;
}

}  // namespace

RibMaterialTable::RibMaterialTable(const std::filesystem::path& path) {
  Problems problems;
  DocumentLimits limits;
  std::optional<Value> table =
      read_yaml(read_text_file(path, kMaxBytes), path.string(), {}, limits, problems);
  problems.throw_if_any();
  if (!table || !table->is_map())
    throw Error(ErrorKind::kInput, {path.string(), 0, 0},
                "expected a table of materials, such as plastic: {model: glossy, color: $Color}");
  for (const Value::Entry& entry : table->entries()) {
    if (!entry.value.is_map())
      problems.add(entry.value.position(),
                   "expected a material, such as {model: lambert}, got " + entry.value.describe());
  }
  problems.throw_if_any();
  table_ = std::move(*table);
}

std::optional<Value> RibMaterialTable::find(const RibMaterial& material) const {
  const Value* entry = table_.find(material.name);
  if (!entry && material.shader) entry = table_.find(material.shader->name);
  if (!entry) return {};
  if (entry->find("curves") || entry->find("meshes")) {
    const Value* part = entry->find(material.fibre ? "curves" : "meshes");
    if (!part) return {};
    entry = part;
  }
  return filled(*entry, material);
}

void RibMaterialTable::warn_of_unused(const std::set<std::string>& used,
                                      std::vector<Problem>& warnings) const {
  const std::vector<std::string> names(used.begin(), used.end());
  for (const Value::Entry& entry : table_.entries()) {
    if (!used.contains(entry.key))
      warnings.push_back(
          {entry.key_position, "no surface has the shader " + quote(entry.key) + suggest(entry.key, names)});
  }
}

}  // namespace pelage
