// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "image/exr.h"
#include "render/path/path_options.h"
#include "render/scene/frame_scene.h"

namespace pelage {

class FrameSaver;
class FrameWatch;

/// How to render a frame, apart from the values of its scene.
struct FrameOptions {
  PathOptions path = {};
  /// Settings that replace those of the scene; empty: none do
  std::optional<FrameSettings> settings = {};
  std::optional<PixelBox> region = {};  ///< the only pixels to compute; empty: the whole picture
  FrameWatch* watch = nullptr;          ///< sees the film between passes; may be null
  FrameSaver* saver = nullptr;          ///< stores the state of the frame; may be null, see check_saving()
};

}  // namespace pelage
