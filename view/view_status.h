// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/vector.h"

namespace pelage {

struct SceneEdit;

/// The camera of the scene at the first frame. In scene units and degrees.
struct ViewCamera {
  V3f position{0}, look_at{0}, up{0, 1, 0};
  float fov = 40;
  bool moved = false;  ///< by a client; the scene file has another camera
};

/// Progress of the current render, as state.json reports it.
struct ViewStatus {
  bool at_rest = false;         ///< the render of the last edit without an error is complete
  std::string scene_error;      ///< problems of the scene file; empty if there are none
  std::string render_error;     ///< problems of reading the assets or of rendering; empty if there are none
  std::string stage;            ///< "read", "pose", "bound", "render" ...; empty at rest
  double progress = 0;          ///< fraction of the stage
  double mean_samples = 0;      ///< mean sample count of a pixel
  int wanted_samples = 0;       ///< sample count of a pixel when done
  int64_t strands_regrown = 0;  ///< strands grown again since the last edit
  double first_pixels_s = 0;    ///< seconds from the edit to its first picture; 0 before
  double render_s = 0;          ///< seconds from the edit to the end of the render; 0 before
  int64_t memory_bytes = 0;     ///< memory in use, as the ledger counts it
  std::shared_ptr<const SceneEdit> edit;  ///< the edit that is rendered; null before the first
  int edits = 0;                          ///< edits that were rendered so far; the first picture is no edit
  ViewCamera camera;
  std::string camera_note;          ///< why the camera is no longer the one that a client moved; may be empty
  std::vector<std::string> layers;  ///< names of all layers of the picture
  std::vector<std::string> warnings;  ///< the last few warnings

  const std::string& error() const { return scene_error.empty() ? render_error : scene_error; }
  /// Returns whether the finished picture shows the current content of the files.
  bool done() const { return at_rest && error().empty(); }
};

}  // namespace pelage
