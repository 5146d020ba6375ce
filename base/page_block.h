// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>

namespace pelage {

class PagePool;

/// A block of memory of fixed size, aligned to 64 bytes and uninitialised. Large blocks have their own pages,
/// which return to the system as soon as the block is freed, whatever else is on the heap.
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

  /// Requests pages of 2 MiB from the system where available, for data with random access. Call before
  /// writing to the block.
  void prefer_large_pages();

  std::byte* data() { return data_; }
  const std::byte* data() const { return data_; }
  /// Actual size, rounded up to the system's granularity.
  size_t bytes() const { return bytes_; }
  /// Actual size of a block of `bytes`.
  static size_t held_bytes(size_t bytes);

 private:
  friend class PagePool;
  PageBlock(PagePool& pool, std::byte* data, size_t bytes) : data_(data), bytes_(bytes), pool_(&pool) {}

  std::byte* data_ = nullptr;
  size_t bytes_ = 0;
  PagePool* pool_ = nullptr;  // takes the memory back when the block is freed; null: the system does
};

}  // namespace pelage
