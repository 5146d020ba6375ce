// SPDX-License-Identifier: Apache-2.0
// The colour of one animal of a crowd: parts multiply what their materials give.
#include <gtest/gtest.h>

#include "tests/render/film/film_picture.h"
#include "tests/render/path/path_scene.h"

namespace pelage {
namespace {

/// Sum of a channel over the picture.
double sum(const ExrImage& image, const std::string& name) {
  double total = 0;
  for (const ExrChannel& channel : image.channels) {
    if (channel.name != name) continue;
    for (float value : channel.pixels) total += value;
  }
  return total;
}

ExrImage render(PathScene& scene) { return picture_of(scene.run().film); }

TEST(Tint, OfASkinMultipliesItsColour) {
  PathScene scene(12, 12);
  scene.camera.fov = 20;
  scene.render.samples = 4;
  scene.render.bounces = 0;
  scene.add_skin(sphere_mesh(1), LambertParams{});
  scene.add_sky(Rgb(0, 0, 0));
  SphereLightParams key;
  key.position = V3f(4, 5, 8);
  scene.add_light("key", key);
  const ExrImage plain = render(scene);
  scene.skins[0].tint = Rgb(0.5f, 1, 0);
  const ExrImage tinted = render(scene);
  ASSERT_GT(sum(plain, "R"), 0);
  EXPECT_NEAR(sum(tinted, "R") / sum(plain, "R"), 0.5, 2e-3);  // films are half floats
  // Lights are chosen by what they give in all colours, which rounds in other places.
  EXPECT_NEAR(sum(tinted, "G") / sum(plain, "G"), 1, 1e-3);
  EXPECT_EQ(sum(tinted, "B"), 0);
}

TEST(Tint, OfFurMultipliesItsColourUpToWhite) {
  PathScene scene(12, 12);
  scene.camera.fov = 6;
  scene.render.samples = 16;
  scene.render.bounces = 0;
  scene.add_fur(one_strand({V3f(0, -1, 0), V3f(0, 0, 0), V3f(0, 1, 0)}, 0.2f),
                diffuse_fibre(Rgb(0.4f, 0.4f, 0.8f)));
  scene.add_sky(Rgb(1));
  const ExrImage plain = render(scene);
  scene.fur[0].tint = Rgb(0.5f, 1, 3);
  const ExrImage tinted = render(scene);
  const auto of_fibre = [](const ExrImage& image, const std::string& channel) {
    return sum(image, "sky.diffuse." + channel);
  };
  ASSERT_GT(of_fibre(plain, "R"), 0);
  EXPECT_NEAR(of_fibre(tinted, "R") / of_fibre(plain, "R"), 0.5, 0.02);
  EXPECT_NEAR(of_fibre(tinted, "G") / of_fibre(plain, "G"), 1, 1e-3);
  EXPECT_NEAR(of_fibre(tinted, "B") / of_fibre(plain, "B"), 1 / 0.8, 0.02);  // not 3: fibres give no light
}

}  // namespace
}  // namespace pelage
