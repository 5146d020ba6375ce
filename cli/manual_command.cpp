// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "cli/commands.h"
#include "scene/document.h"
#include "world/scene_schema.h"

namespace pelage {

int run_manual(const Options& options) {
  std::cout << manual_text(SceneDescription::schema(), options.section, options.markdown);
  return 0;
}

}  // namespace pelage
