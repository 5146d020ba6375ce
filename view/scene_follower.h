// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <thread>
#include <vector>

#include "scene/document.h"
#include "view/file_watch.h"
#include "view/live_renderer.h"

namespace pelage {

/// Follows the files of a scene on a thread of its own: reads the scene again after each change, and submits
/// the edit to a renderer unless the change is only one of comments or formatting. A scene with mistakes is
/// not submitted; its problems are shown on the state until the next change. If a client has moved the camera
/// (ViewControl), the edits have that camera, until the scene's own camera changes. If a client has chosen a
/// frame, the edits have this frame alone, until the scene has it no more.
class SceneFollower {
 public:
  /// Reads the scene and submits it. `growth_cache`, `scripts`: members of SceneDescription, of all edits.
  /// Throws the errors of load_scene().
  SceneFollower(std::filesystem::path scene, std::vector<Override> overrides, LiveRenderer& renderer,
                ViewState& state, std::shared_ptr<const GrowthCache> growth_cache = {},
                std::shared_ptr<const OperatorScripts> scripts = {});
  ~SceneFollower();
  SceneFollower(const SceneFollower&) = delete;
  SceneFollower& operator=(const SceneFollower&) = delete;

 private:
  void run();
  void wait_for_quiet();
  void read_again();
  std::shared_ptr<const SceneEdit> read();
  LightChanges shown_lights(const SceneDescription& scene);
  void show_lights();
  /// Loads the scene with the camera, the frame and the lights that clients have chosen.
  SceneDescription load_shown();

  const std::filesystem::path path_;
  const std::vector<Override> overrides_;
  const std::shared_ptr<const GrowthCache> growth_cache_;
  const std::shared_ptr<const OperatorScripts> scripts_;
  LiveRenderer& renderer_;
  ViewState& state_;
  FileWatch watch_;
  std::vector<std::filesystem::path> files_;
  FileStamps stamps_;                      // of files_, when they were read last
  std::shared_ptr<const SceneEdit> last_;  // submitted last
  std::optional<CameraMove> camera_;       // of last_, like the next one
  std::optional<int> frame_;
  LightChanges lights_;
  bool dual_ = false;
  SceneParts own_camera_;  // parts of the scene's own camera
  SceneParts own_lights_;  // of its own lights
  std::atomic<bool> stopped_{false};
  std::thread thread_;  // the last member: it uses the others
};

}  // namespace pelage
