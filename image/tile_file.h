// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "image/texel_layout.h"

namespace pelage {

/// Side length of a tile in texels.
constexpr int kTileSide = 64;

/// An image as square tiles in an unnamed file in the folder for temporary files (TMPDIR). The file
/// disappears when this object is destroyed or the process ends, even if the process is killed. Layout:
/// PelageTiles in image/reader_module.h.
class TileFile {
 public:
  /// Throws Error (kFailed) when the file cannot be created.
  explicit TileFile(const TexelLayout& layout);
  ~TileFile();
  TileFile(const TileFile&) = delete;
  TileFile& operator=(const TileFile&) = delete;

  /// Appends the next rows from the top. Throws Error (kFailed) when the disk is full.
  void add_rows(const std::byte* rows, int count);

  /// The file is complete once all rows were added.
  int descriptor() const { return descriptor_; }
  /// Memory used while a file is filled.
  static size_t buffer_bytes(const TexelLayout& layout);

 private:
  void write_band();

  TexelLayout layout_;
  int descriptor_ = -1;
  int rows_ = 0;
  std::vector<std::byte> band_;  // a row of tiles
};

}  // namespace pelage
