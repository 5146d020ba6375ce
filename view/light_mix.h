// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "base/vector.h"
#include "scene/value_edits.h"
#include "world/scene_schema.h"

namespace pelage {

/// A change of one light: its radiance is multiplied by 2^stops and by the tint.
struct LightMix {
  std::string light;
  double stops = 0;
  Rgb tint{1};
};

/// Returns the values that make these changes: the stops change `intensity`, the tint changes `radiance`. If
/// `intensity` has keyframes, both change `radiance`. Throws Error (kArguments) with the nearest name for a
/// light that the scene does not have.
std::vector<ValueEdit> light_edits(const SceneDescription& scene, const std::vector<LightMix>& mixes);

}  // namespace pelage
