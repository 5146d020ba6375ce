// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "image/texel_layout.h"

namespace pelage {

/// Side length of a tile in texels.
constexpr int kTileSide = 64;

/// A file that stores an image as square tiles. The file is in the folder for temporary files (TMPDIR) and
/// has no name, so it disappears when this object is destroyed or the process ends, even if the process is
/// killed. See PelageTiles in image/reader_module.h for the layout of the file.
class TileFile {
 public:
  /// Throws Error (kFailed) when the file cannot be created.
  explicit TileFile(const TexelLayout& layout);
  ~TileFile();
  TileFile(const TileFile&) = delete;
  TileFile& operator=(const TileFile&) = delete;

  /// Appends the next rows from the top. Throws Error (kFailed) when the disk is full.
  void add_rows(const std::byte* rows, int count);

  /// Descriptor of the file. The file is complete once all rows have been added.
  int descriptor() const { return descriptor_; }
  /// Memory in bytes that a TileFile uses until all rows have been added.
  static size_t buffer_bytes(const TexelLayout& layout);

 private:
  void write_band();

  TexelLayout layout_;
  int descriptor_ = -1;
  int rows_ = 0;
  std::vector<std::byte> band_;  // one row of tiles, in the layout of the file
};

}  // namespace pelage
