// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pelage {

/// How a channel is resolved where one pixel of the result shows several pixels of the source.
enum class LayerRole {
  kColor,  ///< premultiplied light or coverage: averaged
  kData,   ///< normals, ids, vectors ...: from the front-most visible pixel, zero where there is none
  kDepth,  ///< the same, but infinite where there is none
  kMatte,  ///< part of a ranked matte: averaged by id, then ranked again
};

/// Words of 4 bytes in memory: floats, or the bits of other numbers when they are only copied. Pixel (x, y)
/// is words[(y - first_row) * row_stride + x * pixel_stride].
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

/// One channel to process. `source` is read-only.
struct PostChannel {
  LayerRole role = LayerRole::kColor;
  Plane source;
  Plane target;
};

/// A Cryptomatte or another list of (id, coverage), best first: numbers of channels, all of role kMatte.
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
