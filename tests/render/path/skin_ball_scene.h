// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/geom/eared_skin.h"
#include "tests/render/path/path_scene.h"

namespace pelage {

/// A furry ball between a light in front, a light behind and a flat sky.
struct SkinBallScene : PathScene {
  explicit SkinBallScene(SkinMesh skin = sphere_skin(32)) : PathScene(40, 32) {
    ConeShellParams fibre;
    fibre.diffuse = 0.7f;  // given, so that no colour must be matched before every render
    add_fur(furball(3000, 0.3f, 0.01f), fibre);
    fur[0].skin = 0;
    add_skin(std::move(skin), LambertParams{});
    RectangleLightParams key;
    key.position = V3f(3, 3, 3);
    key.look_at = V3f(0);
    key.size = V2f(2, 2);
    key.radiance = Rgb(10);
    add_light("key", key);
    key.position = V3f(-3, 2, -3);
    add_light("rim", key);
    add_sky(Rgb(0.2f));
    camera.fov = 14.0f;
    render.bounces = 1;
    render.samples = 16;
  }
};

}  // namespace pelage
