// SPDX-License-Identifier: Apache-2.0
#include "view/scene_commands.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/nearest_name.h"
#include "base/vector.h"
#include "scene/value_edits.h"
#include "view/command_context.h"
#include "view/command_values.h"
#include "view/light_changes.h"
#include "view/rig_commands.h"
#include "view/scene_edit.h"
#include "world/frames.h"
#include "world/scene_schema.h"

namespace pelage {
namespace {

/// A change of one light: its radiance is multiplied by 2^stops and by the tint.
struct LightMix {
  std::string light;
  double stops = 0;
  Rgb tint{1};
};

const LightParams& find_light(const SceneDescription& scene, const std::string& name) {
  std::vector<std::string> names;
  for (const auto& light : scene.lights.items) {
    if (light.name == name) return light.value;
    names.push_back(light.name);
  }
  throw Error(ErrorKind::kArguments, "no light " + quote(name) + suggest(name, names));
}

/// Returns the values that make these changes: the stops change `intensity`, the tint changes `radiance`. If
/// `intensity` has keyframes, both change `radiance`. Throws Error (kArguments) with the nearest name for a
/// light that the scene does not have.
std::vector<ValueEdit> light_edits(const SceneDescription& scene, const std::vector<LightMix>& mixes) {
  std::vector<ValueEdit> edits;
  for (const LightMix& mix : mixes) {
    const LightParams& light = find_light(scene, mix.light);
    const auto [radiance, intensity] =
        std::visit([](const auto& params) { return std::pair(params.radiance, params.intensity); }, light);
    const double gain = std::exp2(mix.stops);
    const bool animated = !intensity.is_constant();
    if (mix.stops != 0 && !animated)
      edits.push_back({{"lights", mix.light, "intensity"}, {gain * double{intensity.at(0)}}});
    const Rgb factor = mix.tint * (animated ? static_cast<float>(gain) : 1.0f);
    if (factor == Rgb(1)) continue;
    const Rgb changed = radiance * factor;
    edits.push_back({{"lights", mix.light, "radiance"}, {changed.x, changed.y, changed.z}});
  }
  for (const ValueEdit& edit : edits) {
    for (const double number : edit.numbers) {
      if (!(number <= double{std::numeric_limits<float>::max()}))
        throw Error(ErrorKind::kArguments, "lights." + edit.path[1] + ": the light is too bright");
    }
  }
  return edits;
}

using nlohmann::json;

constexpr double kFarthest = 1e9;  // scene units
constexpr double kMaxStops = 20;
constexpr double kMaxTint = 1e3;
constexpr double kMaxPixel = 65536;  // as image.width

V3f read_point(const json& request, const char* key) {
  const auto found = request.find(key);
  const std::vector<double> v =
      read_numbers(found == request.end() ? json() : *found, key, 3, -kFarthest, kFarthest);
  return V3f(static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]));
}

CameraMove read_move(const json& request, const V3f& up) {
  const CameraMove move{read_point(request, "position"), read_point(request, "look_at")};
  constexpr float kMinSine = 1e-3f;  // of the angle between the view axis and `up`
  const V3f axis = (move.look_at - move.position).normalized();
  if (!(axis.cross(up.normalized()).length() > kMinSine))
    throw Error(ErrorKind::kArguments,
                "look_at: the camera must not be at its target, or look along its up vector");
  return move;
}

json run_camera(const CommandContext& context, const std::string& body) {
  const std::array<std::string, 3> keys{"action", "position", "look_at"};
  const std::array<std::string, 4> actions{"move", "reset", "text", "write"};
  const json request = read_object(body, keys);
  const std::string action = read_choice(request, "action", actions);
  ViewControl& control = context.state.control();
  if (action == "move") {
    const CameraMove move = read_move(request, context.state.status().camera.up);
    context.state.update([](ViewStatus& status) { status.camera_note.clear(); });
    control.set_camera(move);
    return json::object();
  }
  if (action == "reset") {
    context.state.update([](ViewStatus& status) { status.camera_note.clear(); });
    control.set_camera({});
    return json::object();
  }
  const std::optional<CameraMove> move = control.camera();
  if (!move) throw Error(ErrorKind::kArguments, "the camera is that of the scene: nothing to write");
  if (action == "write") control.begin_writing();
  try {
    json answer = values_answer(context, action, camera_edits(*move));
    if (action == "write") control.end_camera(*move);
    return answer;
  } catch (...) {
    control.take_written();
    throw;
  }
}

/// Ends changes of values that a mix has written, which they would hide.
void end_mixed(ViewControl& control, const std::vector<ValueEdit>& edits) {
  control.change_lights([&](LightChanges& changes) {
    for (const ValueEdit& edit : edits) {
      const auto change = changes.find(edit.path[1]);
      if (change == changes.end() || change->second.values.erase(edit.path[2]) == 0) continue;
      if (change->second == LightChange()) changes.erase(change);
    }
  });
}

LightMix read_mix(const std::string& light, const json& value) {
  const std::array<std::string, 2> keys{"stops", "tint"};
  check_object(value, "lights." + light, keys);
  LightMix mix{light, 0, Rgb(1)};
  if (const auto stops = value.find("stops"); stops != value.end())
    mix.stops = read_number(*stops, "stops", -kMaxStops, kMaxStops);
  if (const auto tint = value.find("tint"); tint != value.end()) {
    const std::vector<double> v = read_numbers(*tint, "tint", 3, 0, kMaxTint);
    mix.tint = Rgb(static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]));
  }
  return mix;
}

json run_lights(const CommandContext& context, const std::string& body) {
  const std::array<std::string, 3> keys{"action", "edit", "lights"};
  const std::array<std::string, 2> actions{"text", "write"};
  const json request = read_object(body, keys);
  const std::string action = read_choice(request, "action", actions);
  const auto lights = request.find("lights");
  if (lights == request.end() || !lights->is_object())
    throw Error(ErrorKind::kArguments, "lights: expected an object with the changed lights");
  std::vector<LightMix> mixes;
  for (const auto& [light, value] : lights->items()) mixes.push_back(read_mix(light, value));
  const auto edit = request.find("edit");
  const int64_t shown = edit != request.end() && edit->is_number_integer() ? edit->get<int64_t>() : -1;
  const ViewStatus status = context.state.status();
  std::vector<Override> overrides = context.overrides;
  for (Override& override : light_change_overrides(context.state.control().lights(), context.scene))
    overrides.push_back(std::move(override));
  const SceneDescription file = load_scene(context.scene, overrides);
  const auto changed = [&](const LightMix& mix) {
    const std::string part = "lights." + mix.light;
    const SceneParts &now = file.parts, &then = status.edit->scene.parts;
    return now.contains(part) != then.contains(part) || (now.contains(part) && now.at(part) != then.at(part));
  };
  if (!status.edit || shown != status.edits || std::any_of(mixes.begin(), mixes.end(), changed))
    throw Error(ErrorKind::kArguments, "the scene has changed since this picture; look at the new one first");
  std::vector<ValueEdit> edits = light_edits(status.edit->scene, mixes);
  if (edits.empty()) throw Error(ErrorKind::kArguments, "lights: nothing is changed");
  if (action == "text") return lights_answer(context, action, edits);
  // The file does not have lights that the view has added: they keep the values until they are written.
  ViewControl& control = context.state.control();
  const LightChanges known = control.lights();
  const auto is_in_file = [&](const ValueEdit& value) {
    const auto change = known.find(value.path[1]);
    return change == known.end() || change->second.added_type.empty();
  };
  const auto first_new = std::stable_partition(edits.begin(), edits.end(), is_in_file);
  const std::vector<ValueEdit> added(first_new, edits.end());
  edits.erase(first_new, edits.end());
  json answer = edits.empty() ? json{{"text", values_text(added)}, {"written", true}}
                              : lights_answer(context, action, edits);
  end_mixed(control, edits);
  control.change_lights([&](LightChanges& changes) {
    for (const ValueEdit& value : added) {
      if (const auto change = changes.find(value.path[1]); change != changes.end())
        change->second.values[value.path[2]] = value.numbers;
    }
  });
  return answer;
}

json run_region(const CommandContext& context, const std::string& body) {
  const std::array<std::string, 1> keys{"region"};
  const json request = read_object(body, keys);
  const json region = request.value("region", json());
  if (region.is_null()) {
    context.state.control().set_region({});
    return json::object();
  }
  const std::vector<double> v = read_numbers(region, "region", 4, 0, kMaxPixel);
  const PixelBox box{static_cast<int>(v[0]), static_cast<int>(v[1]), static_cast<int>(v[2]),
                     static_cast<int>(v[3])};
  if (box.x0 >= box.x1 || box.y0 >= box.y1)
    throw Error(ErrorKind::kArguments, "region: expected [X0, Y0, X1, Y1] with X0 < X1 and Y0 < Y1");
  context.state.control().set_region(box);
  return json::object();
}

json run_frame(const CommandContext& context, const std::string& body) {
  const std::array<std::string, 1> keys{"frame"};
  const json request = read_object(body, keys);
  const json frame = request.value("frame", json());
  if (frame.is_null()) {
    context.state.control().set_frame({});
    return json::object();
  }
  const std::vector<int> frames = context.state.status().frames;
  const auto found = std::find(frames.begin(), frames.end(), frame);
  if (found == frames.end())
    throw Error(ErrorKind::kArguments,
                "frame: expected one of the scene's frames: " + print_frames({frames}));
  context.state.control().set_frame(*found);
  return json::object();
}

json run_preview(const CommandContext& context, const std::string& body) {
  const std::array<std::string, 1> keys{"dual"};
  const json request = read_object(body, keys);
  const auto dual = request.find("dual");
  if (dual == request.end() || !dual->is_boolean()) refuse_command("dual: expected true or false");
  context.state.control().set_dual(dual->get<bool>());
  return json::object();
}

struct Command {
  std::string_view name;
  json (*run)(const CommandContext&, const std::string& body);
};
constexpr Command kCommands[] = {{"camera.json", run_camera}, {"frame.json", run_frame},
                                 {"lights.json", run_lights}, {"preview.json", run_preview},
                                 {"region.json", run_region}, {"rig.json", run_rig}};

const Command* find_command(std::string_view name) {
  const auto* found = std::find_if(std::begin(kCommands), std::end(kCommands),
                                   [=](const Command& command) { return command.name == name; });
  return found == std::end(kCommands) ? nullptr : found;
}

std::string text_of(const json& answer) {
  return answer.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

bool SceneCommands::exists(std::string_view name) { return find_command(name) != nullptr; }

CommandAnswer SceneCommands::run(std::string_view name, const std::string& body) const {
  const auto refuse = [](int status, const std::string& why) {
    return CommandAnswer{status, text_of({{"error", why}})};
  };
  const Command* command = find_command(name);
  if (!command) return refuse(404, "there is no such command");
  try {
    return {200, text_of(command->run({scene_, overrides_, state_, writing_, may_write_}, body))};
  } catch (const Error& error) {
    return refuse(error.kind() == ErrorKind::kArguments ? 400 : 409, error.what());
  } catch (const std::exception& error) {
    return refuse(500, error.what());
  }
}

}  // namespace pelage
