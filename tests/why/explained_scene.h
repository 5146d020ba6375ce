// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "base/file.h"
#include "render/accel/kept_fur.h"
#include "render/frame/frame_geometry.h"
#include "tests/world/small_scene.h"
#include "why/pixel_why.h"

namespace pelage {

/// The small scene, loaded, with its picture.
class ExplainedScene {
 public:
  explicit ExplainedScene(const std::vector<Override>& overrides)
      : scene(load_scene(files_.path("scene.yaml"), overrides)),
        assets(load_assets(scene, job)),
        world(compose(scene, *assets, scene.frames.frames.front(), job)),
        picture(render(world, job)) {}

  PixelWhy explain(int x, int y) { return explain_pixel({scene, *assets, world, geometry, &fur}, x, y, job); }
  std::string path(const std::string& name) const { return files_.path(name); }

 private:
  SmallScene files_{true};
  const Workers workers_{2};
  MemoryLedger ledger_;
  NoProgress progress_;

 public:
  const Job job{workers_, ledger_, progress_};
  const SceneDescription scene;
  const std::unique_ptr<Assets> assets;
  World world;
  const FrameResult picture;
  KeptFur fur;
  std::unique_ptr<FrameGeometry> geometry;
};

}  // namespace pelage
