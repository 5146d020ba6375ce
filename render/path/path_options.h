// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/frame/known_occlusion.h"
#include "render/light/direct_light.h"

namespace pelage {

struct PathOptions {
  DirectTechniques direct = DirectTechniques::kBoth;
  bool roulette = true;  ///< whether roulette may end paths early
  KnownOcclusion known = {};
};

}  // namespace pelage
