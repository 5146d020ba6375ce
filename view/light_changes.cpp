// SPDX-License-Identifier: Apache-2.0
#include "view/light_changes.h"

#include <type_traits>
#include <utility>
#include <variant>

#include "base/error.h"
#include "base/nearest_name.h"
#include "scene/yaml_text.h"

namespace pelage {
namespace {

constexpr double kFar = 1e9;                                     // scene units
constexpr double kTiny = 1e-6;                                   // scene units: smallest size of a light
constexpr double kCones[] = {0.1, 170}, kSuns[] = {0.001, 180};  // degrees, as the schemas of the lights

std::vector<double> list(const V3f& v) { return {v.x, v.y, v.z}; }

/// Returns the point at which the profile of a lamp aims. Without one in the scene, the lamp shines straight
/// down.
V3f aim_of_profile(const PointLightParams& lamp, double frame) {
  constexpr float kAimRadii = 20;  // so far away that its square does not cover the square of the radius
  return lamp.look_at ? lamp.look_at->at(frame)
                      : lamp.position.at(frame) - V3f(0, kAimRadii * lamp.radius, 0);
}

/// The values of the keys that light_keys() names.
template <class Params>
std::map<std::string, std::vector<double>> values_of(const Params& light, double frame) {
  std::map<std::string, std::vector<double>> values;
  if constexpr (requires { light.position; }) values["position"] = list(light.position.at(frame));
  constexpr bool is_aimed = requires { light.look_at.at(frame); };
  if constexpr (std::is_same_v<Params, PointLightParams>) {
    if (!light.profile.empty()) values["look_at"] = list(aim_of_profile(light, frame));
  }
  if constexpr (is_aimed) values["look_at"] = list(light.look_at.at(frame));
  if constexpr (requires { light.direction; }) values["direction"] = list(light.direction.at(frame));
  if constexpr (is_aimed && requires { light.up; }) values["up"] = list(light.up);
  if constexpr (requires { light.radius; }) values["radius"] = {double{light.radius}};
  if constexpr (requires { light.cone; }) values["cone"] = {double{light.cone}};
  if constexpr (requires { light.angle; }) values["angle"] = {double{light.angle}};
  if constexpr (requires { light.size; }) values["size"] = {double{light.size.x}, double{light.size.y}};
  return values;
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return std::filesystem::absolute(file).parent_path();
}

/// Returns the name of a file as it is in a scene file: relative, unless the file is in a folder elsewhere.
std::string relative_to_scene(const Value& name, const std::filesystem::path& scene) {
  const std::filesystem::path path = name.text();
  const bool from_file = name.position().line > 0;
  const auto absolute = from_file ? folder_of(name.position().file) / path : std::filesystem::absolute(path);
  const auto relative = absolute.lexically_normal().lexically_relative(folder_of(scene).lexically_normal());
  const bool is_below = !relative.empty() && *relative.begin() != "..";
  return (is_below && !(from_file && path.is_absolute()) ? relative : absolute.lexically_normal()).string();
}

/// A new light as YAML: {type: sphere, radius: 0.5}.
std::string block_text(const LightChange& change) {
  std::string text = "{type: " + change.added_type;
  for (const auto& [key, value] : change.copied) {
    if (!change.values.contains(key)) text += ", " + key + ": " + value;
  }
  for (const auto& [key, name] : change.files)
    text += ", " + key + ": " + yaml_text(Value::scalar({}, name, true));
  for (const auto& [key, numbers] : change.values) text += ", " + key + ": " + numbers_text(numbers);
  return text + "}";
}

}  // namespace

std::vector<ValueEdit> light_change_edits(const LightChanges& changes) {
  std::vector<ValueEdit> edits, removals;
  for (const auto& [item, change] : changes) {
    ValueEdit edit{{item.block(), item.name}, {}};
    if (change.removed) {
      edit.removed = true;
      removals.push_back(std::move(edit));
    } else if (!change.added_type.empty()) {
      edit.block = block_text(change);
      edits.push_back(std::move(edit));
    } else {
      for (const auto& [key, numbers] : change.values)
        edits.push_back({{item.block(), item.name, key}, numbers});
    }
  }
  edits.insert(edits.end(), removals.begin(), removals.end());
  return edits;
}

std::vector<Override> light_change_overrides(const LightChanges& changes,
                                             const std::filesystem::path& scene) {
  // Files of overrides are relative to the current folder.
  LightChanges placed = changes;
  for (auto& [item, change] : placed) {
    for (auto& [key, name] : change.files) name = (folder_of(scene) / name).string();
  }
  std::vector<Override> overrides;
  for (const ValueEdit& edit : light_change_edits(placed)) {
    Override override;
    for (const std::string& part : edit.path) override.key += (override.key.empty() ? "" : ".") + part;
    override.value = edit.block.empty() && !edit.removed ? numbers_text(edit.numbers) : edit.block;
    if (edit.removed) override.value = "null";
    overrides.push_back(std::move(override));
  }
  return overrides;
}

std::vector<ViewLight> view_lights(const SceneDescription& scene, double frame, const LightChanges& changes) {
  std::vector<ViewLight> lights;
  const auto add = [&](const RigItem& item, const auto& value) {
    std::visit(
        [&]<class Params>(const Params& params) {
          lights.push_back({item, Params::kTypeName, values_of(params, frame), changes.contains(item)});
        },
        value);
  };
  for (const auto& light : scene.lights.items) add(light.name, light.value);
  for (const auto& magnet : scene.magnets.items) add({magnet.name, true}, magnet.value);
  return lights;
}

const std::vector<LightKey>& light_keys(const std::string& type, bool of_magnets) {
  using Table = std::map<std::string, std::vector<LightKey>>;
  static const LightKey position{"position", 3, -kFar, kFar}, look_at{"look_at", 3, -kFar, kFar},
      radius{"radius", 1, kTiny, kFar}, size{"size", 2, kTiny, kFar};
  static const Table magnets = [] {
    const LightKey share{"share", 1, 0, 1};
    return Table{{"rectangle", {position, look_at, size, share}}, {"sphere", {position, radius, share}}};
  }();
  static const Table lights = [] {
    const LightKey intensity{"intensity", 1, 0, kFar};
    return Table{{"rectangle", {position, look_at, size, intensity}},
                 {"disk", {position, look_at, radius, intensity}},
                 {"sphere", {position, radius, intensity}},
                 {"point", {position, look_at, radius, intensity}},
                 {"spot", {position, look_at, radius, {"cone", 1, kCones[0], kCones[1]}, intensity}},
                 {"sun", {{"direction", 3, -kFar, kFar}, {"angle", 1, kSuns[0], kSuns[1]}, intensity}},
                 {"mesh", {}},
                 {"environment", {}}};
  }();
  const Table& table = of_magnets ? magnets : lights;
  if (const auto found = table.find(type); found != table.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [name, keys] : table) names.push_back(name);
  throw Error(ErrorKind::kArguments, std::string("unknown type of ") + (of_magnets ? "magnet " : "light ") +
                                         quote(type) + suggest(type, names));
}

LightChange copy_of(const Value& document, const std::filesystem::path& scene, const RigItem& item,
                    const std::map<std::string, std::vector<double>>& moved) {
  const Value* block = document.find(item.block());
  const Value* found = block && block->is_map() ? block->find(item.name) : nullptr;
  if (!found || !found->is_map())
    throw Error(ErrorKind::kArguments, quote(item.name) + " is not in the scene file");
  LightChange copy{"", false, moved};
  for (const Value::Entry& entry : found->entries()) {
    if (entry.key == "type")
      copy.added_type = entry.value.text();
    else if ((entry.key == "file" || entry.key == "profile") && entry.value.is_scalar())
      copy.files[entry.key] = relative_to_scene(entry.value, scene);
    else
      copy.copied[entry.key] = yaml_text(entry.value);
  }
  return copy;
}

}  // namespace pelage
