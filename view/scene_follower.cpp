// SPDX-License-Identifier: Apache-2.0
#include "view/scene_follower.h"

#include <algorithm>
#include <exception>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace pelage {
namespace {

using std::chrono::milliseconds;

/// An editor may write a file in several steps, and a tool several files.
constexpr milliseconds kQuiet{30}, kLongestUnrest{300};
/// Finds changes that inotify does not report: of network drives, and of folders that were replaced.
constexpr milliseconds kPoll{1000};
constexpr size_t kMaxFrames = 10'000;  // that clients can choose

SceneParts camera_parts(const SceneParts& parts) {
  SceneParts camera;
  for (const auto& [part, hash] : parts) {
    if (part.starts_with("camera")) camera.emplace(part, hash);
  }
  return camera;
}

ViewCamera camera_of(const SceneDescription& scene, bool moved) {
  const double frame = scene.frames.frames.front();
  const CameraParams& camera = scene.camera;
  const float aspect = static_cast<float>(scene.image.width) / static_cast<float>(scene.image.height);
  return {camera.position.at(frame),
          camera.look_at.at(frame),
          camera.up.at(frame),
          camera.fov_at(frame, aspect),
          camera.orthographic ? camera.orthographic->at(frame) : 0,
          moved};
}

}  // namespace

SceneFollower::SceneFollower(std::filesystem::path scene, std::vector<Override> overrides,
                             LiveRenderer& renderer, ViewState& state,
                             std::shared_ptr<const GrowthCache> growth_cache,
                             std::shared_ptr<const OperatorScripts> scripts)
    : path_(std::move(scene)),
      overrides_(std::move(overrides)),
      growth_cache_(std::move(growth_cache)),
      scripts_(std::move(scripts)),
      renderer_(renderer),
      state_(state) {
  files_ = {path_};
  last_ = read();
  files_ = followed_files(last_->scene);
  stamps_ = last_->files;
  watch_.watch(files_);
  renderer_.submit(last_);
  show_lights();
  thread_ = std::thread([this] { run(); });
  state_.control().on_change([this] { watch_.wake(); });
}

SceneFollower::~SceneFollower() {
  state_.control().on_change({});
  stopped_ = true;
  watch_.wake();
  thread_.join();
}

SceneDescription SceneFollower::load_shown() {
  SceneDescription scene = load_scene(path_, overrides_);
  SceneParts own = camera_parts(scene.parts);
  camera_ = state_.control().camera();
  const bool changed = own != own_camera_;
  const bool written = changed && state_.control().take_written();
  const bool framed = !scene.camera.frame.name.empty();
  if (written && framed) {
    state_.update([](ViewStatus& status) {
      status.camera_note =
          "only the direction was kept: `frame` places the camera of the scene; remove it to keep the rest";
    });
  }
  if (camera_ && changed && !written) {
    camera_ = std::nullopt;
    state_.control().set_camera({});
    state_.update([](ViewStatus& status) {
      status.camera_note = "the camera of the scene file has changed, and is shown again";
    });
  }
  own_camera_ = std::move(own);
  std::vector<int> frames = scene.frames.frames;
  frame_ = state_.control().frame();
  if (frame_ && std::find(frames.begin(), frames.end(), *frame_) == frames.end()) {
    state_.control().end_frame(*frame_);
    frame_ = std::nullopt;
  }
  const int frame = frame_.value_or(frames.front());
  frames.resize(std::min(frames.size(), kMaxFrames));
  state_.update([&](ViewStatus& status) {
    status.frame = frame;
    status.frames = std::move(frames);
  });
  lights_ = shown_lights(scene);
  std::vector<Override> chosen = overrides_;
  for (Override& override : light_change_overrides(lights_, path_)) chosen.push_back(std::move(override));
  if (frame_) chosen.push_back({"frames", std::to_string(frame)});
  if (camera_) {
    for (Override& override : camera_overrides(*camera_)) chosen.push_back(std::move(override));
    if (framed) chosen.push_back({"camera.frame", "null"});
  }
  dual_ = state_.control().dual();
  if (dual_) {
    chosen.push_back({"render.integrator", "path"});
    chosen.push_back({"render.indirect", "dual"});
  }
  return camera_ || frame_ || dual_ || !lights_.empty() ? load_scene(path_, chosen) : std::move(scene);
}

/// Returns the changes of lights that still apply: not those of lights that the scene file no longer has, or
/// that were changed in the file since by others than commands of this view.
LightChanges SceneFollower::shown_lights(const SceneDescription& scene) {
  SceneParts own;
  for (const auto& part : scene.parts) {
    if (part.first.starts_with("lights.") || part.first.starts_with("magnets.")) own.insert(part);
  }
  const auto item_of = [](const std::string& part) {
    const size_t dot = part.find('.');
    return RigItem(part.substr(dot + 1), part.starts_with("magnets."));
  };
  std::set<RigItem> differing;  // those that the file has changed
  for (const SceneParts& parts : {own, own_lights_}) {
    for (const auto& [part, hash] : parts) {
      const auto now = own.find(part), then = own_lights_.find(part);
      if (now == own.end() || then == own_lights_.end() || now->second != then->second)
        differing.insert(item_of(part));
    }
  }
  const std::set<RigItem> written = state_.control().take_written_lights(differing);
  const auto is_old = [&](const RigItem& item, const LightChange& change) {
    const std::string part = item.block() + "." + item.name;
    const auto now = own.find(part), then = own_lights_.find(part);
    if (written.contains(item) && now != own.end()) return false;
    if (!change.added_type.empty()) return now != own.end();
    return now == own.end() || (then != own_lights_.end() && then->second != now->second);
  };
  LightChanges lights = state_.control().lights();
  const bool changed =
      std::erase_if(lights, [&](const auto& item) { return is_old(item.first, item.second); }) > 0;
  if (!differing.empty() && !own_lights_.empty()) state_.control().forget_rig();
  if (changed) {
    state_.control().change_lights([&](LightChanges& all) {
      std::erase_if(all, [&](const auto& item) { return is_old(item.first, item.second); });
    });
  }
  own_lights_ = std::move(own);
  return lights;
}

std::shared_ptr<const SceneEdit> SceneFollower::read() {
  const auto noticed = std::chrono::steady_clock::now();
  // The stamps of known files are taken before they are read: a file that changes while it is read is read
  // again.
  const FileStamps before = stamps_of(files_);
  SceneDescription scene = load_shown();
  scene.growth_cache = growth_cache_;
  scene.scripts = scripts_;
  FileStamps stamps = stamps_of(followed_files(scene));
  state_.update([&](ViewStatus& status) { status.camera = camera_of(scene, camera_.has_value()); });
  for (auto& [file, stamp] : stamps) {
    if (const auto known = before.find(file); known != before.end()) stamp = known->second;
  }
  return std::make_shared<const SceneEdit>(SceneEdit{std::move(scene), std::move(stamps), noticed});
}

/// Lights are shown after their edit was submitted: whoever sees them at rest sees a picture that has them.
void SceneFollower::show_lights() {
  const SceneDescription& scene = last_->scene;
  state_.update(
      [&](ViewStatus& status) { status.lights = view_lights(scene, scene.frames.frames.front(), lights_); });
}

void SceneFollower::run() {
  while (!stopped_) {
    const bool changed = watch_.wait(kPoll);
    if (stopped_) return;
    if (changed) wait_for_quiet();
    // A file that an include names and that does not exist yet is not among files_.
    const bool broken = !state_.status().scene_error.empty();
    const ViewControl& control = state_.control();
    const bool chosen = control.camera() != camera_ || control.frame() != frame_ ||
                        control.lights() != lights_ || control.dual() != dual_;
    if (changed || broken || chosen || stamps_of(files_) != stamps_) read_again();
  }
}

void SceneFollower::wait_for_quiet() {
  const auto end = std::chrono::steady_clock::now() + kLongestUnrest;
  while (!stopped_ && watch_.wait(kQuiet) && std::chrono::steady_clock::now() < end) {
  }
}

void SceneFollower::read_again() {
  try {
    std::shared_ptr<const SceneEdit> edit = read();
    files_ = followed_files(edit->scene);
    stamps_ = edit->files;
    watch_.watch(files_);
    const bool failed = !state_.status().render_error.empty();
    const bool same = edit->redo_after(*last_) == Redo::kNothing && !failed;
    state_.update([](ViewStatus& status) { status.scene_error.clear(); });
    if (!same) {
      last_ = std::move(edit);
      renderer_.submit(last_);
    }
    show_lights();
  } catch (const std::exception& error) {  // an Error, or a failure of the system
    stamps_ = stamps_of(files_);
    state_.update([&](ViewStatus& status) { status.scene_error = error.what(); });
  }
}

}  // namespace pelage
