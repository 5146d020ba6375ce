// SPDX-License-Identifier: Apache-2.0
#include "base/page_block.h"

#include <new>

#include <sys/mman.h>

namespace pelage {
namespace {

constexpr size_t kPage = 4096;
constexpr size_t kOwnPages = 64 * 1024;  // from here on a page that is partly used costs little
constexpr size_t kAlignment = 64;

}  // namespace

size_t PageBlock::held_bytes(size_t bytes) {
  const size_t grain = bytes >= kOwnPages ? kPage : kAlignment;
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

PageBlock::~PageBlock() {
  if (!data_) return;
  if (bytes_ < kOwnPages) {
    ::operator delete(data_, std::align_val_t(kAlignment));
  } else {
    ::munmap(data_, bytes_);
  }
}

}  // namespace pelage
