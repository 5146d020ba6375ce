// SPDX-License-Identifier: Apache-2.0
#include "render/accel/embree_device.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/check.h"
#include "base/error.h"
#include "base/heap.h"
#include "base/memory_budget.h"

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

EmbreeDevice::EmbreeDevice(uint64_t memory_limit, MemoryLedger& ledger)
    : EmbreeDevice(nullptr, memory_limit, &ledger) {}
EmbreeDevice::EmbreeDevice() : EmbreeDevice(small_scenes().c_str(), 0, nullptr) {}

EmbreeDevice::EmbreeDevice(const char* configuration, uint64_t memory_limit, MemoryLedger* ledger)
    : ledger_(ledger), memory_limit_(memory_limit) {
  device_ = rtcNewDevice(configuration);
  if (!device_) {
    throw Error(ErrorKind::kFailed,
                fmt::format("cannot start Embree (error {})", static_cast<int>(rtcGetDeviceError(nullptr))));
  }
  rtcSetDeviceErrorFunction(device_, on_error, this);
  rtcSetDeviceMemoryMonitorFunction(device_, on_memory, this);
}

EmbreeDevice::~EmbreeDevice() { rtcReleaseDevice(device_); }

void EmbreeDevice::rethrow() const {
  std::lock_guard lock(mutex_);
  if (code_ == RTC_ERROR_NONE) return;
  if (over_limit_) {
    throw Error(ErrorKind::kMemory, fmt::format("the tree over the geometry does not fit render.memory ({})",
                                                memory_text(static_cast<int64_t>(memory_limit_))));
  }
  if (code_ == RTC_ERROR_OUT_OF_MEMORY)
    throw Error(ErrorKind::kMemory, "out of memory while building the tree");
  throw Error(ErrorKind::kFailed, "Embree: " + text_);
}

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

void EmbreeDevice::on_error(void* self, RTCError code, const char* text) noexcept {
  auto& device = *static_cast<EmbreeDevice*>(self);
  std::lock_guard lock(device.mutex_);
  if (device.code_ != RTC_ERROR_NONE) return;
  device.code_ = code;
  try {
    device.text_ = text ? text : "";
  } catch (const std::bad_alloc&) {
    // The error code alone is still reported.
  }
}

bool EmbreeDevice::on_memory(void* self, ssize_t bytes, bool post) noexcept {
  auto& device = *static_cast<EmbreeDevice*>(self);
  if (meter_of_thread) meter_of_thread->count(bytes);
  if (!device.ledger_) return true;
  device.ledger_->charge(MemoryTag::kChunks, bytes);
  if (bytes <= 0 || device.memory_limit_ == 0) return true;
  if (device.ledger_->budgeted() <= static_cast<int64_t>(device.memory_limit_)) return true;
  device.over_limit_ = true;
  if (!post) device.ledger_->charge(MemoryTag::kChunks, -bytes);  // refused before it was allocated
  return false;
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
