// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pelage {

/// How a channel of a pixel is computed if the samples of the pixel show several source pixels.
enum class LayerRole {
  kColor,  ///< premultiplied light or coverage: the average
  kData,   ///< normals, ids, vectors: the value of the nearest source pixel; zero if there is none
  kDepth,  ///< depth: the value of the nearest source pixel; infinity if there is none
  kMatte,  ///< id or coverage of a RankedMatte: coverage is averaged for each id, then ids are ranked again
};

/// Pixels of one channel in memory. Each is a word of 4 bytes: a float, or the bits of another number that is
/// only copied. Pixel (x, y) is words[(y - first_row) * row_stride + x * pixel_stride].
struct Plane {
  float* words = nullptr;
  ptrdiff_t pixel_stride = 1;
  ptrdiff_t row_stride = 0;
  int first_row = 0;

  float& at(int x, int y) const {
    return words[static_cast<ptrdiff_t>(y - first_row) * row_stride +
                 static_cast<ptrdiff_t>(x) * pixel_stride];
  }
};

/// One channel to process: reads `source` and writes `target`.
struct PostChannel {
  LayerRole role = LayerRole::kColor;
  Plane source;
  Plane target;
};

/// A Cryptomatte or a similar list of pairs (id, coverage) for each pixel, sorted by decreasing coverage.
/// `id` and `coverage` are indices of channels with the role kMatte.
struct RankedMatte {
  struct Rank {
    size_t id, coverage;
  };
  std::vector<Rank> ranks;
};

struct PostLayers {
  std::vector<PostChannel> channels;
  std::vector<RankedMatte> mattes;
};

}  // namespace pelage
