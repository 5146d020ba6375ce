// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lab/runs/variant.h"
#include "world/scene_schema.h"

namespace pelage {

/// An approximation or optimisation that can be switched off. The variant `off` runs without it; the variant
/// kExactId runs with it.
struct Switch {
  std::string title;  ///< name for readers: "compact attributes"
  Variant off;
};

constexpr const char* kExactId = "exact";
constexpr const char* kNoneId = "none";
constexpr const char* kConservativeId = "conservative";
constexpr const char* kExactShutterId = "exact-shutter";

/// The runs of `measure bounds`. Their order matters: a cold run fills the caches of the warm runs after it.
struct BoundsVariants {
  std::vector<Variant> run;
  std::vector<std::string> shown;  ///< ids of the strategies in the order of the report
  std::vector<Switch> switches;    ///< each measured with strategy exact and warm caches
};

BoundsVariants bounds_variants(const SceneDescription& scene, const MeasureSetup& setup);

}  // namespace pelage
