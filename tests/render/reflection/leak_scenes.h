// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "image/exr.h"
#include "tests/render/path/path_scene.h"
#include "tests/render/reflection/plates.h"

namespace pelage {

/// A small picture of a lit and a dark region that touch. Where the cells of the reflection cache or the
/// patches of PathSharing join them, light leaks into the dark one.
struct LeakScene : PathScene {
  static constexpr int kSide = 48;

  LeakScene() : PathScene(kSide, kSide) {
    image.filter_samples = FilterSamples::kSplatted;
    render.samples = 16;
    render.bounces = 8;
    render.gather.cache_paths = 1;
  }
  void add_plates(const Plates& plates, const Rgb& color) {
    LambertParams hide;
    hide.color = Field(color);
    add_skin(plates.mesh(), hide);
    skins.back().rest = plates.rest();
  }
  void add_hair(const Plates& plates, StrandArrays hair, const Rgb& color) {
    ChiangParams fibre;
    fibre.color = Field(color);
    add_hair(plates, std::move(hair), fibre);
  }
  void add_hair(const Plates& plates, StrandArrays hair, const MaterialParams& fibre) {
    add_fur(Strands(std::move(hair)), fibre);
    fur.back().rest = plates.rest();
  }
  void add_lamp(const V3f& position, float radiance) {
    RectangleLightParams lamp;
    lamp.position = position;
    lamp.look_at = V3f(0);
    lamp.size = V2f(2, 2);
    lamp.radiance = Rgb(radiance);
    add_light("lamp", lamp);
  }

  PixelBox lit;   ///< a region of the picture that is lit
  PixelBox dark;  ///< more than eight pixels from the lit region along the skin or the strands
};

/// A closed ear, a pixel thick, seen from its edge. Pale fur on both sides; the light is on the left. Both
/// sides lie in the same cube of the skin at rest.
struct ThinEar : LeakScene {
  ThinEar() {
    Plates ear;
    ear.add_box(V3f(0.09f, -1, -1), V3f(0.13f, 1, 1));
    StrandArrays hair;
    for (const uint32_t face : {0u, 1u}) ear.grow(hair, face, 1500, 0.5f, 0.012f);
    add_plates(ear, Rgb(0.6f));
    add_hair(ear, std::move(hair), Rgb(0.85f));
    add_lamp(V3f(-5, 0, 0), 5);
    add_sky(Rgb(0.01f));
    camera.fov = 12;
    lit = {15, 4, 25, 44};
    dark = {28, 4, 37, 44};
  }
};

/// Hair that grows on the floor of a dark room, and through its roof. The room is open towards the camera;
/// the light comes from above and behind.
struct HairThroughSkin : LeakScene {
  HairThroughSkin() {
    Plates room;
    const V3f x(2, 0, 0), y(0, 1, 0), z(0, 0, 1), corner(-1, -0.9f, -0.5f);
    room.add(corner, z, x);      // floor
    room.add(corner + y, z, x);  // roof
    room.add(corner, x, y);      // back wall
    room.add(corner, y, z);      // left wall
    room.add(corner + x, z, y);  // right wall
    StrandArrays hair;
    room.grow(hair, 0, 400, 1.7f, 0.012f);
    add_plates(room, Rgb(0.8f));
    add_hair(room, std::move(hair), Rgb(0.85f));
    add_lamp(V3f(0, 4, -3), 5);
    add_sky(Rgb(0.01f));
    camera.fov = 12;
    lit = {2, 9, 46, 20};
    dark = {2, 32, 46, 44};
  }
};

/// A black and a white coat on one skin: black on the left, white on the right, both in the middle.
struct TwoCoats : LeakScene {
  TwoCoats() {
    Plates skin;
    skin.add(V3f(-1, -1, 0), V3f(2, 0, 0), V3f(0, 2, 0));
    StrandArrays black, white;
    skin.grow(black, 0, 1800, 0.3f, 0.012f, V2f(0), V2f(0.65f, 1));
    skin.grow(white, 0, 1800, 0.3f, 0.012f, V2f(0.35f, 0), V2f(1));
    add_plates(skin, Rgb(0.3f));
    add_hair(skin, std::move(black), Rgb(0.01f));
    add_hair(skin, std::move(white), Rgb(0.9f));
    add_lamp(V3f(1, 3, 4), 2.5f);
    add_sky(Rgb(0.2f));
    camera.fov = 10;
    lit = {36, 2, 46, 46};
    dark = {2, 2, 21, 46};
  }
};

/// Hair on a block, and at the bottom of a deep hole in it. The light grazes the block.
struct StrandInAHole : LeakScene {
  StrandInAHole() {
    Plates block;
    constexpr float kHalf = 0.3f, kDeep = 1.2f;
    const V3f side(2, 0, 0), across(0, 2, 0);
    const uint32_t left = block.add(V3f(-1, -1, 0), V3f(1 - kHalf, 0, 0), across);
    const uint32_t right = block.add(V3f(kHalf, -1, 0), V3f(1 - kHalf, 0, 0), across);
    const uint32_t below = block.add(V3f(-kHalf, -1, 0), V3f(2 * kHalf, 0, 0), V3f(0, 1 - kHalf, 0));
    const uint32_t above = block.add(V3f(-kHalf, kHalf, 0), V3f(2 * kHalf, 0, 0), V3f(0, 1 - kHalf, 0));
    const V3f corner(-kHalf, -kHalf, -kDeep), x(2 * kHalf, 0, 0), y(0, 2 * kHalf, 0), z(0, 0, kDeep);
    const uint32_t bottom = block.add(corner, x, y);
    block.add(corner, y, z);
    block.add(corner + x, z, y);
    block.add(corner, z, x);
    block.add(corner + y, x, z);
    StrandArrays hair;
    for (const uint32_t face : {left, right}) block.grow(hair, face, 600, 0.2f, 0.012f);
    for (const uint32_t face : {below, above}) block.grow(hair, face, 180, 0.2f, 0.012f);
    block.grow(hair, bottom, 150, 0.4f, 0.012f);
    add_plates(block, Rgb(0.2f));
    add_hair(block, std::move(hair), diffuse_fibre(Rgb(0.5f)));
    add_lamp(V3f(-6, 0, 0.8f), 10);
    add_sky(Rgb(0.01f));
    camera.fov = 8;
    lit = {2, 4, 10, 44};
    dark = {18, 18, 30, 30};
  }
};

}  // namespace pelage
