// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <mutex>
#include <vector>

#include "base/page_block.h"

namespace pelage {

/// Blocks side by side in large pieces of address space, for which the system is asked for pages of 2 MiB: so
/// that what is read in no order at all has them even if each block is smaller than one. What a block held is
/// given back the moment it dies; besides what blocks hold, at most the rest of the large pages at the end of
/// each piece is resident.
///
/// Outlives its blocks. Thread safety: every member, and the death of blocks, from any thread.
class PagePool {
 public:
  PagePool() = default;
  ~PagePool();
  PagePool(const PagePool&) = delete;
  PagePool& operator=(const PagePool&) = delete;

  /// As PageBlock(bytes), with the same bytes held. Small blocks are the heap's, very large ones have pages
  /// of their own. Throws std::bad_alloc.
  PageBlock take(size_t bytes);

 private:
  friend class PageBlock;
  struct Piece {
    std::byte* begin = nullptr;
    void* mapping = nullptr;
    std::map<size_t, size_t> free;  // bytes from the beginning: how many are free from there on
  };

  void release_block(std::byte* data, size_t bytes);
  std::byte* take_from(Piece& piece, size_t bytes);
  static Piece make_piece();

  std::mutex mutex_;
  std::vector<Piece> pieces_;
};

}  // namespace pelage
