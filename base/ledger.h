// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string_view>

namespace pelage {

/// Purpose for which memory is charged. memory_tag_name() returns the keys of `memory_bytes` in the
/// statistics.
enum class MemoryTag {
  kChunks,  ///< grown strands and the trees over them
  kSkins,   ///< cages, refined control points, tessellations, crowds
  kGrooms,  ///< follicles, guides, clump centres, positions of imported strands
  kOperatorCache,
  kReflectionCache,
  kFilm,
  kTextures,   ///< decoded images and environment distributions
  kLibraries,  ///< memory that loading a module takes, except for mapped pages of its files
  kCount,
};
std::string_view memory_tag_name(MemoryTag tag);

/// Counts the bytes in use and their maximum so far, for each tag (law 5). Thread safety: all members may be
/// called from any thread.
class MemoryLedger {
 public:
  /// Adds `bytes` to the use of a tag; negative to subtract.
  void charge(MemoryTag tag, int64_t bytes);
  /// Bytes in use.
  int64_t current(MemoryTag tag) const;
  /// Max bytes that were in use at once.
  int64_t peak(MemoryTag tag) const;
  /// Returns whether the limit `render.memory` includes a tag. The limit includes all data of a scene and the
  /// temporary memory for making this data. It includes neither libraries nor the program itself (law 5).
  static bool is_budgeted(MemoryTag tag);
  /// Returns the bytes in use by all tags that `render.memory` includes.
  int64_t budgeted() const;

  /// Sets the limit in bytes; 0 means no limit. `name`: what users set it by, for messages; a literal. Call
  /// before charging anything. The ledger does not enforce the limit: code that is about to allocate memory
  /// must check it (base/memory_budget.h).
  void set_limit(uint64_t bytes, std::string_view name = "render.memory") {
    limit_ = static_cast<int64_t>(bytes);
    limit_name_ = name;
    elastic_ = 0;
  }
  int64_t limit() const { return limit_; }
  std::string_view limit_name() const { return limit_name_; }
  /// Notes that a holder took so many bytes less than it would take under a higher limit. Advice about the
  /// limit includes them: otherwise, the holder would take them, and the advised limit would be too low.
  void add_elastic(int64_t bytes) { elastic_ += bytes; }
  int64_t elastic() const { return elastic_; }

 private:
  struct Account {
    std::atomic<int64_t> current{0};
    std::atomic<int64_t> peak{0};
  };
  std::array<Account, static_cast<size_t>(MemoryTag::kCount)> accounts_;
  int64_t limit_ = 0;
  std::string_view limit_name_ = "render.memory";
  std::atomic<int64_t> elastic_{0};
};

/// Charges bytes to a ledger and subtracts them again in its destructor. A default-constructed MemoryCharge
/// charges nothing.
class MemoryCharge {
 public:
  MemoryCharge() = default;
  MemoryCharge(MemoryLedger& ledger, MemoryTag tag, int64_t bytes);
  MemoryCharge(MemoryCharge&& other) noexcept;
  MemoryCharge& operator=(MemoryCharge&& other) noexcept;
  ~MemoryCharge();

 private:
  MemoryLedger* ledger_ = nullptr;
  MemoryTag tag_ = MemoryTag::kChunks;
  int64_t bytes_ = 0;
};

}  // namespace pelage
