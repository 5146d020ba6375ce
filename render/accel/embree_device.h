// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <mutex>

#include "render/accel/embree_api.h"

namespace pelage {

/// An Embree device for many small scenes, each built by one thread. An EmbreeMeter can count allocations.
/// Trees are allocated in blocks of kTreeBlock bytes on their own pages, so that freed trees leave no holes
/// in the heap.
class EmbreeDevice {
 public:
  /// Throws Error (kFailed) when Embree does not start.
  EmbreeDevice();
  ~EmbreeDevice();
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;

  RTCDevice get() const { return device_; }
  /// Throws the error that Embree stores for the calling thread, if any, and clears it.
  void rethrow_of_thread() const;
  /// Returns a lock to hold while building or releasing a scene, if other threads may do so at the same time.
  /// It locks only in the thread-sanitizer build; in other builds it is empty. The reason is that Embree
  /// guards the list of its threads' allocators with a spin lock that the sanitizer does not recognise, which
  /// would cause false reports.
  std::unique_lock<std::mutex> one_at_a_time() const;

  static constexpr size_t kTreeBlock = 6 * 4096;

 private:
  RTCDevice device_ = nullptr;
  mutable std::mutex building_;
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
  static bool on_memory(void*, ssize_t bytes, bool) noexcept;
  void count(int64_t bytes);

  int64_t held_ = 0, peak_ = 0;
};

}  // namespace pelage
