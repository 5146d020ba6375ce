// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>

namespace pelage {

class PagePool;

/// One piece of memory of a fixed size, aligned to 64 bytes and not initialised. Large pieces are pages of
/// their own: the system has them back the moment the block dies, whatever else the heap holds beside them.
class PageBlock {
 public:
  PageBlock() = default;
  /// Throws std::bad_alloc.
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

  /// Asks the system for pages of 2 MiB where it has them, for what is read in no order at all. Before the
  /// block is written to.
  void prefer_large_pages();

  std::byte* data() { return data_; }
  const std::byte* data() const { return data_; }
  /// What is really held, rounded up to what the system gives.
  size_t bytes() const { return bytes_; }
  /// What a block of `bytes` will hold.
  static size_t held_bytes(size_t bytes);

 private:
  friend class PagePool;
  PageBlock(PagePool& pool, std::byte* data, size_t bytes) : data_(data), bytes_(bytes), pool_(&pool) {}

  std::byte* data_ = nullptr;
  size_t bytes_ = 0;
  PagePool* pool_ = nullptr;  // which has it back
};

}  // namespace pelage
