// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "cli/scene_schema.h"
#include "image/exr.h"
#include "render/camera/camera.h"

namespace pelage {

/// What is written into the header of a frame beside its pixels.
struct FrameFacts {
  int frame = 1;
  uint32_t samples = 0;  ///< that every pixel got
  bool partial = false;  ///< interrupted
  double render_seconds = 0;
  int64_t peak_rss_bytes = 0;
};

/// Header attributes: camera matrices and frame rate under OpenEXR's own names, the rest under `pelage.`.
std::map<std::string, ExrAttribute> frame_metadata(const SceneDescription& scene, const Camera& camera,
                                                   const FrameFacts& facts);

}  // namespace pelage
