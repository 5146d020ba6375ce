// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "world/scene_schema.h"

namespace pelage {

/// Names of the ways to render that `measure shading` compares. `path` is always among them.
inline constexpr const char* kShadingParts[] = {"path",
                                                "splatted",
                                                "adaptive",
                                                "gather",
                                                "visibility",
                                                "reuse",
                                                "spacing",
                                                "skin_spacing",
                                                "cells",
                                                "light_rays",
                                                "paths",
                                                "cache",
                                                "no_cache",
                                                "drawn",
                                                "screen_door",
                                                "gather_screen_door",
                                                "dual",
                                                "skin_ball",
                                                "gather_skin_ball",
                                                "together",
                                                "gather_together"};

/// One way to render, which is measured with several sample counts. Its results are one line in the plots of
/// error over CPU time.
struct ShadingCurve {
  std::string id, title;
  std::vector<std::pair<std::string, std::string>> settings;  ///< keys and values of --set
  bool gather = false;  ///< whether the integrator is `gather`; otherwise, it is `path`
  /// Whether sampling is adaptive. Its noise limit is the noise of `path` with the same sample count.
  bool adaptive = false;
};

/// Returns the settings of the reference pictures, whatever the scene says.
ShadingCurve reference_curve();

/// Returns `cache` or `no_cache`, the one that renders exactly as `gather` does with the settings of this
/// scene. Empty if it is unknown, because it depends on how many skins a crowd or an archive has.
std::string same_as_gather(const SceneDescription& scene);

/// Returns the ways to render whose names are in `parts`, or all of them if `parts` is empty; but not
/// same_as_gather(). `path` is always the first.
std::vector<ShadingCurve> shading_curves(const SceneDescription& scene,
                                         const std::vector<std::string>& parts);

}  // namespace pelage
