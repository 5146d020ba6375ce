// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/scene/render_scene.h"

namespace pelage {

/// Restores the picture's settings of a scene at the end of its life.
class KeptSettings {
 public:
  explicit KeptSettings(RenderScene& scene) : scene_(scene), image_(scene.image), render_(scene.render) {}
  ~KeptSettings() {
    scene_.image = image_;
    scene_.render = render_;
  }
  KeptSettings(const KeptSettings&) = delete;
  KeptSettings& operator=(const KeptSettings&) = delete;

 private:
  RenderScene& scene_;
  const ImageParams image_;
  const RenderParams render_;
};

}  // namespace pelage
