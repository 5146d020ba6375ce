// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/value.h"
#include "world/scene_schema.h"

namespace pelage {

/// Returns why no light reaches anything, so that pictures are black, or nothing if there is light.
std::optional<std::string> why_dark(const SceneDescription& scene);

/// Adds a warning for each light whose barn doors are closed. Lights with a power, radiance or intensity of 0
/// are switched off on purpose.
void warn_of_dark_lights(const SceneDescription& scene, const Value& document,
                         std::vector<Problem>& warnings);

}  // namespace pelage
