// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "base/vector.h"
#include "image/exr.h"
#include "render/camera/camera.h"

namespace pelage {

/// What the header of a picture says beside its pixels.
struct FrameHeader {
  double frame = 1;
  V2f shutter{0, 0};  ///< when it opens and closes, in frames around the frame
  double frames_per_second = 24;
  double meters_per_unit = 0.01;
  int64_t seed = 0;
  uint32_t samples = 0;       ///< that every pixel has got
  double mean_samples = 0;    ///< of all pixels
  std::string adaptive;       ///< rule of adaptive sampling; empty without
  bool partial = false;       ///< interrupted: some pixels have got fewer samples
  bool time_limited = false;  ///< the clock decided how many samples there are
  double render_seconds = 0;
  int64_t peak_memory_bytes = 0;
  std::string program_version;
  std::string scene_hash;  ///< of all that the picture was made from
};

/// The EXR attributes of a frame: the standard ones (worldToCamera, worldToNDC, framesPerSecond, and expTime,
/// seconds that the shutter is open) and, under "pelage:", the rest.
ExrAttributes exr_attributes(const FrameHeader& header, const Camera& camera);

}  // namespace pelage
