// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>

namespace pelage {

class PagePool;

/// A block of memory of fixed size, aligned to 64 bytes and uninitialised. A block of at least 64 KiB has
/// pages of its own, which return to the system as soon as the block is freed. A smaller block is on the
/// heap.
class PageBlock {
 public:
  PageBlock() = default;
  /// Allocates at least `bytes` bytes. Throws std::bad_alloc.
  explicit PageBlock(size_t bytes);
  PageBlock(PageBlock&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)),
        bytes_(std::exchange(other.bytes_, 0)),
        pool_(std::exchange(other.pool_, nullptr)) {}
  PageBlock& operator=(PageBlock&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(bytes_, other.bytes_);
    std::swap(pool_, other.pool_);
    return *this;
  }
  ~PageBlock();

  /// Requests pages of 2 MiB from the system for the aligned 2 MiB ranges inside the block, because random
  /// access is faster in large pages. Has no effect where the system has no such pages. Call before writing
  /// to the block.
  void prefer_large_pages();

  std::byte* data() { return data_; }
  const std::byte* data() const { return data_; }
  /// Actual size in bytes: the requested size rounded up, to 64 bytes below 64 KiB, else to pages of 4 KiB.
  size_t bytes() const { return bytes_; }
  /// Returns the actual size that a block of `bytes` bytes would have.
  static size_t held_bytes(size_t bytes);

 private:
  friend class PagePool;
  PageBlock(PagePool& pool, std::byte* data, size_t bytes) : data_(data), bytes_(bytes), pool_(&pool) {}

  std::byte* data_ = nullptr;
  size_t bytes_ = 0;
  PagePool* pool_ = nullptr;  // the pool that made the block; null: the constructor allocated the block
};

}  // namespace pelage
