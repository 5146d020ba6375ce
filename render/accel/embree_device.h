// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <mutex>
#include <string>

#include "base/ledger.h"
#include "render/accel/embree_api.h"

namespace pelage {

/// An Embree device whose allocations are charged to MemoryTag::kChunks and whose errors are kept until
/// somebody asks: nothing may be thrown through Embree's C frames.
class EmbreeDevice {
 public:
  /// `memory_limit`: bytes that the ledger's budgeted tags may reach,
  /// 0 for no limit. Throws Error (kFailed) when Embree does not start.
  EmbreeDevice(uint64_t memory_limit, MemoryLedger& ledger);
  ~EmbreeDevice();
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;

  RTCDevice get() const { return device_; }
  /// Throws the first error that Embree reported since the device was made.
  void rethrow() const;

 private:
  static void on_error(void* self, RTCError code, const char* text) noexcept;
  static bool on_memory(void* self, ssize_t bytes, bool post) noexcept;

  MemoryLedger& ledger_;
  const uint64_t memory_limit_;
  RTCDevice device_ = nullptr;
  std::atomic<bool> over_limit_{false};
  mutable std::mutex mutex_;  // guards the rest
  RTCError code_ = RTC_ERROR_NONE;
  std::string text_;
};

}  // namespace pelage
