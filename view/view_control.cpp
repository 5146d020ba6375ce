// SPDX-License-Identifier: Apache-2.0
#include "view/view_control.h"

namespace pelage {

std::vector<ValueEdit> camera_edits(const CameraMove& move) {
  const auto numbers = [](const V3f& v) { return std::vector<double>{v.x, v.y, v.z}; };
  return {{{"camera", "position"}, numbers(move.position)}, {{"camera", "look_at"}, numbers(move.look_at)}};
}

std::vector<Override> camera_overrides(const CameraMove& move) {
  std::vector<Override> overrides;
  for (const ValueEdit& edit : camera_edits(move))
    overrides.push_back({edit.path[0] + "." + edit.path[1], numbers_text(edit.numbers)});
  return overrides;
}

}  // namespace pelage
