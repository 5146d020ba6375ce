// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "world/scene_schema.h"

namespace pelage {

/// Ways to render that `measure shading` compares. `path` is always measured.
inline constexpr const char* kShadingParts[] = {"path",    "splatted",     "adaptive",   "gather", "reuse",
                                                "spacing", "skin_spacing", "light_rays", "paths",  "drawn"};

/// One way to render, measured with several sample counts: a line in the plots.
struct ShadingCurve {
  std::string id, title;
  std::vector<std::pair<std::string, std::string>> settings;  ///< keys and values of --set
  bool gather = false;                                        ///< else `path`
  bool adaptive = false;  ///< samples vary, with the noise budget of `path`
};

/// The curves with these names from kShadingParts, or all if there are none: `path` first.
std::vector<ShadingCurve> shading_curves(const SceneDescription& scene,
                                         const std::vector<std::string>& parts);

}  // namespace pelage
