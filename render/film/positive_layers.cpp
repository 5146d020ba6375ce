// SPDX-License-Identifier: Apache-2.0
#include "render/film/positive_layers.h"

#include <algorithm>

namespace pelage {
namespace {

/// Indices of red channels.
struct Parts {
  struct Divided {
    size_t whole, direct, indirect;
  };
  std::vector<size_t> parts;     // which add up to the radiance
  std::vector<Divided> divided;  // layers that are the sum of two parts
};

size_t red_of(size_t layer) { return 4 + 3 * layer; }

Parts parts_of(const FilmLayers& layers) {
  Parts result;
  if (!layers.events) {
    for (size_t i = 0; i < layers.size(); ++i) result.parts.push_back(red_of(i));
    return result;
  }
  size_t indirect = red_of(layers.size());
  std::vector<bool> is_whole(layers.size());
  for (size_t light = 0; light < layers.lights(); ++light) {
    for (int group = 0; group < layers.groups; ++group, indirect += 3) {
      const size_t whole = layers.scattered(light, group);
      is_whole[whole] = true;
      result.divided.push_back({red_of(whole), red_of(layers.direct(light, group)), indirect});
      result.parts.push_back(indirect);
    }
  }
  for (size_t i = 0; i < layers.size(); ++i) {
    if (!is_whole[i]) result.parts.push_back(red_of(i));
  }
  return result;
}

}  // namespace

void make_positive(const FilmLayers& layers, std::vector<ExrChannel>& channels) {
  const Parts all = parts_of(layers);
  for (size_t c = 0; c < 3; ++c) {
    for (size_t p = 0; p < channels[c].pixels.size(); ++p) {
      const auto value = [&](size_t red) -> float& { return channels[red + c].pixels[p]; };
      const auto is_negative = [&](size_t red) { return value(red) < 0; };
      if (!is_negative(0) && std::none_of(all.parts.begin(), all.parts.end(), is_negative)) continue;
      value(0) = std::max(value(0), 0.0f);
      float sum = 0;
      for (const size_t red : all.parts) sum += std::max(value(red), 0.0f);
      const float scale = sum > 0 ? value(0) / sum : 0.0f;
      for (const size_t red : all.parts) value(red) = scale * std::max(value(red), 0.0f);
      for (const Parts::Divided& layer : all.divided)
        value(layer.whole) = value(layer.direct) + value(layer.indirect);
    }
  }
}

}  // namespace pelage
