// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "image/texel_layout.h"

namespace pelage {

/// Min and max of the values of a channel, as stored_number() returns them (not decoded from sRGB).
using NumberRange = std::pair<float, float>;

/// The texels of one image, in the type in which its file stores them. All texels are in memory, or they are
/// in a file of tiles of which only some are resident. Immutable. Thread safety: const members may be called
/// from any thread.
class TexelStore {
 public:
  virtual ~TexelStore() = default;
  const TexelLayout& layout() const { return layout_; }
  const NumberRange& range(int channel) const { return ranges_[static_cast<size_t>(channel)]; }
  /// All texels, row by row from the top; null if they are in a file of tiles.
  const std::byte* in_memory() const { return in_memory_; }
  /// Copies the texels of a rectangle inside the image to `to`, row by row. Throws Error (kFailed) when a
  /// tile cannot be read.
  virtual void read(int x, int y, int width, int height, std::byte* to) const = 0;

 protected:
  TexelStore(const TexelLayout& layout, std::vector<NumberRange> ranges)
      : layout_(layout), ranges_(std::move(ranges)) {}
  void set_in_memory(const std::byte* texels) { in_memory_ = texels; }

 private:
  TexelLayout layout_;
  std::vector<NumberRange> ranges_;
  const std::byte* in_memory_ = nullptr;
};

/// An image whose texels are all in memory.
class TexelsInMemory final : public TexelStore {
 public:
  TexelsInMemory(const TexelLayout& layout, std::vector<NumberRange> ranges, std::vector<std::byte> texels);
  void read(int x, int y, int width, int height, std::byte* to) const override;

 private:
  std::vector<std::byte> texels_;
};

}  // namespace pelage
