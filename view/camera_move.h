// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/vector.h"
#include "scene/value_edits.h"

namespace pelage {

/// A camera that a client has moved. In scene units.
struct CameraMove {
  V3f position{0, 0, 10}, look_at{0};
  bool operator==(const CameraMove&) const = default;
};

/// Returns the values of a scene with this camera. The other keys of the block `camera` stay.
std::vector<ValueEdit> camera_edits(const CameraMove& move);

/// Returns camera_edits() as options `--set`.
std::vector<Override> camera_overrides(const CameraMove& move);

}  // namespace pelage
