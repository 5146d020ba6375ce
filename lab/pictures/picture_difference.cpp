// SPDX-License-Identifier: Apache-2.0
#include "lab/pictures/picture_difference.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/error.h"

namespace pelage {
namespace {

bool is_color(const std::string& name) { return name == "R" || name == "G" || name == "B"; }

unsigned char srgb_byte(float linear) {
  const float x = std::clamp(std::isfinite(linear) ? linear : 0.0f, 0.0f, 1.0f);
  const float y = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
  return static_cast<unsigned char>(std::lround(255 * y));
}

std::optional<ExrImage> read_if_there(const std::filesystem::path& path) {
  try {
    return read_exr(path);
  } catch (const Error&) {
    return {};
  }
}

}  // namespace

std::optional<PictureDifference> compare_pictures(const ExrImage& a, const ExrImage& b) {
  if (a.width != b.width || a.height != b.height || a.channels.size() != b.channels.size()) return {};
  PictureDifference result;
  result.pixels = int64_t(a.width) * a.height;
  result.mask.width = a.width;
  result.mask.height = a.height;
  result.mask.channels = 1;
  result.mask.pixels.assign(static_cast<size_t>(result.pixels), 0);
  for (const ExrChannel& channel : a.channels) {
    const ExrChannel* other = b.find(channel.name);
    if (!other || other->pixels.size() != channel.pixels.size() || other->ids.size() != channel.ids.size())
      return {};
    for (size_t i = 0; i < channel.pixels.size(); ++i) {
      const float x = channel.pixels[i], y = other->pixels[i];
      if (std::bit_cast<uint32_t>(x) == std::bit_cast<uint32_t>(y)) continue;
      result.mask.pixels[i] = 255;
      if (is_color(channel.name)) result.largest = std::fmax(result.largest, std::abs(double(x) - double(y)));
    }
    for (size_t i = 0; i < channel.ids.size(); ++i) {
      if (channel.ids[i] != other->ids[i]) result.mask.pixels[i] = 255;
    }
  }
  result.differing = std::count(result.mask.pixels.begin(), result.mask.pixels.end(), 255);
  return result;
}

std::optional<PictureDifference> compare_picture_files(const std::filesystem::path& a,
                                                       const std::filesystem::path& b) {
  const std::optional<ExrImage> first = read_if_there(a), second = read_if_there(b);
  return first && second ? compare_pictures(*first, *second) : std::nullopt;
}

std::optional<Picture> screen_picture(const ExrImage& image, int max_width, const std::string& caption) {
  const ExrChannel* channels[] = {image.find("R"), image.find("G"), image.find("B")};
  if (std::find(std::begin(channels), std::end(channels), nullptr) != std::end(channels)) return {};
  const int factor = std::max(1, (image.width + max_width - 1) / max_width);
  Picture picture;
  picture.caption = caption;
  picture.width = std::max(1, image.width / factor);
  picture.height = std::max(1, image.height / factor);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      for (const ExrChannel* channel : channels) {
        float sum = 0;
        int count = 0;
        for (int v = y * factor; v < std::min((y + 1) * factor, image.height); ++v) {
          for (int u = x * factor; u < std::min((x + 1) * factor, image.width); ++u, ++count)
            sum += channel->pixels[static_cast<size_t>(v) * static_cast<size_t>(image.width) +
                                   static_cast<size_t>(u)];
        }
        picture.pixels.push_back(srgb_byte(sum / static_cast<float>(count)));
      }
    }
  }
  return picture;
}

std::optional<Picture> screen_picture_of(const std::filesystem::path& path, int max_width,
                                         const std::string& caption) {
  const std::optional<ExrImage> image = read_if_there(path);
  return image ? screen_picture(*image, max_width, caption) : std::nullopt;
}

}  // namespace pelage
