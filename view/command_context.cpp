// SPDX-License-Identifier: Apache-2.0
#include "view/command_context.h"

#include <set>

#include "base/error.h"
#include "view/light_changes.h"

namespace pelage {

nlohmann::json values_answer(const CommandContext& context, const std::string& action,
                             const std::vector<ValueEdit>& edits) {
  const bool writes = action == "write";
  if (writes && !context.may_write)
    throw Error(ErrorKind::kArguments, "with --bind, pages cannot write the scene file; copy the text");
  if (writes) {
    const std::lock_guard lock(context.writing);
    write_values(context.scene, context.overrides, edits);
  }
  return {{"text", values_text(edits)}, {"written", writes}};
}

nlohmann::json lights_answer(const CommandContext& context, const std::string& action,
                             const std::vector<ValueEdit>& edits) {
  ViewControl& control = context.state.control();
  std::set<RigItem> items;
  if (action == "write") {
    for (const ValueEdit& edit : edits) items.insert({edit.path[1], edit.path[0] == "magnets"});
  }
  control.begin_writing_lights(items);
  try {
    return values_answer(context, action, edits);
  } catch (...) {
    control.take_written_lights(items);
    throw;
  }
}

}  // namespace pelage
