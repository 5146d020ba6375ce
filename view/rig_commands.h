// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "view/command_context.h"

namespace pelage {

/// Runs the command "rig.json": adds, copies, changes, removes and writes lights and magnets, and takes
/// changes back. Throws Error like SceneCommands.
nlohmann::json run_rig(const CommandContext& context, const std::string& body);

}  // namespace pelage
