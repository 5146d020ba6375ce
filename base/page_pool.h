// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <mutex>
#include <vector>

#include "base/page_block.h"

namespace pelage {

/// Takes blocks from large pieces of address space and requests pages of 2 MiB from the system for them.
/// Random access is faster in large pages, even if each block is smaller than a page. The memory of a block
/// returns to the system as soon as the block is freed. Apart from blocks, at most the unused end of the last
/// used 2 MiB page of each piece is resident.
///
/// Must outlive its blocks. Thread safety: every member, and the destruction of blocks, from any thread.
class PagePool {
 public:
  PagePool() = default;
  ~PagePool();
  PagePool(const PagePool&) = delete;
  PagePool& operator=(const PagePool&) = delete;

  /// Like PageBlock(bytes), with the same actual size. Small blocks come from the heap, very large ones have
  /// their own pages. Throws std::bad_alloc.
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
