// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "scene/document.h"
#include "view/command_answer.h"
#include "view/view_state.h"

namespace pelage {

/// Commands of clients that change what is rendered, or the scene file. The file is the only one that they
/// write. docs/VIEW.md describes them. Thread safety: all members may be called from any thread.
class SceneCommands {
 public:
  /// `may_write`: whether clients may change the scene file.
  SceneCommands(std::filesystem::path scene, std::vector<Override> overrides, ViewState& state,
                bool may_write = true)
      : scene_(std::move(scene)), overrides_(std::move(overrides)), state_(state), may_write_(may_write) {}

  /// Returns whether there is a command of a name: "camera.json", "frame.json", "lights.json",
  /// "preview.json", "region.json", "rig.json".
  static bool exists(std::string_view name);
  /// Runs a command. `body`: its parameters, as JSON. Mistakes become answers with an error.
  CommandAnswer run(std::string_view name, const std::string& body) const;

 private:
  const std::filesystem::path scene_;
  const std::vector<Override> overrides_;
  ViewState& state_;
  const bool may_write_;
  mutable std::mutex writing_;  // one command at a time writes the file
};

}  // namespace pelage
