// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "lab/measure/experiments.h"

namespace pelage {

/// Values of `render.bounces` that the experiment `bounces` renders with, ascending.
inline constexpr int kBounces[] = {0, 1, 2, 4, 8, 16, 32, 64};

/// A way to follow light from surface to surface.
struct BounceMethod {
  std::string id, title;
  std::vector<std::pair<std::string, std::string>> settings;  ///< keys below `render.`, and values
};

/// A run of the experiment, which renders one picture.
struct BounceRun {
  size_t method = 0;  ///< index in bounce_methods()
  bool is_warm_up = false;
  int bounces = 0;
  Outcome outcome;
  std::filesystem::path picture;
  double light = NAN;  ///< mean luminance of fur, relative to the picture of `path` with the most bounces
};

/// Returns `path`, and `gather` without and with the reflection cache.
const std::vector<BounceMethod>& bounce_methods();

/// Renders with each method and each of kBounces, after a warm-up. After the warm-up has failed or the user
/// has stopped, renders no more.
std::vector<BounceRun> run_bounces(const SceneDescription& scene, int samples, const MeasureSetup& setup,
                                   Progress& progress);

}  // namespace pelage
