// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "scene/value_edits.h"
#include "view/view_state.h"

namespace pelage {

/// What a command works on.
struct CommandContext {
  const std::filesystem::path& scene;
  const std::vector<Override>& overrides;
  ViewState& state;
  std::mutex& writing;
  bool may_write;
};

/// Writes values into the scene file if the action is "write". Returns them as text.
nlohmann::json values_answer(const CommandContext& context, const std::string& action,
                             const std::vector<ValueEdit>& edits);
/// Writes lights and magnets like values_answer(). This change of the file does not end what clients have
/// changed about them otherwise.
nlohmann::json lights_answer(const CommandContext& context, const std::string& action,
                             const std::vector<ValueEdit>& edits);

}  // namespace pelage
