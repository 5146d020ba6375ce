// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <mutex>
#include <string>

#include "base/ledger.h"
#include "render/accel/embree_api.h"

namespace pelage {

/// An Embree device. It stores the errors that Embree reports until rethrow() or rethrow_of_thread() throws
/// them, because exceptions must not propagate through the stack frames of Embree's C interface.
class EmbreeDevice {
 public:
  /// Charges allocations to MemoryTag::kChunks. `memory_limit`: max bytes of the ledger's budgeted tags, 0
  /// for no limit. Throws Error (kFailed) when Embree does not start.
  EmbreeDevice(uint64_t memory_limit, MemoryLedger& ledger);
  /// Makes a device for many small scenes, each built by one thread. Allocations are not charged to a ledger;
  /// an EmbreeMeter can count them. Trees are allocated in blocks of kTreeBlock bytes on their own pages, so
  /// that freed trees leave no holes in the heap.
  EmbreeDevice();
  ~EmbreeDevice();
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;

  RTCDevice get() const { return device_; }
  /// Throws the first error that Embree reported since the device was made. Does nothing if there was none.
  void rethrow() const;
  /// Throws the error that Embree stores for the calling thread, if any, and clears it. For concurrent
  /// builds.
  void rethrow_of_thread() const;
  /// Returns a lock to hold while building or releasing a scene, if other threads may do so at the same time.
  /// It locks only in the thread-sanitizer build; in other builds it is empty. The reason is that Embree
  /// guards the list of its threads' allocators with a spin lock that the sanitizer does not recognise, which
  /// would cause false reports.
  std::unique_lock<std::mutex> one_at_a_time() const;

  static constexpr size_t kTreeBlock = 6 * 4096;

 private:
  EmbreeDevice(const char* configuration, uint64_t memory_limit, MemoryLedger* ledger);
  static void on_error(void* self, RTCError code, const char* text) noexcept;
  static bool on_memory(void* self, ssize_t bytes, bool post) noexcept;

  MemoryLedger* const ledger_;  // may be null
  const uint64_t memory_limit_;
  RTCDevice device_ = nullptr;
  std::atomic<bool> over_limit_{false};
  mutable std::mutex building_;
  mutable std::mutex mutex_;  // guards the following
  RTCError code_ = RTC_ERROR_NONE;
  std::string text_;
};

/// Counts the memory that Embree allocates on this thread, for any device, while the meter exists. Sizes are
/// counted as in heap_bytes(). Meters must not be nested.
class EmbreeMeter {
 public:
  EmbreeMeter();
  ~EmbreeMeter();
  EmbreeMeter(const EmbreeMeter&) = delete;
  EmbreeMeter& operator=(const EmbreeMeter&) = delete;

  /// held(): bytes allocated since construction minus bytes freed. peak(): the max of held() so far.
  int64_t held() const { return held_; }
  int64_t peak() const { return peak_; }

 private:
  friend class EmbreeDevice;
  void count(int64_t bytes);

  int64_t held_ = 0, peak_ = 0;
};

}  // namespace pelage
