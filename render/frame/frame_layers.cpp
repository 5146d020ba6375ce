// SPDX-License-Identifier: Apache-2.0
#include "render/frame/frame_layers.h"

#include <algorithm>

namespace pelage {
namespace {

/// The number of lobe groups that a material uses, counted from the first.
int lobe_groups(const MaterialParams& material) {
  if (std::holds_alternative<LambertParams>(material)) return 1;
  return std::holds_alternative<GlossyParams>(material) ? 2 : kLobeGroups;
}

}  // namespace

FilmLayers frame_layers(const ImageParams& image, const RenderParams& render,
                        const std::vector<FilmLayers::LightInfo>& lights,
                        std::span<const MaterialParams> materials) {
  FilmLayers layers;
  if (image.light_layers) {
    int groups = 1;
    for (const MaterialParams& material : materials) groups = std::max(groups, lobe_groups(material));
    layers = FilmLayers::make(lights, groups, image.event_layers);
  }
  layers.lod = image.lod_layer;
  layers.noise = image.noise_layers || render.adaptive;
  const bool gathers = render.integrator == Integrator::kGather;
  const FilterSamples usual = gathers ? FilterSamples::kSplatted : FilterSamples::kDrawn;
  if (image.filter_samples.value_or(usual) == FilterSamples::kSplatted) layers.splat = image.filter;
  return layers;
}

}  // namespace pelage
