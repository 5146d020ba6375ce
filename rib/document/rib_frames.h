// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "rib/document/rib_use.h"
#include "rib/scene/rib_scene.h"

namespace pelage {

/// A material of a file. `key`: its name, or frame_material() of it if the first frame has another material
/// of this name.
struct RibFrameMaterial {
  std::string key;
  RibMaterial material;
};

/// What a file says about its frames, without their geometry.
struct RibFrames {
  RibScene first;                           ///< the first frame with a picture, or the whole file
  std::map<int, RibCamera> cameras;         ///< of all frames with pictures; empty for a file without frames
  std::vector<RibFrameMaterial> materials;  ///< of all frames, without repetitions
  std::optional<Problem> other_lights;      ///< a warning, if later frames have other lights than `first`
};

/// Reads a file once. Frames that only draw shadow maps count only if the file has no others. `mirror`: as
/// RibReadOptions::mirror_left_handed. Appends the warnings of all frames. Throws Error
/// (kInput).
RibFrames read_rib_frames(const std::filesystem::path& path, bool mirror, const RibUse& use,
                          size_t max_request_bytes, std::vector<Problem>& warnings);

}  // namespace pelage
