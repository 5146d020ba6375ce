// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace pelage {

/// Size in bytes from which a heap block, including 16 bytes of overhead, has pages of its own after
/// keep_heap_small(). Measured: docs/lab/ACCEL.md, waste of the heap.
inline constexpr size_t kHeapPages = 6 * 1024;

/// Makes the heap return each block of at least kHeapPages to the system as soon as the block is freed.
/// Without this call, fragmentation wastes a third of the memory when several threads repeatedly allocate and
/// free blocks of similar size, such as the trees of chunks. Call once, before threads are started.
void keep_heap_small();

/// Lets the heap of each thread keep blocks of up to 1 MiB, grow in steps of up to 16 MiB, and keep as much
/// freed memory at its end. Threads that grow strands allocate and free megabytes many times a second. To
/// give pages back and get new ones interrupts all threads, and takes more time than growth itself. All heaps
/// together keep at most a fortieth of `limit`, the max of memory in bytes, but each may keep 128 KiB; 0: no
/// limit. With a limit below 1 GiB, the heap is kept small as after keep_heap_small(). May be called again
/// when the limit has changed, also while threads run. Measured: docs/lab/ACCEL.md, waste of the heap.
void keep_spare_heap(size_t limit, int threads);

/// Returns unused memory between the blocks of the heap to the system. Call after freeing much memory that
/// will not be needed again.
void trim_heap();

/// Returns the memory in bytes that a heap block of `bytes` bytes takes after keep_heap_small(): whole pages
/// from kHeapPages on, else `bytes`.
size_t heap_bytes(size_t bytes);

}  // namespace pelage
