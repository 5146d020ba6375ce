// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace pelage {

/// Heap blocks of at least this size have their own pages after keep_heap_small().
inline constexpr size_t kHeapPages = 16 * 1024;

/// Makes the heap of this process return memory to the system when it is freed. Without this call, a third of
/// the memory is lost to fragmentation if several threads keep allocating and freeing blocks of similar size,
/// such as the trees of chunks. Call once, before threads are started.
void keep_heap_small();

/// Also returns free memory between used blocks to the system. Call after freeing much memory that will not
/// be needed again.
void trim_heap();

/// Actual size of a block of `bytes` after keep_heap_small().
size_t heap_bytes(size_t bytes);

}  // namespace pelage
