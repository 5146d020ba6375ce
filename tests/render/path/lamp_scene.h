// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/geom/random_strands.h"
#include "tests/render/path/path_scene.h"

namespace pelage {

/// A small bright lamp seen through fur, with flat sky around.
struct LampScene : PathScene {
  LampScene() : PathScene(40, 32) {
    RandomStrandOptions o;
    o.strands = 150;
    o.radius = 0.03f;
    ConeShellParams fibre;
    fibre.color = Field(Rgb(0.9f));
    fibre.diffuse = 0.9f;  // given, so that no colour must be matched before every render
    add_fur(random_strands(11, o), fibre);
    SphereLightParams lamp;
    lamp.position = V3f(1.5f, 2, -1);
    lamp.radius = 0.1f;
    lamp.radiance = Rgb(400);
    add_light("lamp", lamp);
    add_sky(Rgb(0.2f));
    camera.fov = 20.0f;
    render.samples = 512;
    render.adaptive = AdaptiveParams{};
    render.adaptive->noise = 0.15f;
  }
};

}  // namespace pelage
