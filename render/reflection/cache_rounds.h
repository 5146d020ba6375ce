// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "render/scene/render_params.h"

namespace pelage {

/// The order in which the paths that fill the reflection cache are traced: all tiles of the picture in
/// several rounds. Each round traces a part of the paths of each pixel, so that the cells of a tile need
/// little memory.
struct CacheRounds {
  static constexpr int kSide = 16;  ///< of a tile, in pixels

  uint32_t count = 0;
  double paths = 0;  ///< per pixel and round, on average

  explicit CacheRounds(const RenderParams& render);
  /// Returns the max count of cells that the paths of a tile add in one round.
  size_t cells_of_tile() const;
};

}  // namespace pelage
