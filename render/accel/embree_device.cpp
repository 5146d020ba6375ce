// SPDX-License-Identifier: Apache-2.0
#include "render/accel/embree_device.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/check.h"
#include "base/error.h"
#include "base/heap.h"

namespace pelage {
namespace {

// Embree's monitor does not report the scene of an allocation; each scene of a chunk is built by one thread.
thread_local EmbreeMeter* meter_of_thread = nullptr;

/// Embree adds a header and padding to align to a block, the heap another header.
std::string small_scenes() {
  constexpr size_t kAdded = 256;
  return fmt::format("alloc_single_thread_alloc=1,alloc_thread_block_size={}",
                     EmbreeDevice::kTreeBlock - kAdded);
}

}  // namespace

EmbreeDevice::EmbreeDevice() : device_(rtcNewDevice(small_scenes().c_str())) {
  if (!device_) {
    throw Error(ErrorKind::kFailed,
                fmt::format("cannot start Embree (error {})", static_cast<int>(rtcGetDeviceError(nullptr))));
  }
  rtcSetDeviceMemoryMonitorFunction(device_, EmbreeMeter::on_memory, nullptr);
}

EmbreeDevice::~EmbreeDevice() { rtcReleaseDevice(device_); }

void EmbreeDevice::rethrow_of_thread() const {
  const RTCError code = rtcGetDeviceError(device_);
  if (code == RTC_ERROR_NONE) return;
  if (code == RTC_ERROR_OUT_OF_MEMORY)
    throw Error(ErrorKind::kMemory, "out of memory while building the tree of a chunk");
  throw Error(ErrorKind::kFailed, fmt::format("Embree: error {}", static_cast<int>(code)));
}

std::unique_lock<std::mutex> EmbreeDevice::one_at_a_time() const {
#ifdef PELAGE_STD_THREADS
  return std::unique_lock(building_);
#else
  return {};
#endif
}

bool EmbreeMeter::on_memory(void*, ssize_t bytes, bool) noexcept {
  if (meter_of_thread) meter_of_thread->count(bytes);
  return true;
}

EmbreeMeter::EmbreeMeter() {
  PELAGE_CHECK(!meter_of_thread);
  meter_of_thread = this;
}
EmbreeMeter::~EmbreeMeter() { meter_of_thread = nullptr; }

void EmbreeMeter::count(int64_t bytes) {
  const auto size = static_cast<int64_t>(heap_bytes(static_cast<size_t>(bytes < 0 ? -bytes : bytes)));
  held_ += bytes < 0 ? -size : size;
  peak_ = std::max(peak_, held_);
}

}  // namespace pelage
