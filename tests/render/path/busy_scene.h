// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/geom/random_strands.h"
#include "tests/render/path/path_scene.h"

namespace pelage {

/// Moving, half-transparent fur in two coats over a moving skin, through a lens.
struct BusyScene : PathScene {
  BusyScene() : PathScene(40, 30) {
    RandomStrandOptions o;
    o.strands = 150;
    o.motion_keys = 2;
    o.radius = 0.03f;
    ConeShellParams fibre;
    fibre.diffuse = 0.7f;  // given, so that no colour must be matched before every render
    add_fur(random_strands(11, o), fibre);
    fibre.opacity = Field(0.5f);
    add_fur(random_strands(12, o), fibre);
    add_skin(sphere_mesh(0.7f), LambertParams{});
    add_skin(sphere_mesh(0.3f), GlossyParams{});
    RectangleLightParams key;
    key.position = V3f(3, 3, 3);
    key.look_at = V3f(0);
    key.size = V2f(2, 2);
    key.radiance = Rgb(5, 4, 3);
    add_light("key", key);
    add_sky(Rgb(0.2f, 0.3f, 0.4f));
    camera.fov = 20.0f;
    camera.shutter = V2f(-0.25f, 0.25f);
    camera.lens = LensParams{2, 0.5f, 10};
    image.filter = PixelFilter::kBlackmanHarris;
    render.samples = 8;
  }
};

}  // namespace pelage
