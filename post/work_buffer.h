// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "image/exr_file.h"

namespace pelage {

/// One sample of the work buffer: the coordinates of the visible source pixel as two 16-bit numbers, and its
/// distance as a float. A sample takes 8 bytes and contains no colours [Neulander13]. All data is packed in
/// one number. The nearer of two samples has the smaller number; if both are equally far, so does the one
/// that comes first in the source. Therefore the visible sample does not depend on the order of drawing.
/// Seams (class Warp) are behind all pixels at a finite distance, and in front of pixels at an infinite
/// distance.
class Sample {
 public:
  Sample() = default;
  Sample(float depth, int x, int y) : Sample(std::bit_cast<uint32_t>(depth), x, y) {
    if (!(depth < std::numeric_limits<float>::infinity())) bits_ |= kBehind;
  }
  /// Returns a sample of a seam. `depth` must be finite.
  static Sample seam(float depth, int x, int y) {
    Sample sample(std::bit_cast<uint32_t>(depth), x, y);
    sample.bits_ |= kBehind;
    return sample;
  }

  bool is_empty() const { return bits_ == kEmpty; }
  bool is_seam() const { return bits_ >= kBehind && bits_ < kInfinite; }
  int x() const { return static_cast<int>(bits_ & 0xffff); }
  int y() const { return static_cast<int>(bits_ >> 16 & 0xffff); }
  /// Both coordinates of the source pixel in one number, to test whether two samples show the same pixel.
  uint32_t pixel() const { return static_cast<uint32_t>(bits_); }
  float depth() const { return std::bit_cast<float>(static_cast<uint32_t>(bits_ >> 32) & 0x7fffffff); }
  bool is_nearer_than(Sample other) const { return bits_ < other.bits_; }
  bool operator==(const Sample&) const = default;

 private:
  Sample(uint32_t depth, int x, int y)
      : bits_(uint64_t{depth} << 32 | static_cast<uint32_t>(y) << 16 | static_cast<uint32_t>(x)) {}

  static constexpr uint64_t kBehind = uint64_t{1} << 63;  // the sign of the depth
  static constexpr uint64_t kInfinite = uint64_t{0xff800000} << 32;
  static constexpr uint64_t kEmpty = ~uint64_t{0};  // farther than infinity; no picture has such a pixel
  uint64_t bits_ = kEmpty;
};
static_assert(sizeof(Sample) == 8);

/// The samples of a tile of the picture. Each pixel has scale * scale samples. The tile contains the samples
/// of the pixels in `box`. Coordinates of samples count from the upper left corner of the whole picture.
class WorkBuffer {
 public:
  WorkBuffer(PixelBox box, int scale) { reset(box, scale); }

  /// Changes the tile, and makes all samples empty.
  void reset(PixelBox box, int scale) {
    samples_ = {box.x0 * scale, box.y0 * scale, box.x1 * scale, box.y1 * scale};
    width_ = static_cast<size_t>(samples_.width());
    data_.assign(width_ * static_cast<size_t>(samples_.height()), Sample());
  }
  /// Makes all samples empty.
  void clear() { std::fill(data_.begin(), data_.end(), Sample()); }

  /// Range of the samples of the tile.
  const PixelBox& samples() const { return samples_; }
  /// Pointer to the sample in column samples().x0 of row `y`.
  Sample* row(int y) { return &data_[static_cast<size_t>(y - samples_.y0) * width_]; }
  const Sample* row(int y) const { return const_cast<WorkBuffer*>(this)->row(y); }

  /// Stores `sample` in columns x0 <= x < x1 of row y wherever it is nearer than the current sample. The
  /// columns and the row must lie within samples().
  void put(int y, int x0, int x1, Sample sample) {
    Sample* const to = row(y) - samples_.x0;
    for (int x = x0; x < x1; ++x) to[x] = sample.is_nearer_than(to[x]) ? sample : to[x];
  }

  /// Memory in bytes for the samples of a tile.
  static size_t bytes_needed(PixelBox box, int scale) {
    return sizeof(Sample) * static_cast<size_t>(box.width()) * static_cast<size_t>(box.height()) *
           static_cast<size_t>(scale) * static_cast<size_t>(scale);
  }

 private:
  PixelBox samples_;
  size_t width_ = 0;
  std::vector<Sample> data_;
};

}  // namespace pelage
