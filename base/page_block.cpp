// SPDX-License-Identifier: Apache-2.0
#include "base/page_block.h"

#include <cstdint>
#include <new>

#include <sys/mman.h>

#include "base/page_pool.h"

namespace pelage {
namespace {

constexpr size_t kPageBytes = 4096;
constexpr size_t kOwnPages = 64 * 1024;  // from this size on, a partially used page costs little
constexpr size_t kAlignment = 64;
constexpr uintptr_t kLargePageBytes = uintptr_t(2) << 20;

}  // namespace

size_t PageBlock::held_bytes(size_t bytes) {
  const size_t grain = bytes >= kOwnPages ? kPageBytes : kAlignment;
  return (bytes + grain - 1) / grain * grain;
}

PageBlock::PageBlock(size_t bytes) : bytes_(held_bytes(bytes)) {
  if (bytes_ == 0) return;
  if (bytes_ < kOwnPages) {
    data_ = static_cast<std::byte*>(::operator new(bytes_, std::align_val_t(kAlignment)));
    return;
  }
  void* pages = ::mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (pages == MAP_FAILED) {
    bytes_ = 0;
    throw std::bad_alloc();
  }
  data_ = static_cast<std::byte*>(pages);
}

void PageBlock::prefer_large_pages() {
#ifdef MADV_HUGEPAGE
  // Only whole pages within the block: nothing outside may become resident.
  const auto begin =
      (reinterpret_cast<uintptr_t>(data_) + kLargePageBytes - 1) / kLargePageBytes * kLargePageBytes;
  const auto end = (reinterpret_cast<uintptr_t>(data_) + bytes_) / kLargePageBytes * kLargePageBytes;
  if (bytes_ >= kOwnPages && begin < end)
    ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
#endif
}

PageBlock::~PageBlock() {
  if (!data_) return;
  if (pool_) {
    pool_->release_block(data_, bytes_);
  } else if (bytes_ < kOwnPages) {
    ::operator delete(data_, std::align_val_t(kAlignment));
  } else {
    ::munmap(data_, bytes_);
  }
}

}  // namespace pelage
