// SPDX-License-Identifier: Apache-2.0
// Procedurals that run code: Pelage's own, which Pelage does not run, and others.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "rib/scene/rib_interpreter.h"

namespace pelage {
namespace {

constexpr size_t kMaxProcedurals = 1'000'000;  // of one kind
constexpr size_t kMaxReplyDepth = 100;         // of replies that ask for replies
constexpr float kInfinity = 1e38f;             // RI_INFINITY

}  // namespace

bool RibInterpreter::is_own_procedural(const std::string& kind, const std::string& program) {
  if (kind == "DynamicLoad" || kind == "DynamicLoad2") {
    const std::string plugin = std::filesystem::path(program).filename().string();
    return plugin == "libpelage_ri.so" || plugin == "libpelage_ri";
  }
  const size_t blank = program.find(' ');
  return (kind == "RunProgram" || kind == "RunProgram2") && blank != std::string::npos &&
         program.substr(blank) == " procedural" &&
         std::filesystem::path(program.substr(0, blank)).filename() == "pelage";
}

void RibInterpreter::add_own_procedural(const std::string& arguments, const RibStatement& request) {
  const size_t own_material = material(Look{true});
  if (!options_.geometry) return;
  if (scene_.own_procedurals.size() == kMaxProcedurals)
    request.fail(fmt::format("more than {} procedurals of Pelage", kMaxProcedurals));
  scene_.own_procedurals.push_back(
      {arguments, request.position(), context_.folder, own_material, now_.tint, now_.to_world});
}

/// The area of the bound in the picture, in pixels; infinite if the file has no camera. The picture's whole
/// area if the bound reaches behind the camera.
float RibInterpreter::detail_of(const Box3f& bound) const {
  if (!scene_.camera.stated || bound.isEmpty()) return kInfinity;
  const auto [width, height] = camera_.format.value_or(std::pair(640, 480));
  const float whole = static_cast<float>(width) * static_cast<float>(height);
  const M44f to_camera = now_.to_world.at(0) * scene_.camera.to_camera.at(0);
  const float half = camera_.perspective ? std::tan(camera_.fov * std::numbers::pi_v<float> / 360) : 1;
  const float pixels = 0.5f * static_cast<float>(std::min(width, height)) / half;  // at distance 1
  float min_x = kInfinity, max_x = -kInfinity, min_y = kInfinity, max_y = -kInfinity;
  for (int corner = 0; corner < 8; ++corner) {
    const V3f p = V3f(corner & 1 ? bound.max.x : bound.min.x, corner & 2 ? bound.max.y : bound.min.y,
                      corner & 4 ? bound.max.z : bound.min.z) *
                  to_camera;
    if (!(p.z > 0)) return whole;
    const float scale = camera_.perspective ? pixels / p.z : pixels;
    min_x = std::min(min_x, scale * p.x);
    max_x = std::max(max_x, scale * p.x);
    min_y = std::min(min_y, scale * p.y);
    max_y = std::max(max_y, scale * p.y);
  }
  return (max_x - min_x) * (max_y - min_y);
}

void RibInterpreter::foreign_procedural(const std::string& kind, const std::vector<std::string>& words,
                                        const Box3f& bound, const RibStatement& request) {
  if (kind != "RunProgram" && kind != "RunProgram2") {
    const char* why = kind == "DynamicLoad" || kind == "DynamicLoad2"
                          ? "calls functions of its renderer, which Pelage does not have; skipped"
                          : "is not supported; skipped";
    warn_once("procedural " + kind, request.position(), "a procedural of kind " + quote(kind) + " " + why);
    return;
  }
  if (!options_.programs) {
    warn_once("procedural " + kind, request.position(),
              "a procedural of kind " + quote(kind) +
                  " runs code; skipped (--allow-procedurals runs the programs that the file names)");
    return;
  }
  if (program_depth_ >= kMaxReplyDepth)
    request.fail(fmt::format("more than {} nested replies", kMaxReplyDepth));
  // Four digits, so that rounding of transforms does not make another request.
  programs_.push_back({asking_ ? *asking_ : request, words[0],
                       fmt::format("{:.4g} {}", detail_of(bound), words[1]), now_, program_depth_});
  if (!in_deferred_) run_waiting_programs();
}

void RibInterpreter::run_waiting_programs() {
  while (!in_deferred_ && !programs_.empty()) {
    WaitingProgram next = std::move(programs_.front());
    programs_.pop_front();
    run_program(std::move(next));
  }
}

void RibInterpreter::run_program(WaitingProgram waiting) {
  const RibStatement& request = waiting.request;
  std::vector<std::filesystem::path> folders{std::filesystem::path(request.file).parent_path(),
                                             context_.folder};
  for (const std::string& folder : context_.program_path) {
    folders.push_back(context_.folder / folder);
    folders.emplace_back(folder);
  }
  const RibAttributes saved = std::exchange(now_, std::move(waiting.attributes));
  const size_t depth = std::exchange(program_depth_, waiting.depth + 1);
  const RibStatement* asked = std::exchange(asking_, &request);
  try {
    auto reply = options_.programs->ask(waiting.command, folders, waiting.line, options_.check_stop);
    const std::filesystem::path path = reply->path();
    defer_archive(path, request, std::move(reply));
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kInput) throw;
    // The reply is in a temporary file, whose name says nothing.
    const Problem& first = error.problems().front();
    const bool outside = first.position.file.empty() || first.position.file == request.file;
    const std::string where = outside ? "" : fmt::format(", line {} of its reply", first.position.line);
    request.fail("program " + quote(waiting.command) + where + ": " + first.message);
  }
  asking_ = asked;
  program_depth_ = depth;
  now_ = saved;
}

}  // namespace pelage
