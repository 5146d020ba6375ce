// SPDX-License-Identifier: Apache-2.0
#include "base/heap.h"

#include <algorithm>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace pelage {
namespace {

constexpr size_t kPage = 4096;
constexpr size_t kHeader = 16;  // before the block, in its first page

}  // namespace

void keep_heap_small() {
#if defined(__GLIBC__)
  // Setting the threshold also stops the library from raising it whenever a large block is freed.
  mallopt(M_MMAP_THRESHOLD, static_cast<int>(kHeapPages));
  // Linux allows 65,530 mappings per process; half of them are left for others.
  mallopt(M_MMAP_MAX, 30000);
#endif
}

void keep_spare_heap(size_t limit, int threads) {
#if defined(__GLIBC__)
  constexpr size_t kMost = size_t{16} << 20,
                   kLeast = size_t{128} << 10;  // the least is the library's default
  if (limit != 0 && limit < size_t{1} << 30) {
    keep_heap_small();
    mallopt(M_TOP_PAD, static_cast<int>(kLeast));
    return;
  }
  // The main thread has a heap, too.
  const size_t share = limit == 0 ? kMost : limit / 40 / static_cast<size_t>(threads + 1);
  mallopt(M_TOP_PAD, static_cast<int>(std::clamp(share, kLeast, kMost)));
  mallopt(M_MMAP_THRESHOLD, 1 << 20);
#else
  (void)limit, (void)threads;
#endif
}

void trim_heap() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

size_t heap_bytes(size_t bytes) {
  if (bytes + kHeader < kHeapPages) return bytes;
  return (bytes + kHeader + kPage - 1) / kPage * kPage;
}

}  // namespace pelage
