// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "base/vector.h"

namespace pelage {

/// Pixels x0 <= x < x1, y0 <= y < y1, in the pixel space of a file: x right, y down.
struct PixelBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  bool is_empty() const { return x0 >= x1 || y0 >= y1; }
  bool operator==(const PixelBox&) const = default;
};

/// Returns the pixels that are in both boxes.
inline PixelBox intersection(const PixelBox& a, const PixelBox& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

class MemoryLedger;
class Workers;

enum class ChannelType { kHalf, kFloat, kUint };

/// Pixels of one channel in some rows of an image. `name` is the name in the file: "R", "key.diffuse.G", "Z"
/// or "forward.u".
struct ExrChannel {
  std::string name;
  ChannelType type = ChannelType::kHalf;
  std::vector<float> pixels;  ///< width * rows values, rows from the top; empty for kUint
  std::vector<uint32_t> ids;  ///< width * rows values for kUint; otherwise empty
};

using ExrAttribute = std::variant<int, float, std::string, V2f, V3f, M44f>;

using ExrAttributes = std::map<std::string, ExrAttribute>;

/// Returns rows y0 .. y1-1 of a picture, counted from the top of its data window; none if y0 == y1. Every
/// call must return the same channels in the same order.
using ExrRowSource = std::function<std::vector<ExrChannel>(int y0, int y1)>;

/// All pixels and attributes of an EXR file with a single part.
struct ExrImage {
  int width = 0;
  int height = 0;
  std::vector<ExrChannel> channels;
  ExrAttributes attributes;

  /// Returns the channel with this name, or nullptr.
  const ExrChannel* find(std::string_view name) const;
};

/// Writes a picture with an ExrWriter. `data`: data window, the pixels that `rows` provides. `display`:
/// display window, the frame of the picture. First calls rows(0, 0) to learn the channels, then calls `rows`
/// for a few rows at a time, from the top. Charges the memory of these rows and of the writer as film until
/// the call returns. Throws Error (kFailed) naming the path.
void write_exr(const std::filesystem::path& path, const PixelBox& data, const PixelBox& display,
               const ExrAttributes& attributes, const ExrRowSource& rows, const Workers& workers,
               MemoryLedger& ledger);
/// Writes a picture that is already in memory, on the calling thread. Throws Error (kFailed) naming the path.
void write_exr(const std::filesystem::path& path, const ExrImage& image);

/// Reads the first part of a file, which may have scan lines or tiles: all channels over the data window, and
/// the attributes that ExrAttribute can hold. Throws Error (kInput) naming the file when the file is missing,
/// damaged or subsampled.
ExrImage read_exr(const std::filesystem::path& path);

}  // namespace pelage
