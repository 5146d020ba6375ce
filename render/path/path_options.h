// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/light/direct_light.h"

namespace pelage {

class FarLightSamples;
class SkinShadows;

struct PathOptions {
  DirectTechniques direct = DirectTechniques::kBoth;
  LightChoice choice = LightChoice::kLobes;
  bool roulette = true;  ///< whether roulette may end paths early
  /// Where points on lights come from; null: Light::sample().
  const FarLightSamples* far_lights = nullptr;
  const SkinShadows* balls = nullptr;  ///< inside the skins; null: shadow rays behind them are traced too
};

}  // namespace pelage
