// SPDX-License-Identifier: Apache-2.0
#include "world/presets.h"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "base/nearest_name.h"
#include "scene/document.h"
#include "starter/animal_preset.h"
#include "world/scene_schema.h"

namespace pelage {
namespace {

void place_at(Value& value, const SourcePosition& position) {
  value.set_position(position);
  for (Value& item : value.items()) place_at(item, position);
  for (Value::Entry& entry : value.entries()) {
    entry.key_position = position;
    place_at(entry.value, position);
  }
}

/// Reads a text of a preset. All values get the position of the name, so that messages point there.
Value parsed(const std::string& text, const SourcePosition& position) {
  Value value = parse_document(text, "preset");
  place_at(value, position);
  return value;
}

void erase(Value& block, std::string_view key) {
  std::erase_if(block.entries(), [&](const Value::Entry& entry) { return entry.key == key; });
}

void merge(Value& base, Value&& over);

/// The name of an item of `operators`; empty if the item is malformed.
std::string operator_name(const Value& item) {
  return item.is_map() && item.entries().size() == 1 ? item.entries().front().key : "";
}

void merge_operators(Value& base, Value&& over) {
  if (!over.is_list()) {
    base = std::move(over);
    return;
  }
  base.set_position(over.position());
  std::set<std::string> merged;
  for (Value& item : over.items()) {
    const std::string name = operator_name(item);
    const auto same = std::find_if(base.items().begin(), base.items().end(),
                                   [&](const Value& known) { return operator_name(known) == name; });
    if (!name.empty() && same != base.items().end() && merged.insert(name).second) {
      if (!item.entries().front().value.is_null()) merge(*same, std::move(item));
    } else {
      merged.insert(name);
      base.items().push_back(std::move(item));
    }
  }
}

/// Whether two blocks describe the same kind of thing. Fields of different kinds, such as a ramp and a map,
/// replace each other.
bool are_alike(const Value& base, const Value& over) {
  if (!base.is_map() || !over.is_map()) return false;
  return base.entries().size() != 1 || over.find(base.entries().front().key);
}

void merge(Value& base, Value&& over) {
  for (Value::Entry& entry : over.entries()) {
    Value* known = base.find(entry.key);
    if (!known) {
      base.entries().push_back(std::move(entry));
    } else if (entry.key == "operators") {
      merge_operators(*known, std::move(entry.value));
    } else if (are_alike(*known, entry.value)) {
      merge(*known, std::move(entry.value));
    } else {
      *known = std::move(entry.value);
    }
  }
}

/// Returns the animal that the block names under `preset`, or nullptr with a problem.
const AnimalCoat* animal_of(const Value& preset, Problems& problems) {
  const AnimalCoat* animal = preset.is_scalar() ? find_animal_coat(preset.text()) : nullptr;
  if (animal) return animal;
  std::vector<std::string> names;
  for (const AnimalCoat& known : animal_coats()) names.emplace_back(known.name);
  problems.add(preset.position(),
               preset.is_scalar()
                   ? "there is no preset " + quote(preset.text()) + suggest(preset.text(), names)
                   : "expected the name of a preset, got " + preset.describe());
  return nullptr;
}

void expand_groom(Value& groom, double units_per_mm, Problems& problems) {
  Value* preset = groom.find("preset");
  if (!preset) {
    if (const Value* density = groom.find("preset_density"))
      problems.add(density->position(), "`preset_density` needs `preset`");
    return;
  }
  const AnimalCoat* animal = animal_of(*preset, problems);
  double part = 1;
  if (const Value* given = groom.find("preset_density")) {
    const KeyInfo& key = *GroomParams::schema().find("preset_density");
    if (!ValueReader<double>::read(*given, key.options, part, problems)) animal = nullptr;
  }
  if (animal) {
    Value expanded = parsed(groom_text(*animal, units_per_mm, part), preset->position());
    if (groom.find("strands") || groom.find("strands_file")) erase(expanded, "density");
    erase(groom, "preset");
    erase(groom, "preset_density");
    expanded.set_position(groom.position());
    merge(expanded, std::move(groom));
    groom = std::move(expanded);
  } else {  // a density, so that no message about a missing one follows
    const SourcePosition position = preset->position();
    erase(groom, "preset");
    erase(groom, "preset_density");
    groom.entries().push_back({"density", position, Value::scalar(position, "1")});
  }
}

/// The table that reads a material with a `model`; nullptr if there is no such model.
const SchemaInfo* table_of(Value material) {
  const SchemaInfo* table = nullptr;
  Value named = Value::map({}, {{"material", {}, std::move(material)}});
  SceneDescription::schema().find("materials")->visit_blocks(named, [&](Value&, const SchemaInfo& of) {
    table = &of;
  });
  return table;
}

/// Puts the colour of an animal into a material that has a model of its own. Names that are presets of the
/// model itself, such as `fox` of chiang, keep that meaning.
void expand_color(Value& material, const SchemaInfo& table, Problems& problems) {
  const Value preset = *material.find("preset");
  const AnimalCoat* animal = preset.is_scalar() ? find_animal_coat(preset.text()) : nullptr;
  const KeyInfo* own = table.find("preset");
  if (own && (!animal || (own->type + " ").find(" " + preset.text() + " ") != std::string::npos)) return;
  erase(material, "preset");
  if (!animal) animal_of(preset, problems);
  if (!animal) return;
  Value expanded = parsed(material_text(*animal), preset.position());
  for (const char* key : {"color", "melanin"}) {
    Value* value = expanded.find(key);
    const bool is_given = material.find("color") || material.find("absorption") || material.find(key);
    if (value && !is_given && table.find(key))
      material.entries().push_back({key, preset.position(), std::move(*value)});
  }
}

void expand_material(Value& material, Problems& problems) {
  Value* preset = material.find("preset");
  if (!preset) return;
  if (material.find("model")) {
    if (const SchemaInfo* table = table_of(material)) expand_color(material, *table, problems);
    return;
  }
  const AnimalCoat* animal = animal_of(*preset, problems);
  // Without a model, the reader would report a second mistake.
  Value expanded = animal ? parsed(material_text(*animal), preset->position())
                          : parsed("{model: cone-shell}", preset->position());
  erase(material, "preset");
  expanded.set_position(material.position());
  if (material.find("color") || material.find("absorption")) erase(expanded, "melanin");
  if (animal) merge(expanded, std::move(material));
  material = std::move(expanded);
}

}  // namespace

void expand_presets(Value& document, Problems& problems) {
  double units_per_mm = 1e-3 / UnitsParams().meters_per_unit;
  Value* units = document.find("units");
  if (const Value* meters = units ? units->find("meters_per_unit") : nullptr) {
    Problems reported_later;
    double value = 0;
    if (ValueReader<double>::read(*meters, {}, value, reported_later) && value > 0)
      units_per_mm = 1e-3 / value;
  }
  const auto each = [&](const char* key, const auto& expand) {
    Value* named = document.find(key);
    if (!named || !named->is_map()) return;
    for (Value::Entry& entry : named->entries()) {
      if (entry.value.is_map()) expand(entry.value);
    }
  };
  each("grooms", [&](Value& groom) { expand_groom(groom, units_per_mm, problems); });
  each("materials", [&](Value& material) { expand_material(material, problems); });
}

}  // namespace pelage
