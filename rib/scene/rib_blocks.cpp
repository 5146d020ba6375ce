// SPDX-License-Identifier: Apache-2.0
// Blocks of the graphics state, of frames, of motion, and objects.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "rib/scene/rib_interpreter.h"

namespace pelage {
namespace {

constexpr size_t kMaxDepth = 1000;  // of nested blocks
constexpr size_t kMaxTimes = 1000;  // of a motion block

std::string block_name(const std::string& request) { return request.substr(0, request.find_last_of("BE")); }

std::string object_key(const RibStatement& request) {
  if (request.arguments.empty() || request.arguments[0].size() != 1)
    request.fail("expected the number or the name of an object");
  const RibOperand& handle = request.arguments[0];
  if (!handle.is_number()) return handle.strings[0];
  return "#" + std::to_string(static_cast<int64_t>(handle.number(0)));
}

}  // namespace

void RibInterpreter::begin_block(const Call& call) {
  RibStatement& request = call.request();
  if (blocks_.size() >= kMaxDepth) request.fail(fmt::format("more than {} nested blocks", kMaxDepth));
  blocks_.push_back({block_name(request.name), request.file, request.line, request.column, now_});
}

void RibInterpreter::end_block(const Call& call) {
  RibStatement& request = call.request();
  const std::string name = block_name(request.name);
  if (blocks_.empty()) request.fail("there is no open " + name + "Begin");
  if (name == "Frame") end_frame();
  Block& open = blocks_.back();
  if (open.name != name)
    request.fail(fmt::format("the innermost open block is {}Begin of {}", open.name,
                             to_string({open.file, open.line, open.column})));
  if (name == "Transform") {
    now_.to_world = open.saved.to_world;
  } else {
    now_ = std::move(open.saved);
  }
  blocks_.pop_back();
}

void RibInterpreter::begin_frame(const Call& call) {
  RibStatement& request = call.request();
  if (request.arguments.empty() || !request.arguments[0].is_number() || request.arguments[0].size() != 1)
    request.fail("expected the number of a frame");
  const float number = request.arguments[0].number(0);
  if (!(std::abs(number) < 1e9f)) request.fail("a number of a frame must be less than 1e9");
  const int frame = static_cast<int>(number);
  if (!options_.each_frame && (frame_done_ || (options_.frame && *options_.frame != frame))) {
    skip_until_ = "FrameEnd";
    return;
  }
  frame_done_ = true;
  before_frame_.camera = camera_;
  if (options_.each_frame)
    before_frame_ = {camera_,        scene_,        materials_, coats_,    names_,         next_numbers_,
                     context_.world, named_camera_, points_,    archives_, inner_archives_};
  scene_.frame = frame;
  begin_block(call);
}

// A frame that only draws shadow maps is no picture of the file's own, so the next frame may be, also one
// with the same number.
void RibInterpreter::end_frame() {
  const bool is_picture = world_done_ || !skipped_shadows_;
  camera_ = before_frame_.camera;
  if (!options_.each_frame) {
    if (!is_picture) frame_done_ = false;
    return;
  }
  if (is_picture) options_.each_frame(scene_);
  any_picture_ |= is_picture;
  world_done_ = false;
  before_frame_.scene.warnings = std::move(scene_.warnings);
  before_frame_.scene.files = std::move(scene_.files);
  scene_ = std::move(before_frame_.scene);
  materials_ = std::move(before_frame_.materials);
  coats_ = std::move(before_frame_.coats);
  names_ = std::move(before_frame_.names);
  next_numbers_ = std::move(before_frame_.next_numbers);
  context_.world = before_frame_.world;
  named_camera_ = before_frame_.named_camera;
  points_ = before_frame_.points;
  archives_ = before_frame_.archives;
  inner_archives_ = before_frame_.inner_archives;
}

// The world of a file whose camera sees it mirrored is left-handed.
void RibInterpreter::begin_world(const Call& call) {
  if (camera_.draws_depths && !options_.shadow_passes) {
    skipped_shadows_ = true;
    warn_once("shadow pass", call.request().position(),
              "the world of a display that is a shadow map is skipped; Pelage needs no shadow maps");
    skip_until_ = "WorldEnd";
    return;
  }
  if (world_done_) {
    warn_once("second world", call.request().position(), "only the first world of a frame is read");
    skip_until_ = "WorldEnd";
    return;
  }
  if (named_camera_ && now_.to_world == RibTransform()) now_.to_world = *named_camera_;
  if (!is_usable(now_.to_world)) call.request().fail("the transform of the camera has no inverse");
  const bool mirrors =
      options_.mirror_left_handed && now_.to_world.samples().front().second.determinant() > 0;
  M44f mirror;
  if (mirrors) {
    mirror.setScale(V3f(1, 1, -1));
    context_.world = RibTransform(mirror);
  }
  scene_.camera = camera_;
  scene_.camera.stated = true;
  scene_.camera.to_camera = now_.to_world.after(context_.world);
  move_lights_to_world();
  context_.spaces["camera"] = RibTransform(now_.to_world.at(0).inverse() * context_.world.at(0));
  begin_block(call);
  now_.to_world = context_.world;
  world_done_ = true;
}

void RibInterpreter::begin_motion(const Call& call) {
  RibStatement& request = call.request();
  times_.clear();
  for (const RibOperand& a : request.arguments) {
    if (!a.is_number()) request.fail(a, "expected times, got " + a.describe());
    for (size_t i = 0; i < a.size(); ++i) times_.push_back(a.number(i) - context_.time_base);
  }
  if (times_.empty() || times_.size() > kMaxTimes)
    request.fail(fmt::format("a motion block has 1 to {} times, got {}", kMaxTimes, times_.size()));
  for (size_t i = 0; i < times_.size(); ++i) {
    if (!std::isfinite(times_[i]) || (i > 0 && !(times_[i] >= times_[i - 1])))
      request.fail("the times of a motion block must ascend");
  }
  in_motion_ = true;
  opened_at_ = request.position();
}

void RibInterpreter::end_motion(const Call& call) {
  RibStatement& request = call.request();
  if (!in_motion_) request.fail("there is no open MotionBegin");
  in_motion_ = false;
  std::vector<RibStatement> samples = std::move(samples_);
  samples_.clear();
  for (const RibStatement& sample : samples) kept_bytes_ -= sample.bytes();
  if (samples.size() != times_.size())
    request.fail(fmt::format("the motion block has {} times but {} requests", times_.size(), samples.size()));
  for (const RibStatement& sample : samples) {
    if (sample.name != samples.front().name)
      sample.fail("the requests of a motion block must be the same, here " + samples.front().name);
  }
  const std::string& name = samples.front().name;
  if (name.ends_with("Begin") || name.ends_with("End") || name == "ObjectInstance" || name == "ReadArchive" ||
      name == "Procedural" || name == "Procedural2")
    samples.front().fail("this request is invalid within a motion block");
  // Of several requests at the same time, such as those of a closed shutter, the first one counts.
  size_t kept = 0;
  for (size_t i = 0; i < times_.size(); ++i) {
    if (i > 0 && times_[i] == times_[i - 1]) continue;
    if (kept < i) std::swap(samples[kept], samples[i]);
    times_[kept++] = times_[i];
  }
  times_.resize(kept);
  dispatch({std::span(samples).first(kept), times_});
}

void RibInterpreter::begin_object(const Call& call) {
  RibStatement& request = call.request();
  recorded_ = object_key(request);
  recording_ = request.name == "ObjectBegin" ? "ObjectEnd" : "ArchiveEnd";
  opened_at_ = request.position();
  std::vector<RibStatement>& object = objects_[recorded_];
  if (&object == replayed_) request.fail("an object cannot be defined again within itself");
  object.clear();
}

void RibInterpreter::instance(const Call& call) {
  RibStatement& request = call.request();
  const std::string key = object_key(request);
  const auto object = objects_.find(key);
  if (object == objects_.end()) {
    warn_once("object " + key, request.position(), "there is no object " + quote(key) + "; skipped");
    return;
  }
  if (replayed_) request.fail("an instance within an object");
  replayed_ = &object->second;
  const size_t depth = blocks_.size();
  const RibAttributes saved = now_;
  // A copy, because requests are changed when they are executed.
  for (const RibStatement& one : object->second) {
    if (options_.check_stop && ++statements_ % 64 == 0) options_.check_stop();
    RibStatement copy = one;
    execute(copy);
  }
  if (blocks_.size() != depth || in_motion_) request.fail("the object has blocks that are not closed");
  now_ = saved;
  replayed_ = nullptr;
}

}  // namespace pelage
