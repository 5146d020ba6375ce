// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "render/scene/render_scene.h"

namespace pelage {

/// The settings of the picture and of its samples that one render uses instead of those of its scene. Values
/// that concern geometry have no effect: the size of the picture, memory, the accelerator, boxes, level of
/// detail and `gather.min_width`.
struct FrameSettings {
  ImageParams image;
  RenderParams render;
};

/// A scene as one render sees it: with the settings of the scene, or with others. It only refers to its
/// arguments, which must outlive it, so copies are cheap.
struct FrameScene {
  FrameScene(const RenderScene& scene) : FrameScene(scene, scene.image, scene.render) {}
  FrameScene(const RenderScene& scene, const FrameSettings& settings)
      : FrameScene(scene, settings.image, settings.render) {}
  FrameScene(RenderScene&&) = delete;

  const std::vector<FurPart>& fur;
  const std::vector<SkinPart>& skins;
  const std::vector<MaterialParams>& materials;
  const LightSet& lights;
  const MagnetSet& magnets;
  const Camera& camera;
  const ImageParams& image;
  const RenderParams& render;

  /// The sources of light that this render tells apart: with light layers, each light; otherwise, groups of
  /// lights, so that time and memory do not grow with the count of lights.
  size_t sources() const { return image.light_layers ? lights.size() : lights.groups(); }
  size_t source(size_t light) const { return image.light_layers ? light : lights.group(light); }
  /// The group of LightSet that contains the lights of a source.
  size_t group(size_t source) const { return image.light_layers ? lights.group(source) : source; }

 private:
  FrameScene(const RenderScene& scene, const ImageParams& image_params, const RenderParams& render_params)
      : fur(scene.fur),
        skins(scene.skins),
        materials(scene.materials),
        lights(scene.lights),
        magnets(scene.magnets),
        camera(scene.camera),
        image(image_params),
        render(render_params) {}
};

}  // namespace pelage
