// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "image/texel_layout.h"

namespace pelage {

/// Texels of a side of a tile.
constexpr int kTileSide = 64;

/// An image as square tiles in a file without a name in the folder for temporary files (TMPDIR): it is gone
/// with this value, or with the process, however that ends. Layout: PelageTiles in image/reader_module.h.
class TileFile {
 public:
  /// Throws Error (kFailed) when no file can be made.
  explicit TileFile(const TexelLayout& layout);
  ~TileFile();
  TileFile(const TileFile&) = delete;
  TileFile& operator=(const TileFile&) = delete;

  /// Takes the next rows from the top. Throws Error (kFailed) when the disk is full.
  void add_rows(const std::byte* rows, int count);

  /// Complete once all rows were added.
  int descriptor() const { return descriptor_; }
  /// What a file that is being filled has in memory.
  static size_t buffer_bytes(const TexelLayout& layout);

 private:
  void write_band();

  TexelLayout layout_;
  int descriptor_ = -1;
  int rows_ = 0;
  std::vector<std::byte> band_;  // a row of tiles
};

}  // namespace pelage
