// SPDX-License-Identifier: Apache-2.0
#include "view/picture.h"

#include <algorithm>
#include <utility>

namespace pelage {
std::string layer_of(const std::string& channel) {
  if (channel.size() == 1 && std::string("RGBA").find(channel) != std::string::npos) return "beauty";
  const size_t dot = channel.rfind('.');
  return dot == std::string::npos ? channel : channel.substr(0, dot);
}

std::map<std::string, std::vector<ExrChannel>> film_layers(
    const Film& film, const std::function<bool(const std::string&)>& wanted,
    std::vector<std::string>* names) {
  if (names) {
    for (const ExrChannel& channel : film.exr_rows(0, 0)) {
      const std::string layer = layer_of(channel.name);
      if (std::find(names->begin(), names->end(), layer) == names->end()) names->push_back(layer);
    }
  }
  std::map<std::string, std::vector<ExrChannel>> layers;
  // The page reads the integers of `id`; id.X, the same as floats, is for other programs.
  const auto accepts = [&](const std::string& channel) {
    return channel != "id.X" && wanted(layer_of(channel));
  };
  for (ExrChannel& channel : film.exr_pixels({0, 0, film.width(), film.height()}, accepts))
    layers[layer_of(channel.name)].push_back(std::move(channel));
  return layers;
}

}  // namespace pelage
