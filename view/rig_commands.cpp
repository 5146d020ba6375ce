// SPDX-License-Identifier: Apache-2.0
#include "view/rig_commands.h"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/nearest_name.h"
#include "scene/document.h"
#include "view/command_values.h"
#include "view/light_changes.h"

namespace pelage {
namespace {

using nlohmann::json;

constexpr size_t kMostChanges = 10'000;

/// Whether a request is about magnets.
bool is_of_magnets(const json& request) {
  const std::array<std::string, 2> blocks{"lights", "magnets"};
  return request.contains("block") && read_choice(request, "block", blocks) == "magnets";
}

/// Reads new values of a light or magnet. `type`: its type.
std::map<std::string, std::vector<double>> read_light_values(const json& request, const std::string& type) {
  const bool of_magnets = is_of_magnets(request);
  const std::vector<LightKey>& known = light_keys(type, of_magnets);
  const auto values = request.find("values");
  std::map<std::string, std::vector<double>> read;
  if (values == request.end()) return read;
  std::vector<std::string> names;
  for (const LightKey& key : known) names.push_back(key.name);
  check_object(*values, std::string("values of a ") + (of_magnets ? "magnet" : "light") + " of type " + type,
               names);
  for (const LightKey& key : known) {
    if (const auto value = values->find(key.name); value != values->end())
      read[key.name] = read_numbers(*value, key.name, key.numbers, key.min, key.max);
  }
  return read;
}

/// Returns a light or magnet of the shown picture by the key `light` of a request. Throws Error (kArguments)
/// for one that options `--set` cannot address.
ViewLight read_light(const json& request, const ViewStatus& status) {
  const bool of_magnets = is_of_magnets(request);
  std::vector<std::string> names;
  for (const ViewLight& light : status.lights) {
    if (light.item.is_magnet == of_magnets) names.push_back(light.item.name);
  }
  const RigItem item(read_choice(request, "light", names), of_magnets);
  if (item.name.find('.') != std::string::npos)
    refuse_command("light " + quote(item.name) +
                   ": a name with a dot cannot be changed here; edit the file by hand");
  return *std::find_if(status.lights.begin(), status.lights.end(),
                       [&](const ViewLight& light) { return light.item == item; });
}

/// Returns a name that no light or magnet of the block has: the stem, or one with a number behind it.
RigItem new_item(std::string stem, bool is_magnet, const ViewStatus& status, const LightChanges& changes) {
  const auto is_taken = [&](const RigItem& item) {
    return changes.contains(item) || std::any_of(status.lights.begin(), status.lights.end(),
                                                 [&](const ViewLight& light) { return light.item == item; });
  };
  RigItem item(stem, is_magnet);
  for (int number = 2; is_taken(item); ++number) item.name = fmt::format("{}_{}", stem, number);
  return item;
}

/// Returns a name without the number that new_item() has given it.
std::string stem_of(const std::string& name) {
  const size_t digits = name.find_last_not_of("0123456789") + 1;
  const bool numbered = digits > 1 && digits < name.size() && name[digits - 1] == '_';
  return numbered ? name.substr(0, digits - 1) : name;
}

/// Adds a light or magnet to the changes. `stem`: of its name.
json add_item(const CommandContext& context, const std::string& stem, bool is_magnet,
              const LightChange& added) {
  const ViewStatus status = context.state.status();
  std::string name;
  context.state.control().change_rig([&](LightChanges& changes) {
    if (changes.size() >= kMostChanges)
      refuse_command("too many changes; write them into the scene file first");
    const RigItem item = new_item(stem, is_magnet, status, changes);
    changes[item] = added;
    name = item.name;
  });
  return {{"light", name}};
}

json run_add(const CommandContext& context, const json& request) {
  const bool is_magnet = is_of_magnets(request);
  const auto given = request.find("type");
  const std::string type =
      given != request.end() && given->is_string() ? given->get<std::string>() : std::string();
  const auto values = read_light_values(request, type);
  if (light_keys(type, is_magnet).empty())
    refuse_command("a light of type " + type + " has no place to drag; add it by hand");
  return add_item(context, is_magnet ? "magnet" : type, is_magnet, {type, false, values});
}

json run_copy(const CommandContext& context, const json& request) {
  const ViewLight light = read_light(request, context.state.status());
  const auto values = read_light_values(request, light.type);
  std::vector<Override> overrides = context.overrides;
  for (Override& override : light_change_overrides(context.state.control().lights(), context.scene))
    overrides.push_back(std::move(override));
  const Value document = load_document(context.scene, overrides);
  return add_item(context, stem_of(light.item.name), light.item.is_magnet,
                  copy_of(document, context.scene, light.item, values));
}

json run_change(const CommandContext& context, const json& request) {
  const ViewLight light = read_light(request, context.state.status());
  const auto values = read_light_values(request, light.type);
  const auto gesture = request.find("gesture");
  const std::string step =
      gesture != request.end() && gesture->is_string() ? gesture->get<std::string>() : "";
  context.state.control().change_rig(
      [&](LightChanges& changes) {
        for (const auto& [key, numbers] : values) changes[light.item].values[key] = numbers;
      },
      step);
  return json::object();
}

json run_remove(const CommandContext& context, const json& request) {
  const RigItem item = read_light(request, context.state.status()).item;
  context.state.control().change_rig([&](LightChanges& changes) {
    const bool is_new = changes.contains(item) && !changes[item].added_type.empty();
    if (is_new)
      changes.erase(item);
    else
      changes[item] = {"", true, {}};
  });
  return json::object();
}

json run_written(const CommandContext& context, const std::string& action) {
  ViewControl& control = context.state.control();
  const LightChanges changes = control.lights();
  if (changes.empty()) refuse_command("the lights are those of the scene: nothing to write");
  json answer = lights_answer(context, action, light_change_edits(changes));
  if (action == "write") control.end_lights(changes);
  return answer;
}

}  // namespace

json run_rig(const CommandContext& context, const std::string& body) {
  const std::array<std::string, 6> keys{"action", "block", "light", "type", "values", "gesture"};
  const std::array<std::string, 8> actions{"change", "add",  "copy", "remove",
                                           "reset",  "undo", "text", "write"};
  const json request = read_object(body, keys);
  const std::string action = read_choice(request, "action", actions);
  if (action == "change") return run_change(context, request);
  if (action == "add") return run_add(context, request);
  if (action == "copy") return run_copy(context, request);
  if (action == "remove") return run_remove(context, request);
  if (action == "reset") {
    context.state.control().change_rig([](LightChanges& changes) { changes.clear(); });
    return json::object();
  }
  if (action == "undo") {
    if (!context.state.control().undo_rig()) refuse_command("nothing to undo");
    return json::object();
  }
  return run_written(context, action);
}

}  // namespace pelage
