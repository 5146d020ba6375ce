// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "base/vector.h"
#include "image/exr.h"
#include "render/camera/camera.h"

namespace pelage {

/// Metadata for the header of a picture.
struct FrameHeader {
  double frame = 1;
  V2f shutter{0, 0};  ///< opening and closing time, in frames relative to `frame`
  double frames_per_second = 24;
  double meters_per_unit = 0.01;
  int64_t seed = 0;
  uint32_t samples = 0;       ///< min count over all pixels
  double mean_samples = 0;    ///< mean count over all pixels
  std::string adaptive;       ///< rule of adaptive sampling; empty if not adaptive
  bool dual = false;          ///< light of many bounces is an estimate: `indirect: dual`
  bool partial = false;       ///< cancelled: some pixels have fewer samples than requested, or none
  bool time_limited = false;  ///< the time limit determined the number of samples
  double render_seconds = 0;
  int64_t peak_memory_bytes = 0;
  std::string program_version;
  std::string instruction_set;  ///< see instruction_set()
  std::string scene_hash;       ///< hash of everything that determines the picture
};

/// Returns the EXR attributes of a frame. Standard attributes are worldToCamera, worldToNDC,
/// screenWindowWidth, framesPerSecond and expTime (exposure time in seconds). The names of all others start
/// with "pelage:".
ExrAttributes exr_attributes(const FrameHeader& header, const Camera& camera);

}  // namespace pelage
