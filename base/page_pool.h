// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <mutex>
#include <vector>

#include "base/page_block.h"

namespace pelage {

/// Makes blocks of memory within mappings of 256 MiB, for which it requests pages of 2 MiB from the system.
/// Several blocks share a page of 2 MiB, so random access is faster even for blocks smaller than such a page.
/// The memory of a block returns to the system as soon as the block is freed. Besides the blocks, the unused
/// rest of a 2 MiB page that contains a block may be resident. New blocks fill the lowest free range that is
/// large enough, which keeps this rest small.
///
/// Must outlive its blocks. Thread safety: every member may be called, and blocks may be destroyed, on any
/// thread.
class PagePool {
 public:
  PagePool() = default;
  ~PagePool();
  PagePool(const PagePool&) = delete;
  PagePool& operator=(const PagePool&) = delete;

  /// Returns a block of the size that PageBlock(bytes) would have, including its rounding. Blocks below 64
  /// KiB come from the heap. Blocks above 16 MiB have a mapping of their own. Throws std::bad_alloc.
  PageBlock take(size_t bytes);

 private:
  friend class PageBlock;
  struct Piece {
    std::byte* begin = nullptr;
    void* mapping = nullptr;
    std::map<size_t, size_t> free;  // free ranges: offset to length in bytes
  };

  void release_block(std::byte* data, size_t bytes);
  std::byte* take_from(Piece& piece, size_t bytes);
  static Piece make_piece();

  std::mutex mutex_;
  std::vector<Piece> pieces_;
};

}  // namespace pelage
