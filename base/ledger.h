// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string_view>

namespace pelage {

/// Owner of a piece of memory. The names are the keys of `memory_bytes` in the statistics.
enum class MemoryTag {
  kChunks,  ///< grown strands and the trees over them
  kSkins,   ///< cages, refined control points, tessellations, crowds
  kGrooms,  ///< follicles, guides, clump centres, positions of imported strands
  kOperatorCache,
  kReflectionCache,
  kFilm,
  kTextures,   ///< decoded images and environment distributions
  kLibraries,  ///< memory taken by loading a module, except for pages of its files
  kCount,
};
std::string_view memory_tag_name(MemoryTag tag);

/// Bytes in use and their peak, by tag (law 5). Thread safety: all members may be called from any thread.
class MemoryLedger {
 public:
  void charge(MemoryTag tag, int64_t bytes);
  int64_t current(MemoryTag tag) const;
  int64_t peak(MemoryTag tag) const;
  /// Whether `render.memory` covers a tag. It covers everything held for a scene and the temporary memory
  /// needed to make it, but neither the libraries nor the program itself (law 5).
  static bool is_budgeted(MemoryTag tag);
  /// Bytes in use by the tags that `render.memory` covers.
  int64_t budgeted() const;

  /// `render.memory` in bytes, 0 for none. Set before anything is charged. The ledger only stores the limit:
  /// code that allocates memory checks it first (base/memory_budget.h).
  void set_limit(uint64_t bytes) { limit_ = static_cast<int64_t>(bytes); }
  int64_t limit() const { return limit_; }

 private:
  struct Account {
    std::atomic<int64_t> current{0};
    std::atomic<int64_t> peak{0};
  };
  std::array<Account, static_cast<size_t>(MemoryTag::kCount)> accounts_;
  int64_t limit_ = 0;
};

/// Holds a charge for its lifetime. A default-constructed one holds nothing.
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
