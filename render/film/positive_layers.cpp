// SPDX-License-Identifier: Apache-2.0
#include "render/film/positive_layers.h"

#include <algorithm>
#include <array>

namespace pelage {
namespace {

size_t red_of(size_t layer) { return 4 + 3 * layer; }

/// Indices of the red channels of the layers that add up to the radiance: all but the direct parts, which
/// come last.
std::vector<size_t> parts_of(const FilmLayers& layers) {
  const size_t direct = layers.events ? layers.lights() * static_cast<size_t>(layers.groups) : 0;
  std::vector<size_t> parts(layers.size() - direct);
  for (size_t i = 0; i < parts.size(); ++i) parts[i] = red_of(i);
  return parts;
}

/// Indices of the red channels of a layer and of its direct and indirect part.
struct Divided {
  size_t whole, direct, indirect;
};

std::vector<Divided> divided_of(const FilmLayers& layers) {
  std::vector<Divided> divided;
  if (!layers.events) return divided;
  size_t indirect = red_of(layers.size());
  for (size_t light = 0; light < layers.lights(); ++light) {
    for (int group = 0; group < layers.groups; ++group, indirect += 3)
      divided.push_back(
          {red_of(layers.scattered(light, group)), red_of(layers.direct(light, group)), indirect});
  }
  return divided;
}

}  // namespace

void make_positive(const FilmLayers& layers, std::vector<ExrChannel>& channels) {
  const std::vector<size_t> parts = parts_of(layers);
  const std::vector<Divided> divided = divided_of(layers);
  for (size_t c = 0; c < 3; ++c) {
    for (size_t p = 0; p < channels[c].pixels.size(); ++p) {
      const auto value = [&](size_t red) -> float& { return channels[red + c].pixels[p]; };
      const auto is_negative = [&](size_t red) { return value(red) < 0; };
      /// Makes these values those above zero, scaled so that they add up to `whole`.
      const auto scale_to = [&](float whole, const auto& reds) {
        float sum = 0;
        for (const size_t red : reds) sum += std::max(value(red), 0.0f);
        const float scale = sum > 0 ? whole / sum : 0.0f;
        for (const size_t red : reds) value(red) = scale * std::max(value(red), 0.0f);
      };

      const bool any = is_negative(0) || std::any_of(parts.begin(), parts.end(), is_negative);
      if (any) {
        value(0) = std::max(value(0), 0.0f);
        scale_to(value(0), parts);
      }
      for (const Divided& layer : divided) {  // after the layers, so that dividing them changes none
        if (any || is_negative(layer.direct) || is_negative(layer.indirect))
          scale_to(value(layer.whole), std::array{layer.direct, layer.indirect});
      }
    }
  }
}

}  // namespace pelage
