// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/vector.h"
#include "scene/value_edits.h"
#include "world/scene_schema.h"

namespace pelage {

/// What a client has changed about one light of the scene.
struct LightChange {
  std::string added_type;  ///< type of a new light; empty: the scene has the light
  bool removed = false;
  std::map<std::string, std::vector<double>> values;  ///< new values by key, such as "position"
  bool operator==(const LightChange&) const = default;
};
using LightChanges = std::map<std::string, LightChange>;  ///< by the name of the light

/// Returns the changes as edits of a scene file. Removals are last: the block `lights` never becomes empty on
/// the way from one only light to another.
std::vector<ValueEdit> light_change_edits(const LightChanges& changes);
/// Returns the changes as options `--set`.
std::vector<Override> light_change_overrides(const LightChanges& changes);

/// A light of the scene, as clients draw and move it. In scene units and degrees.
struct ViewLight {
  std::string name, type;
  std::map<std::string, std::vector<double>> values;  ///< of the keys that light_keys() names, and "up"
  bool changed = false;                               ///< by a client; the scene file has another light
};

/// Returns the lights of a scene at a frame.
std::vector<ViewLight> view_lights(const SceneDescription& scene, double frame, const LightChanges& changes);

/// A key of lights that clients may change.
struct LightKey {
  std::string name;
  size_t numbers;   ///< how many it has
  double min, max;  ///< of each number
};
/// Returns the keys of a type of light that clients may change; empty for types without any, such as
/// `environment`. Throws Error (kArguments) with the nearest name for an unknown type.
const std::vector<LightKey>& light_keys(const std::string& type);

}  // namespace pelage
