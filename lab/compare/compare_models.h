// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/job.h"
#include "lab/compare/comparison.h"
#include "world/assets.h"

namespace pelage {

/// Renders the scene once per model and light, and traces a single fibre of each model. `models` holds names
/// from fibre_model_names(). Tables that some models need are stored in `folder`/tables. Replaces the
/// materials of `assets`. When the user stops the job, returns the results up to that moment. Throws Error
/// for other failures.
Comparison compare_models(const SceneDescription& scene, Assets& assets,
                          const std::vector<std::string>& models, const std::filesystem::path& folder,
                          const Job& job);

}  // namespace pelage
