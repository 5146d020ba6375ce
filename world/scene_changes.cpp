// SPDX-License-Identifier: Apache-2.0
#include "world/scene_changes.h"

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/hash.h"
#include "base/value.h"
#include "scene/document_hash.h"

namespace pelage {
namespace {

constexpr std::array<std::string_view, 17> kSamplingKeys = {
    "image.filter",       "image.filter_samples", "image.light_layers", "image.event_layers",
    "image.noise_layers", "image.lod_layer",      "render.samples",     "render.adaptive",
    "render.time_limit",  "render.light_samples", "render.bounces",     "render.clamp_indirect",
    "render.seed",        "render.integrator",    "render.indirect",    "render.skin_ball",
    "camera.exposure"};

/// Whether a value contains a map with the key `attribute`: geometry checks that strands have the attribute.
bool names_attribute(const Value& value) {
  if (value.find("attribute")) return true;
  const auto& items = value.is_list() ? value.items() : std::vector<Value>();
  const auto& entries = value.is_map() ? value.entries() : std::vector<Value::Entry>();
  return std::any_of(items.begin(), items.end(), names_attribute) ||
         std::any_of(entries.begin(), entries.end(),
                     [](const Value::Entry& entry) { return names_attribute(entry.value); });
}

void add_keys(const std::string& path, const Value& map, SceneParts& parts) {
  for (const Value::Entry& entry : map.entries()) parts[path + "." + entry.key] = document_hash(entry.value);
}

void add_material(const std::string& path, const Value& material, SceneParts& parts) {
  if (!material.is_map()) {
    parts[path + ".model"] = document_hash(material);
    return;
  }
  for (const Value::Entry& entry : material.entries()) {
    const bool checked = entry.key == "color" && names_attribute(entry.value);
    parts[path + "." + (checked ? "color_attribute" : entry.key)] = document_hash(entry.value);
  }
}

Redo redo_of(const std::string& part) {
  if (std::find(kSamplingKeys.begin(), kSamplingKeys.end(), part) != kSamplingKeys.end())
    return Redo::kSampling;
  if (part.starts_with("lights.") || part.starts_with("magnets.")) return Redo::kSampling;
  if (part.starts_with("camera") || part == "frames") return Redo::kGeometry;
  if (part.starts_with("render.gather.")) {
    // The accelerator widens strands, and `raster` needs other boxes than `rays`.
    const bool shapes = part == "render.gather.min_width" || part == "render.gather.visibility";
    return shapes ? Redo::kGeometry : Redo::kSampling;
  }
  if (!part.starts_with("materials.")) return Redo::kAssets;
  const std::string_view key = std::string_view(part).substr(part.rfind('.') + 1);
  const bool grows = key == "model" || key == "opacity" || key == "color_attribute" || key == "tables";
  return grows ? Redo::kAssets : Redo::kSampling;
}

}  // namespace

SceneParts scene_parts(const Value& document) {
  SceneParts parts;
  for (const Value::Entry& block : document.entries()) {
    if (!block.value.is_map()) {
      parts[block.key] = document_hash(block.value);
      continue;
    }
    std::string names;
    for (const Value::Entry& item : block.value.entries()) {
      const std::string path = block.key + "." + item.key;
      names += item.key + "\n";
      if (block.key == "materials") {
        add_material(path, item.value, parts);
      } else if (path == "render.gather" && item.value.is_map()) {
        add_keys(path, item.value, parts);
      } else {
        parts[path] = document_hash(item.value);
      }
    }
    // The world refers to materials by their position.
    if (block.key == "materials") parts[block.key] = content_hash(std::as_bytes(std::span(names)));
  }
  return parts;
}

Redo compare_scenes(const SceneParts& before, const SceneParts& after) {
  Redo redo = Redo::kNothing;
  const auto compare = [&](const SceneParts& some, const SceneParts& others) {
    for (const auto& [part, hash] : some) {
      const auto other = others.find(part);
      if (other == others.end() || other->second != hash) redo = std::max(redo, redo_of(part));
    }
  };
  compare(before, after);
  compare(after, before);
  return redo;
}

}  // namespace pelage
