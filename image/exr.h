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

/// One channel of some rows of a layered image, named as in the file ("R", "key.diffuse.G", "Z",
/// "forward.u").
struct ExrChannel {
  std::string name;
  ChannelType type = ChannelType::kHalf;
  std::vector<float> pixels;  ///< width * rows, from the top; unused for kUint
  std::vector<uint32_t> ids;  ///< the same for kUint
};

using ExrAttribute = std::variant<int, float, std::string, V2f, V3f, M44f>;

using ExrAttributes = std::map<std::string, ExrAttribute>;

/// Produces rows y0 .. y1-1 of a picture. Every call must return the same channels in the same order.
using ExrRowSource = std::function<std::vector<ExrChannel>(int y0, int y1)>;

/// A complete single-part scan-line EXR.
struct ExrImage {
  int width = 0;
  int height = 0;
  std::vector<ExrChannel> channels;
  ExrAttributes attributes;

  const ExrChannel* find(std::string_view name) const;
};

/// Writes a picture as ExrWriter does, requesting a few rows at a time from `rows`. Those rows and the memory
/// needed for writing are charged as film until the call returns. Every call of `rows` must return the
/// channels of the first one. Throws Error (kFailed) naming the path.
void write_exr(const std::filesystem::path& path, int width, int height, const ExrAttributes& attributes,
               const ExrRowSource& rows, const Workers& workers, MemoryLedger& ledger);
/// The same for a picture that is already in memory.
void write_exr(const std::filesystem::path& path, const ExrImage& image);

/// Reads every channel of the first part (scan lines or tiles) over its data window, and the attributes that
/// ExrAttribute can hold. Throws Error (kInput) naming the file when it is missing or damaged.
ExrImage read_exr(const std::filesystem::path& path);

}  // namespace pelage
