// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/render/path/busy_scene.h"

namespace pelage {

/// BusyScene with two bounces, rendered with `gather`.
struct GatherScene : BusyScene {
  GatherScene() {
    render.integrator = Integrator::kGather;
    render.bounces = 2;
  }
};

}  // namespace pelage
