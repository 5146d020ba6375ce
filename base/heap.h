// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace pelage {

/// Blocks of the heap of at least this size are pages of their own after keep_heap_small().
inline constexpr size_t kHeapPages = 16 * 1024;

/// Makes the heap of this process give memory back to the system as it is freed. Without it, pieces of one
/// size that are made and dropped all the time by several threads, the trees of chunks above all, leave a
/// third more behind than is in use. Called once, before threads are started.
void keep_heap_small();

/// Gives what is free between blocks in use back to the system too: for the moment when much was dropped that
/// will not be made again.
void trim_heap();

/// What a block of `bytes` really takes after keep_heap_small().
size_t heap_bytes(size_t bytes);

}  // namespace pelage
