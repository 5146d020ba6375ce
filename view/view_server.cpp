// SPDX-License-Identifier: Apache-2.0
#include "view/view_server.h"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <httplib.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>

#include "base/error.h"
#include "view/page_files.h"
#include "view/picture.h"
#include "view/picture_bytes.h"
#include "view/view_state.h"

namespace pelage {
namespace {

/// Returns state.json: the status, the version and size of the last picture, and the region to refine. Keys
/// are in docs/VIEW.md.
std::string state_json(const ViewStatus& status, const Picture* picture,
                       const std::optional<PixelBox>& region) {
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
                     {"moved", camera.moved},
                     {"note", status.camera_note}};
  state["region"] =
      region ? nlohmann::json{region->x0, region->y0, region->x1, region->y1} : nlohmann::json();
  state["layers"] = status.layers;
  state["warnings"] = status.warnings;
  state["version"] = picture ? picture->version : 0;
  state["width"] = picture ? picture->width : 0;
  state["height"] = picture ? picture->height : 0;
  // File names may contain bytes that are not UTF-8.
  return state.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

constexpr int kThreads = 16;
constexpr size_t kPiece = 1 << 16;    // bytes sent at once
constexpr size_t kMaxBody = 1 << 14;  // bytes
constexpr size_t kMaxLayers = 1000;   // of one request
constexpr time_t kRead_s = 2, kWrite_us = 700'000;

std::string mime_type(std::string_view name) {
  if (name.ends_with(".html")) return "text/html; charset=utf-8";
  if (name.ends_with(".css")) return "text/css; charset=utf-8";
  return name.ends_with(".js") ? "text/javascript; charset=utf-8" : "image/svg+xml";
}

std::string file_name(const httplib::Request& request) {
  return request.path.substr(std::min<size_t>(1, request.path.size()));
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

/// Ends the connections of clients that neither read nor write, for which a thread would wait. All sockets of
/// this process with the server's port belong to the server.
void end_connections(int port) {
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", failed)) {
    const std::string name = entry.path().filename();
    int descriptor = -1;
    std::from_chars(name.data(), name.data() + name.size(), descriptor);
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    if (descriptor < 0 || ::getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size) != 0)
      continue;
    const auto* own =
        reinterpret_cast<const sockaddr_in*>(&address);  // the port of IPv6 is at the same place
    const bool is_net = address.ss_family == AF_INET || address.ss_family == AF_INET6;
    if (is_net && ntohs(own->sin_port) == port) ::shutdown(descriptor, SHUT_RDWR);
  }
}

}  // namespace

struct ViewServer::State {
  State(ViewState& view_state, const SceneCommands& scene_commands, RequestRules request_rules)
      : state(view_state), commands(scene_commands), rules(std::move(request_rules)) {}

  /// Answers a request whose body has not been read. Returns false for a command, whose body is to be read.
  bool answer(const httplib::Request& request, httplib::Response& response);
  void answer_page(const httplib::Request& request, httplib::Response& response);
  void run_command(const httplib::Request& request, httplib::Response& response) const;
  void send(std::string bytes, const std::string& type, httplib::Response& response);
  static void refuse(int status, const std::string& why, httplib::Response& response) {
    response.status = status;
    response.set_content(why + "\n", "text/plain");
  }
  void send_layers(const std::vector<std::string>& names, httplib::Response& response);
  void send_exr(httplib::Response& response);
  void send_why(const httplib::Request& request, httplib::Response& response);

  ViewState& state;
  const SceneCommands& commands;
  RequestRules rules;
  int port = 0;
  std::atomic<bool> closing{false}, ended{false};
  httplib::Server server;
  std::thread thread;
};

bool ViewServer::State::answer(const httplib::Request& request, httplib::Response& response) {
  response.set_header("Cache-Control", "no-store");
  response.set_header("X-Content-Type-Options", "nosniff");
  response.set_header("Referrer-Policy", "no-referrer");
  response.set_header("Content-Security-Policy",
                      "default-src 'self'; script-src 'self' 'unsafe-inline'; style-src 'self'; "
                      "img-src 'self' blob: data:; frame-ancestors 'none'");
  const std::string length = request.get_header_value("Content-Length");
  // Without a length, or with a chunked or packed body, the library would not limit the size.
  const bool plain = !length.empty() && length.find_first_not_of("0123456789") == std::string::npos &&
                     request.get_header_value_count("Content-Length") == 1 &&
                     !request.has_header("Transfer-Encoding") && !request.has_header("Content-Encoding");
  const int status =
      rules.status({request.method, request.get_header_value("Host"), request.get_header_value("Origin"),
                    request.get_param_value("token"), request.get_header_value("Content-Type"), plain});
  if (status == 403) {
    refuse(status,
           "refused: the address needs its token, as `pelage view` printed it, and other sites may not ask",
           response);
  } else if (status == 405) {
    refuse(status, "only GET and POST are answered", response);
  } else if (status != 200) {
    refuse(status, "the body of a command must be JSON, of type application/json, with its length", response);
  } else if (length.size() > 4) {
    refuse(413, "too large", response);
  } else if (const bool is_command = SceneCommands::exists(file_name(request));
             is_command != (request.method == "POST")) {
    refuse(405, is_command ? "a command needs POST" : "there is no such command", response);
  } else if (is_command) {
    return false;
  } else {
    answer_page(request, response);
  }
  return true;
}

void ViewServer::State::run_command(const httplib::Request& request, httplib::Response& response) const {
  const CommandAnswer answer = commands.run(file_name(request), request.body);
  response.status = answer.status;
  response.set_content(answer.json, "application/json");
}

void ViewServer::State::answer_page(const httplib::Request& request, httplib::Response& response) {
  const std::string& path = request.path;
  if (path == "/state.json") {
    const std::shared_ptr<const Picture> picture = state.picture();
    return send(state_json(state.status(), picture.get(), state.control().region()), "application/json",
                response);
  }
  if (path == "/layer.bin") {
    std::vector<std::string> names;
    for (size_t i = 0; i < std::min(request.get_param_value_count("name"), kMaxLayers); ++i)
      names.push_back(request.get_param_value("name", i));
    return send_layers(names, response);
  }
  if (path == "/picture.exr") return send_exr(response);
  if (path == "/why.json") return send_why(request, response);
  const std::string name = path == "/" ? "index.html" : file_name(request);
  for (const PageFile& file : page_files()) {
    if (file.name == name) return send(with_token(file.text, rules.token()), mime_type(name), response);
  }
  refuse(404, "there is no such page", response);
}

// In pieces, so that a client that reads slowly is noticed when the server ends.
void ViewServer::State::send(std::string bytes, const std::string& type, httplib::Response& response) {
  const auto shared = std::make_shared<const std::string>(std::move(bytes));
  response.set_content_provider(shared->size(), type,
                                [this, shared](size_t offset, size_t length, httplib::DataSink& sink) {
                                  if (closing) return false;
                                  return sink.write(shared->data() + offset, std::min(length, kPiece));
                                });
}

void ViewServer::State::send_layers(const std::vector<std::string>& names, httplib::Response& response) {
  const std::shared_ptr<const Picture> picture = state.with_layers(names);
  const auto has = [&](const std::string& name) { return picture && picture->layers.contains(name); };
  if (names.empty() || !std::all_of(names.begin(), names.end(), has)) {
    const std::vector<std::string> known = state.status().layers;
    const auto will_have = [&](const std::string& name) {
      return std::find(known.begin(), known.end(), name) != known.end();
    };
    if (names.empty() || !std::all_of(names.begin(), names.end(), will_have))
      return refuse(404, "the picture has no such layer", response);
    response.status =
        204;  // not an error, which browsers would report to the user: the next picture has them
    return;
  }
  send(layer_bytes(*picture, names), "application/octet-stream", response);
}

void ViewServer::State::send_exr(httplib::Response& response) {
  std::string bytes;
  if (!state.with_frame([&](const FinishedFrame& frame) { bytes = finished_exr(frame); })) {
    const std::shared_ptr<const Picture> picture = state.picture();
    if (!picture) return refuse(404, "there is no picture yet", response);
    bytes = partial_exr(*picture);
  }
  send(std::move(bytes), "image/x-exr", response);
}

void ViewServer::State::send_why(const httplib::Request& request, httplib::Response& response) {
  const std::optional<int> x = read_pixel(request.get_param_value("x"));
  const std::optional<int> y = read_pixel(request.get_param_value("y"));
  CommandAnswer answer{400, R"({"error": "expected the parameters x and y, a pixel of the picture"})"};
  if (x && y) answer = state.why().ask(*x, *y, [this] { return closing.load(); });
  response.status = answer.status;
  send(std::move(answer.json), "application/json", response);
}

ViewServer::ViewServer(ViewState& state, const SceneCommands& commands, const std::string& address,
                       int port) {
  auto server = std::make_unique<State>(state, commands, RequestRules(address, port, ""));
  httplib::Server& http = server->server;
  // Without SO_REUSEPORT, which the library sets by itself: two servers would share the port.
  http.set_socket_options([](socket_t socket) {
    const int on = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  });
  http.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  http.set_keep_alive_max_count(1);
  http.set_read_timeout(kRead_s);
  http.set_write_timeout(0, kWrite_us);
  http.set_payload_max_length(kMaxBody);
  http.set_pre_routing_handler([state = server.get()](const httplib::Request& request,
                                                      httplib::Response& response) {
    const bool answered = state->answer(request, response);
    return answered ? httplib::Server::HandlerResponse::Handled : httplib::Server::HandlerResponse::Unhandled;
  });
  http.Post(".*", [state = server.get()](const httplib::Request& request, httplib::Response& response) {
    state->run_command(request, response);
  });
  if (port == 0) {
    server->port = http.bind_to_any_port(address);
  } else if (http.bind_to_port(address, port)) {
    server->port = port;
  }
  if (server->port <= 0) {
    throw Error(ErrorKind::kFailed,
                port == 0 ? fmt::format("--bind {}: this machine has no such address", address)
                          : fmt::format("--port {}: cannot be used at {}; another program may use it", port,
                                        address));
  }
  server->rules = RequestRules(address, server->port, random_token());
  url_ = fmt::format("http://{}:{}/?token={}",
                     address.find(':') == std::string::npos ? address : "[" + address + "]", server->port,
                     server->rules.token());
  server->thread = std::thread([state = server.get()] {
    state->server.listen_after_bind();
    state->ended = true;
  });
  state_ = std::move(server);
}

ViewServer::~ViewServer() {
  state_->closing = true;
  while (!state_->server.is_running() && !state_->ended) std::this_thread::yield();
  state_->server.stop();
  end_connections(state_->port);
  state_->thread.join();
}

}  // namespace pelage
