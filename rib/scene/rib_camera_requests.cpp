// SPDX-License-Identifier: Apache-2.0
// The camera, the picture, and options.
#include <cmath>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "rib/scene/rib_interpreter.h"

namespace pelage {
namespace {

float positive(const RibStatement& request, float number) {
  if (!(number > 0 && number < 1e18f)) request.fail(fmt::format("{} is not greater than 0", number));
  return number;
}

std::vector<float> all_numbers(const RibStatement& request) {
  std::vector<float> numbers;
  for (const RibOperand& a : request.arguments) {
    if (!a.is_number()) request.fail(a, "expected a number, got " + a.describe());
    for (size_t i = 0; i < a.size() && numbers.size() < 16; ++i) {
      if (!std::isfinite(a.number(i))) request.fail(a, "a number is not finite");
      numbers.push_back(a.number(i));
    }
  }
  return numbers;
}

}  // namespace

void RibInterpreter::projection(const Call& call) {
  RibStatement& request = call.request();
  if (request.arguments.empty() || request.arguments[0].is_number()) request.fail("expected a name");
  const std::string name = request.arguments[0].strings[0];
  const bool known = name == "perspective" || name == "PxrPerspective" || name == "PxrCamera";
  camera_.perspective = name != "orthographic" && name != "PxrOrthographic";
  if (camera_.perspective && !known)
    warn_once("Projection " + name, request.position(),
              "projection " + quote(name) + " is not supported; the camera has perspective");
  for (const RibSetting& setting : settings_of(request, 1)) {
    if (setting.name == "fov" && setting.numbers.size() == 1) set_fov(setting);
  }
}

void RibInterpreter::set_fov(const RibSetting& setting) {
  camera_.fov = setting.numbers[0];
  if (!(camera_.fov > 0 && camera_.fov < 180))
    throw Error(ErrorKind::kInput, setting.position,
                "Projection: a field of view is between 0 and 180 degrees");
}

// A camera that its block closes before the world begins still sees the world.
void RibInterpreter::named_camera(const Call& call) {
  named_camera_ = now_.to_world;
  for (const RibSetting& setting : settings_of(call.request(), 1)) {
    if (setting.name == "fov" && setting.numbers.size() == 1) set_fov(setting);
  }
}

// Renderers with rays take the samples of a pixel from here.
void RibInterpreter::hider(const Call& call) {
  RibStatement& request = call.request();
  if (request.arguments.empty() || request.arguments[0].is_number()) request.fail("expected a name");
  for (const RibSetting& setting : settings_of(request, 1)) {
    if (setting.name == "maxsamples" && setting.numbers.size() == 1 && setting.numbers[0] >= 1 &&
        !camera_.pixel_samples)
      camera_.pixel_samples = V2f(std::min(setting.numbers[0], 65536.0f), 1);
  }
}

void RibInterpreter::shutter(const RibStatement& request, float open, float close) {
  if (!(open <= close)) request.fail("the shutter closes before it opens");
  // Times are relative to the frame. A shutter that is not within a frame of 0 has absolute times: the frame
  // is the one nearest to its middle, the earlier one of two.
  const bool absolute = open < -1 || open >= 1 || close > 1;
  context_.time_base = absolute ? std::ceil((open + close) / 2 - 0.5f) : 0;
  camera_.shutter =
      V2f(static_cast<float>(open - context_.time_base), static_cast<float>(close - context_.time_base));
}

void RibInterpreter::screen_window(const RibStatement& request, const std::vector<float>& n) {
  if (!(n[0] < n[1] && n[2] < n[3])) request.fail("expected left < right and bottom < top");
  camera_.screen_window = {n[0], n[1], n[2], n[3]};
}

// Sizes below 0 leave the choice to the display.
void RibInterpreter::format(const RibStatement& request, const std::vector<float>& n) {
  if (n[0] < 0 || n[1] < 0) return;
  for (size_t i = 0; i < 2; ++i) {
    if (!(n[i] >= 1 && n[i] <= 65536)) request.fail("a picture is 1 to 65536 pixels wide and high");
  }
  camera_.format = {static_cast<int>(n[0]), static_cast<int>(n[1])};
  if (n.size() == 3 && n[2] > 0) camera_.pixel_aspect = n[2];
}

void RibInterpreter::camera_numbers(const Call& call) {
  RibStatement& request = call.request();
  const std::vector<float> n = all_numbers(request);
  const auto need = [&](size_t count) {
    if (n.size() != count) request.fail(fmt::format("expected {} numbers, got {}", count, n.size()));
  };
  if (request.name == "ScreenWindow") {
    need(4);
    screen_window(request, n);
  } else if (request.name == "DepthOfField") {
    camera_.lens.reset();
    if (n.empty()) return;
    need(3);
    if (n[0] < 1e18f)
      camera_.lens = V3f(positive(request, n[0]), positive(request, n[1]), positive(request, n[2]));
  } else if (request.name == "Shutter") {
    need(2);
    shutter(request, n[0], n[1]);
  } else if (request.name == "Format") {
    if (n.size() != 2) need(3);
    format(request, n);
  } else if (request.name == "FrameAspectRatio") {
    need(1);
    camera_.frame_aspect = positive(request, n[0]);
  } else if (request.name == "Exposure") {  // pictures are linear: gamma is left to the display
    need(2);
    camera_.gain = positive(request, n[0]);
  } else {
    need(2);
    camera_.pixel_samples = V2f(positive(request, n[0]), positive(request, n[1]));
  }
}

void RibInterpreter::display(const Call& call) {
  RibStatement& request = call.request();
  if (request.arguments.empty() || request.arguments[0].is_number() || request.arguments[0].size() != 1)
    request.fail("expected the name of a picture");
  const std::string& name = request.arguments[0].strings[0];
  if (name.starts_with('+')) return;
  camera_.display = name;
  const auto text = [&](size_t i) {
    const bool is_text = i < request.arguments.size() && request.arguments[i].strings.size() == 1;
    return is_text ? request.arguments[i].strings[0] : std::string();
  };
  const std::string type = text(1), mode = text(2);
  camera_.draws_depths = mode == "z" && (type == "shadow" || type == "zfile");
  camera_.draws_depths |= type == "deepshad" || type == "dsm";
}

void RibInterpreter::option(const Call& call) {
  RibStatement& request = call.request();
  if (request.arguments.empty() || request.arguments[0].is_number()) request.fail("expected a name");
  const std::string kind = request.arguments[0].strings[0];
  if (kind != "pelage" && kind != "searchpath" && kind != "Ri") {
    warn_once("Option " + kind, request.position(), "Option " + quote(kind) + " is not supported; skipped");
    return;
  }
  for (RibSetting& setting : settings_of(request, 1)) {
    const std::vector<float>& n = setting.numbers;
    if (kind == "pelage") {
      const std::string name = setting.name;
      scene_.options[name] = {std::move(setting)};
    } else if (kind == "searchpath") {
      set_search_path(setting);
    } else if (setting.name == "FormatResolution" && n.size() == 2) {
      format(request, n);
    } else if (setting.name == "FormatPixelAspectRatio" && n.size() == 1) {
      camera_.pixel_aspect = positive(request, n[0]);
    } else if (setting.name == "ScreenWindow" && n.size() == 4) {
      screen_window(request, n);
    } else if (setting.name == "Shutter" && n.size() == 2) {
      shutter(request, n[0], n[1]);
    }
  }
}

void RibInterpreter::set_search_path(const RibSetting& setting) {
  std::vector<std::string>* folders = setting.name == "archive"      ? &context_.search_path
                                      : setting.name == "procedural" ? &context_.program_path
                                      : setting.name == "texture"    ? &context_.texture_path
                                                                     : nullptr;
  if (!folders || setting.strings.size() != 1) return;
  folders->clear();
  const std::string& path = setting.strings[0];
  for (size_t at = 0; at <= path.size();) {
    const size_t end = std::min(path.find(':', at), path.size());
    const std::string folder = path.substr(at, end - at);
    if (!folder.empty() && folder != "@" && folder != "&") folders->push_back(folder);
    at = end + 1;
  }
}

}  // namespace pelage
