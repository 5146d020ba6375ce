// SPDX-License-Identifier: Apache-2.0
#include "python/pictures.h"

#include <algorithm>

#include "python/arrays.h"

namespace py = pybind11;

namespace pelage {
namespace {

template <class T>
py::array_t<T> interleaved(const std::vector<const std::vector<T>*>& channels, int width, int height) {
  const size_t n = channels.size();
  std::vector<T> pixels(n * static_cast<size_t>(width) * static_cast<size_t>(height));
  for (size_t c = 0; c < n; ++c) {
    for (size_t p = 0; p < channels[c]->size(); ++p) pixels[p * n + c] = (*channels[c])[p];
  }
  return array_from(std::move(pixels), {height, width, static_cast<py::ssize_t>(n)});
}

}  // namespace

std::string layer_of(const std::string& channel, const std::vector<std::string>& all) {
  if (channel.size() == 1 && std::string("RGBA").find(channel) != std::string::npos) return "RGBA";
  const std::string before = channel.substr(0, channel.rfind('.'));
  return std::find(all.begin(), all.end(), before) == all.end() ? before : channel;
}

py::dict layer_arrays(std::vector<ExrChannel> channels, int width, int height) {
  std::vector<std::string> names;
  for (const ExrChannel& channel : channels) names.push_back(channel.name);
  py::dict layers;
  for (size_t i = 0; i < channels.size();) {
    const std::string layer = layer_of(names[i], names);
    const bool counts = channels[i].type == ChannelType::kUint;
    std::vector<const std::vector<float>*> floats;
    std::vector<const std::vector<uint32_t>*> ids;
    for (const ExrChannel& channel : channels) {
      if (layer_of(channel.name, names) != layer) continue;
      counts ? ids.push_back(&channel.ids) : floats.push_back(&channel.pixels);
    }
    const py::str key(layer);
    if (counts) {
      layers[key] = interleaved(ids, width, height);
    } else {
      layers[key] = interleaved(floats, width, height);
    }
    do {
      ++i;
    } while (i < channels.size() && layers.contains(layer_of(names[i], names)));
  }
  return layers;
}

}  // namespace pelage
