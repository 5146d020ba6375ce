// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/options.h"
#include "farm/farm_plan.h"
#include "world/scene_schema.h"

namespace pelage {

/// Returns what the command line of `farm plan` and `farm submit` asks for. Throws Error (kArguments) if the
/// shot cannot be divided in this way.
FarmRequest farm_request(const Options& options, const SceneDescription& scene);

}  // namespace pelage
