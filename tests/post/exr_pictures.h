// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/hash.h"
#include "image/exr_file.h"

namespace pelage {

/// A small picture with colours, depth, vectors, alpha and ids; nothing moves.
inline ExrImage still_image(int width, int height) {
  ExrImage image;
  image.width = width;
  image.height = height;
  const size_t pixels = static_cast<size_t>(width) * static_cast<size_t>(height);
  const auto add = [&](const char* name, ChannelType type, auto&& value) {
    ExrChannel channel{name, type, {}, {}};
    for (size_t i = 0; i < pixels; ++i) {
      if (type == ChannelType::kUint) {
        channel.ids.push_back(static_cast<uint32_t>(hash64(i, 7)));
      } else {
        channel.pixels.push_back(value(i));
      }
    }
    image.channels.push_back(std::move(channel));
  };
  const auto texture = [](size_t i) { return static_cast<float>(hash64(i, 3) % 1024) / 512; };
  add("A", ChannelType::kHalf, [](size_t) { return 1.0f; });
  add("B", ChannelType::kHalf, texture);
  add("N.X", ChannelType::kFloat, [](size_t i) { return signed_float(hash64(i, 5)); });
  add("R", ChannelType::kHalf, texture);
  add("Z", ChannelType::kFloat, [](size_t) { return 4.0f; });
  add("forward.u", ChannelType::kFloat, [](size_t) { return 0.0f; });
  add("forward.v", ChannelType::kFloat, [](size_t) { return 0.0f; });
  add("id", ChannelType::kUint, [](size_t) { return 0.0f; });
  add("key.diffuse.R", ChannelType::kFloat, texture);
  return image;
}

inline std::vector<float>& pixels_of(ExrImage& image, std::string_view name) {
  for (ExrChannel& channel : image.channels) {
    if (channel.name == name) return channel.pixels;
  }
  throw std::out_of_range(std::string(name));
}

/// All of a part: rows from the top of its data window, channel after channel.
inline std::vector<std::vector<float>> read_part(const std::filesystem::path& path, size_t part) {
  ExrReader reader(path);
  const ExrPart& info = reader.parts().at(part);
  const auto width = static_cast<size_t>(info.data.width()), height = static_cast<size_t>(info.data.height());
  std::vector<std::vector<float>> planes(info.channels.size(), std::vector<float>(width * height));
  std::vector<ExrRows> rows;
  for (size_t c = 0; c < planes.size(); ++c) rows.push_back({c, planes[c].data(), width});
  reader.read(part, info.data.y0, info.data.y1, rows);
  return planes;
}

/// Writes parts of these windows, each with the planes given; headers like those of `like`, which has one
/// part.
struct PartToWrite {
  std::string name;
  PixelBox data;
  std::vector<ExrChannelInfo> channels;
  std::vector<std::vector<float>> planes;
  std::string view;
};
inline void write_parts(const std::filesystem::path& path, const std::filesystem::path& like,
                        const PixelBox& display, std::vector<PartToWrite> parts) {
  const ExrReader reader(like);
  std::vector<ExrOutputPart> headers;
  for (const PartToWrite& part : parts) {
    ExrPart header;
    header.name = part.name;
    header.view = part.view;
    header.data = part.data;
    header.display = display;
    header.channels = part.channels;
    headers.push_back({0, header});
  }
  ExrWriter writer(path, reader, headers);
  for (size_t p = 0; p < parts.size(); ++p) {
    std::vector<ExrRows> rows;
    for (size_t c = 0; c < parts[p].planes.size(); ++c) {
      rows.push_back({c, parts[p].planes[c].data(), static_cast<size_t>(parts[p].data.width())});
    }
    writer.write(p, parts[p].data.height(), rows, Workers::alone());
  }
  writer.commit();
}

}  // namespace pelage
