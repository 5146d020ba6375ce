// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/value.h"
#include "base/vector.h"
#include "scene/value_edits.h"
#include "world/scene_schema.h"

namespace pelage {

/// A light, or a magnet, by its name.
struct RigItem {
  std::string name;
  bool is_magnet = false;
  RigItem(std::string light, bool magnet = false) : name(std::move(light)), is_magnet(magnet) {}
  RigItem(const char* light) : name(light) {}
  auto operator<=>(const RigItem&) const = default;

  /// Name of the block of the document that has the item.
  std::string block() const { return is_magnet ? "magnets" : "lights"; }
};

/// What a client has changed about one light or magnet of the scene.
struct LightChange {
  std::string added_type;  ///< type of a new light; empty: the scene has the light
  bool removed = false;
  std::map<std::string, std::vector<double>> values;  ///< new values by key, such as "position"
  /// Of a new light: other keys, with their values as YAML.
  std::map<std::string, std::string> copied = {};
  /// Of a new light: names of files by key, relative to the scene file.
  std::map<std::string, std::string> files = {};
  bool operator==(const LightChange&) const = default;
};
using LightChanges = std::map<RigItem, LightChange>;

/// Returns the changes as edits of a scene file. Removals are last: the block `lights` never becomes empty on
/// the way from one only light to another.
std::vector<ValueEdit> light_change_edits(const LightChanges& changes);
/// Returns the changes as options `--set` of a scene file.
std::vector<Override> light_change_overrides(const LightChanges& changes, const std::filesystem::path& scene);

/// A light or magnet of the scene, as clients draw and move it. In scene units and degrees.
struct ViewLight {
  RigItem item;
  std::string type;
  std::map<std::string, std::vector<double>> values;  ///< of the keys that light_keys() names, and "up"
  bool changed = false;                               ///< by a client; the scene file has another light
};

/// Returns the lights of a scene at a frame, and then its magnets.
std::vector<ViewLight> view_lights(const SceneDescription& scene, double frame, const LightChanges& changes);

/// A key of lights and magnets that clients may change.
struct LightKey {
  std::string name;
  size_t numbers;   ///< how many it has
  double min, max;  ///< of each number
};
/// Returns the keys of a type of light or magnet that clients may change; empty for types without any, such
/// as `environment`. Throws Error (kArguments) with the nearest name for an unknown type.
const std::vector<LightKey>& light_keys(const std::string& type, bool of_magnets = false);

/// Returns the change that adds a copy of a light or magnet at the values `moved`. `document`: of the scene
/// that is shown, and of which `scene` is the file. Throws Error (kArguments) if the document does not have
/// it.
LightChange copy_of(const Value& document, const std::filesystem::path& scene, const RigItem& item,
                    const std::map<std::string, std::vector<double>>& moved);

}  // namespace pelage
