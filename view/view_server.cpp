// SPDX-License-Identifier: Apache-2.0
#include "view/view_server.h"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "view/http_server.h"
#include "view/page_files.h"
#include "view/picture.h"
#include "view/picture_bytes.h"
#include "view/scene_edit.h"
#include "view/view_state.h"

namespace pelage {
namespace {

/// Returns state.json: the status, the version and size of the last picture, and what clients have chosen.
/// Keys are in docs/VIEW.md.
std::string state_json(ViewState& view, const Picture* picture) {
  const ViewStatus status = view.status();
  const std::optional<PixelBox> region = view.control().region();
  nlohmann::json state;
  state["done"] = status.done();
  state["error"] = status.error();
  state["stage"] = status.stage;
  state["progress"] = status.progress;
  state["samples"] = status.mean_samples;
  state["wanted_samples"] = status.wanted_samples;
  state["strands_regrown"] = status.strands_regrown;
  state["first_pixels_s"] = status.first_pixels_s;
  state["render_s"] = status.render_s;
  state["memory_bytes"] = status.memory_bytes;
  state["edits"] = status.edits;
  const auto list = [](const V3f& v) { return nlohmann::json{v.x, v.y, v.z}; };
  const ViewCamera& camera = status.camera;
  state["camera"] = {{"position", list(camera.position)},
                     {"look_at", list(camera.look_at)},
                     {"up", list(camera.up)},
                     {"fov", camera.fov},
                     {"height", camera.height},
                     {"moved", camera.moved},
                     {"note", status.camera_note}};
  state["lights"] = state["magnets"] = nlohmann::json::array();
  for (const ViewLight& light : status.lights)
    state[light.item.block()].push_back({{"name", light.item.name},
                                         {"type", light.type},
                                         {"values", light.values},
                                         {"changed", light.changed}});
  state["dual"] = view.control().dual();
  state["lights_changed"] = !view.control().lights().empty();
  state["lights_undo"] = view.control().can_undo_rig();
  state["region"] =
      region ? nlohmann::json{region->x0, region->y0, region->x1, region->y1} : nlohmann::json();
  state["frame"] = status.frame;
  state["frames"] = status.frames;
  state["fps"] = status.edit ? status.edit->scene.units.fps : UnitsParams().fps;
  state["pages"] = view.pages();
  state["layers"] = status.layers;
  state["warnings"] = status.warnings;
  state["version"] = picture ? picture->version : 0;
  state["width"] = picture ? picture->width : 0;
  state["height"] = picture ? picture->height : 0;
  // File names may contain bytes that are not UTF-8.
  return state.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

constexpr size_t kMaxLayers = 1000;  // of one request

std::string mime_type(std::string_view name) {
  if (name.ends_with(".html")) return "text/html; charset=utf-8";
  if (name.ends_with(".css")) return "text/css; charset=utf-8";
  return name.ends_with(".js") ? "text/javascript; charset=utf-8" : "image/svg+xml";
}

std::string file_name(const HttpRequest& request) {
  return request.path.substr(std::min<size_t>(1, request.path.size()));
}

HttpAnswer refusal_of(int status, const std::string& why) { return {status, "text/plain", why + "\n"}; }

HttpAnswer json_answer(CommandAnswer answer) {
  return {answer.status, "application/json", std::move(answer.json)};
}

std::string with_token(std::string_view page, const std::string& token) {
  constexpr std::string_view kPlace = "{{token}}";
  std::string text;
  for (size_t at = 0; at < page.size();) {
    const size_t place = std::min(page.find(kPlace, at), page.size());
    text += page.substr(at, place - at);
    if (place < page.size()) text += token;
    at = place + kPlace.size();
  }
  return text;
}

/// Reads a whole number of at most 6 digits.
std::optional<int> read_pixel(const std::string& text) {
  constexpr size_t kMaxDigits = 6;
  int value = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (text.size() > kMaxDigits || error != std::errc() || rest != end) return {};
  return value;
}

}  // namespace

struct ViewServer::State final : HttpHandler {
  State(ViewState& view_state, const SceneCommands& scene_commands, const std::string& address, int port)
      : state(view_state), commands(scene_commands), rules(address, port, ""), server(address, port) {
    rules = RequestRules(address, server.port(), random_token());
    server.start(*this);
  }
  ~State() override { closing = true; }

  std::optional<HttpAnswer> refusal(const HttpRequest& head) const override;
  HttpAnswer answer(const HttpRequest& request) override;
  HttpAnswer layers(const HttpRequest& request);
  HttpAnswer exr();
  HttpAnswer why(const HttpRequest& request);

  ViewState& state;
  const SceneCommands& commands;
  std::atomic<bool> closing{false};
  RequestRules rules;
  HttpServer server;  // the last member: its threads use the others
};

std::optional<HttpAnswer> ViewServer::State::refusal(const HttpRequest& head) const {
  const int status = rules.status(
      {head.method, head.host, head.origin, head.parameter("token"), head.type, head.body_is_plain});
  if (status == 403) {
    return refusal_of(
        status,
        "refused: the address needs its token, as `pelage view` printed it, and other sites may not ask");
  }
  if (status == 405) return refusal_of(status, "only GET and POST are answered");
  if (status != 200)
    return refusal_of(status,
                      "the body of a command must be JSON, of type application/json, with its length");
  const bool is_command = SceneCommands::exists(file_name(head));
  if (is_command != (head.method == "POST"))
    return refusal_of(405, is_command ? "a command needs POST" : "there is no such command");
  return {};
}

HttpAnswer ViewServer::State::answer(const HttpRequest& request) {
  const std::string& path = request.path;
  if (request.method == "POST") return json_answer(commands.run(file_name(request), request.body));
  if (path == "/state.json") {
    state.see_page(request.parameter("page"));
    const std::shared_ptr<const Picture> picture = state.picture();
    return {200, "application/json", state_json(state, picture.get())};
  }
  if (path == "/layer.bin") return layers(request);
  if (path == "/picture.exr") return exr();
  if (path == "/why.json") return why(request);
  const std::string name = path == "/" ? "index.html" : file_name(request);
  for (const PageFile& file : page_files()) {
    if (file.name == name) return {200, mime_type(name), with_token(file.text, rules.token())};
  }
  return refusal_of(404, "there is no such page");
}

HttpAnswer ViewServer::State::layers(const HttpRequest& request) {
  std::vector<std::string> names;
  for (const auto& [name, value] : request.parameters) {
    if (name == "name" && names.size() < kMaxLayers) names.push_back(value);
  }
  const std::shared_ptr<const Picture> picture = state.with_layers(names);
  const auto has = [&](const std::string& name) { return picture && picture->layers.contains(name); };
  if (!names.empty() && std::all_of(names.begin(), names.end(), has))
    return {200, "application/octet-stream", layer_bytes(*picture, names)};
  const std::vector<std::string> known = state.status().layers;
  const auto will_have = [&](const std::string& name) {
    return std::find(known.begin(), known.end(), name) != known.end();
  };
  if (names.empty() || !std::all_of(names.begin(), names.end(), will_have))
    return refusal_of(404, "the picture has no such layer");
  return {204, "text/plain", ""};  // browsers would report an error to the user: the next picture has them
}

HttpAnswer ViewServer::State::exr() {
  HttpAnswer answer{200, "image/x-exr", ""};
  if (state.with_frame([&](const FinishedFrame& frame) { answer.bytes = finished_exr(frame); }))
    return answer;
  const std::shared_ptr<const Picture> picture = state.picture();
  if (!picture) return refusal_of(404, "there is no picture yet");
  answer.bytes = partial_exr(*picture);
  return answer;
}

HttpAnswer ViewServer::State::why(const HttpRequest& request) {
  const std::optional<int> x = read_pixel(request.parameter("x"));
  const std::optional<int> y = read_pixel(request.parameter("y"));
  if (!x || !y)
    return json_answer({400, R"({"error": "expected the parameters x and y, a pixel of the picture"})"});
  return json_answer(state.why().ask(*x, *y, [this] { return closing.load(); }));
}

ViewServer::ViewServer(ViewState& state, const SceneCommands& commands, const std::string& address, int port)
    : state_(std::make_unique<State>(state, commands, address, port)),
      url_(fmt::format("http://{}:{}/?token={}",
                       address.find(':') == std::string::npos ? address : "[" + address + "]",
                       state_->server.port(), state_->rules.token())) {}

ViewServer::~ViewServer() = default;

}  // namespace pelage
