// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "base/vector.h"

namespace pelage {

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

/// Returns rows y0 .. y1-1 of a picture; none if y0 == y1. Every call must return the same channels in the
/// same order.
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

/// Writes a picture with an ExrWriter. First calls rows(0, 0) to learn the channels, then calls `rows` for a
/// few rows at a time, from the top. Charges the memory of these rows and of the writer as film until the
/// call returns. Throws Error (kFailed) naming the path.
void write_exr(const std::filesystem::path& path, int width, int height, const ExrAttributes& attributes,
               const ExrRowSource& rows, const Workers& workers, MemoryLedger& ledger);
/// Writes a picture that is already in memory, on the calling thread. Throws Error (kFailed) naming the path.
void write_exr(const std::filesystem::path& path, const ExrImage& image);

/// Reads the first part of a file, which may have scan lines or tiles: all channels over the data window, and
/// the attributes that ExrAttribute can hold. Throws Error (kInput) naming the file when the file is missing,
/// damaged or subsampled.
ExrImage read_exr(const std::filesystem::path& path);

}  // namespace pelage
