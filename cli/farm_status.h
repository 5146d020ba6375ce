// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "farm/shot_state.h"

namespace pelage {

/// Prints the state of a shot as JSON, see docs/FARM.md.
void print_shot_json(const ShotState& shot);

/// Prints the state of a shot for people: counts, and the tasks that need attention. `folder`: of the shot.
void print_shot_text(const ShotState& shot, const std::filesystem::path& folder);

}  // namespace pelage
