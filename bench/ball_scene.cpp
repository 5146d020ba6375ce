// SPDX-License-Identifier: Apache-2.0
#include "bench/ball_scene.h"

#include <memory>
#include <vector>

#include "bench/ball_chunks.h"
#include "image/texture_library.h"
#include "render/light/light_params.h"
#include "tests/procedurals/fixed.h"

namespace pelage {

RenderScene ball_scene(const BumpyBall& ball, const MaterialParams& fibre, const BallPicture& picture,
                       MemoryLedger& ledger) {
  TextureLibrary textures(ledger);
  RectangleLightParams key, rim;
  key.position = V3f(2.4f, 2.2f, 2.3f);
  key.look_at = V3f(0);
  key.size = V2f(2, 2);
  key.radiance = Rgb(14, 13, 12);
  rim.position = V3f(-2.2f, 1.8f, -2.8f);
  rim.look_at = V3f(0);
  rim.size = V2f(1.5f, 1.4f);
  rim.radiance = Rgb(16, 18, 22);
  EnvironmentLightParams sky;
  sky.radiance = Rgb(0.25f, 0.28f, 0.33f);
  std::vector<std::unique_ptr<Light>> lights;
  lights.push_back(make_light("key", key, 1, textures, ledger));
  lights.push_back(make_light("rim", rim, 1, textures, ledger));
  lights.push_back(make_light("sky", sky, 1, textures, ledger));

  CameraParams camera;
  camera.position = V3f(0, 0, 4.7f);
  camera.fov = 36.0f;
  ImageParams image;
  image.width = picture.width;
  image.height = picture.height;
  image.filter = PixelFilter::kBox;
  RenderParams render;
  render.integrator = Integrator::kPath;
  render.bounces = picture.bounces;
  render.samples = picture.samples;
  LambertParams skin;
  skin.color = Field(Rgb(0.45f, 0.30f, 0.22f));
  RenderScene scene{{},
                    {},
                    {fibre, skin},
                    LightSet(std::move(lights)),
                    Camera(camera, 1, picture.width, picture.height),
                    image,
                    render};
  scene.fur.push_back({"ball.fur", {}, 0, nullptr});
  std::vector<size_t> ends;
  const size_t max = picture.chunk_strands > 0 ? picture.chunk_strands : ball.strands.strand_count();
  const std::vector<uint32_t> order = neighbours(ball.strands, max, ends);
  size_t begin = 0;
  for (size_t end : ends) {
    scene.fur[0].procedurals.push_back(std::make_unique<FixedStrands>(
        ends.size() == 1 ? ball.strands : pick(ball.strands, order, begin, end)));
    begin = end;
  }
  scene.skins.push_back({"ball.skin", std::make_shared<FixedSkin>(ball.skin), nullptr, 1});
  return scene;
}

}  // namespace pelage
