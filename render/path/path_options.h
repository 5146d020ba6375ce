// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/light/direct_light.h"

namespace pelage {

class SkinShadows;

struct PathOptions {
  DirectTechniques direct = DirectTechniques::kBoth;
  bool roulette = true;                ///< whether roulette may end paths early
  const SkinShadows* balls = nullptr;  ///< inside the skins; null: shadow rays behind them are traced too
};

}  // namespace pelage
