// SPDX-License-Identifier: Apache-2.0
#include "view/picture_bytes.h"

#include <cstring>

#include <Imath/half.h>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "base/temporary_folder.h"
#include "world/world.h"

namespace pelage {
namespace {

constexpr const char* kTypeNames[] = {"half", "float", "uint"};  // in the order of ChannelType

void append(const ExrChannel& channel, std::string& bytes) {
  const auto add = [&](const auto* values, size_t count) {
    bytes.append(reinterpret_cast<const char*>(values), count * sizeof *values);
  };
  if (channel.type == ChannelType::kUint) return add(channel.ids.data(), channel.ids.size());
  if (channel.type == ChannelType::kFloat) return add(channel.pixels.data(), channel.pixels.size());
  std::vector<uint16_t> halves(channel.pixels.size());
  for (size_t i = 0; i < halves.size(); ++i) halves[i] = half(channel.pixels[i]).bits();
  add(halves.data(), halves.size());
}

}  // namespace

std::string layer_bytes(const Picture& picture, const std::vector<std::string>& layers) {
  nlohmann::json head{{"version", picture.version}, {"edit", picture.edit},
                      {"frame", picture.frame},     {"width", picture.width},
                      {"height", picture.height},   {"grid", picture.grid},
                      {"samples", picture.samples}, {"channels", nlohmann::json::array()}};
  const PixelBox& full = picture.full;
  head["full"] = {full.x0, full.y0, full.x1, full.y1};
  for (const std::string& layer : layers) {
    for (const ExrChannel& channel : picture.layers.at(layer))
      head["channels"].push_back(
          {{"name", channel.name}, {"type", kTypeNames[static_cast<int>(channel.type)]}});
  }
  std::string bytes = head.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  bytes.append(7 - bytes.size() % 8, ' ');
  bytes += '\n';
  for (const std::string& layer : layers) {
    for (const ExrChannel& channel : picture.layers.at(layer)) append(channel, bytes);
  }
  return bytes;
}

std::string partial_exr(const Picture& picture) {
  ExrImage image{picture.width, picture.height, {}, {}};
  for (const auto& [name, channels] : picture.layers)
    image.channels.insert(image.channels.end(), channels.begin(), channels.end());
  image.attributes["pelage:partial"] = 1;
  image.attributes["pelage:samples"] = static_cast<int>(picture.samples);
  const TemporaryFolder folder;
  write_exr(folder.path() / "picture.exr", image);
  return read_file(folder.path() / "picture.exr");
}

std::string finished_exr(const FinishedFrame& frame) {
  const TemporaryFolder folder;
  const Workers alone = Workers::alone();
  MemoryLedger none;  // the render's ledger counts the film, and this file leaves at once
  NoProgress progress;
  write_frame(folder.path() / "picture.exr", frame.header, frame.camera, frame.result,
              {alone, none, progress});
  return read_file(folder.path() / "picture.exr");
}

}  // namespace pelage
