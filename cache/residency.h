// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/check.h"
#include "base/job.h"
#include "cache/clock_ring.h"
#include "cache/growth_throttle.h"
#include "cache/residency_counts.h"

namespace pelage {

/// A unit that can be evicted and grown again.
class Resident {
 public:
  virtual ~Resident() = default;
};

/// Grows the units of a Residency. Thread safety: every member may be called from many threads at once, for
/// different slots.
class Grower {
 public:
  struct Grown {
    std::unique_ptr<Resident> unit;  ///< null: needs more memory than reserved, see grow()
    size_t bytes = 0;                ///< memory held from now on, at most reserve_bytes()
  };
  virtual ~Grower() = default;
  /// Upper bound of the memory held at any moment while `slot` is grown and afterwards. May decrease once the
  /// slot has been grown; increases only to the size reported by grow().
  virtual size_t reserve_bytes(uint32_t slot) const = 0;
  /// Name of the slot's owner for messages; may be empty.
  virtual std::string name(uint32_t) const { return {}; }
  /// Grows the unit of a slot; a slot always has the same content. Called by a thread that pins nothing; must
  /// not visit the Residency itself. May throw. If the slot needs more memory than reserved, returns no unit,
  /// and the required size in `bytes`. From then on, reserve_bytes() must return this size. The Residency
  /// then reserves this size and calls grow() again. The Grower must hold no memory for the slot in between.
  virtual Grown grow(uint32_t slot) = 0;
};

/// The part of `render.memory` available to everything that MemoryLedger::budgeted() counts.
struct MemoryBudget {
  uint64_t limit = 0;  ///< bytes; 0 is no limit
};

/// Holds a fixed number of slots within a memory budget. A slot's unit is grown on the first visit, kept
/// while the budget allows, and grown again if a visit needs it after an eviction.
///
/// Guarantees:
/// - The budget never changes what a visit sees.
/// - A unit stays alive until the visits that use it end.
/// - A slot is grown only after its upper bound has been charged to the ledger, and the bound is charged only
///   if the sum of the budgeted tags then stays within the budget.
/// - Visits make progress with every budget that holds the largest slot in addition to everything else on the
///   budgeted tags. The constructor refuses smaller budgets.
///
/// Why visits make progress: a thread reserves the upper bound of a slot, all or nothing, before it claims
/// the slot. While it waits, it holds no memory, no pin and no claim. It can therefore obtain everything that
/// the other threads do not pin or grow at that moment, and those threads finish. If the budget holds the
/// largest slots of all threads at once, no thread waits for memory. If the working sets of the threads do
/// not fit together, fewer threads may grow at a time (GrowthThrottle).
///
/// How: a visit of a resident unit takes no lock. It pins the unit with one store to its thread's hazard
/// pointer [Michael04] and then reads the index again. Growth and eviction are rare and share one mutex,
/// which is released while units are grown or freed. Eviction removes a unit from the index and then looks
/// for pins: it puts a pinned unit back and frees the others.
///
/// Other users of the budgeted tags may charge memory at any time; the next reservation takes it into
/// account. Memory that may grow while a Residency is in use, such as poses, must be charged at its maximum
/// beforehand.
///
/// Thread safety: visit, is_resident, mark_hit and counts may be called from any thread, but only one thread
/// at a time may use a `thread` number. Call the other members from one thread, without concurrent visits.
class Residency {
 public:
  /// Visits pass thread numbers 0 .. threads-1. Throws Error (kMemory) when the budget does not hold the
  /// largest slot in addition to the memory already charged to the budgeted tags.
  Residency(Grower& grower, size_t slots, int threads, const MemoryBudget& budget, MemoryLedger& ledger,
            MemoryTag tag);
  /// Frees everything. There must be no concurrent visit.
  ~Residency();
  /// Memory of a Residency without its units.
  static size_t index_bytes(size_t slots, int threads);
  Residency(const Residency&) = delete;
  Residency& operator=(const Residency&) = delete;

  /// Calls use(Resident&) and returns its result. If the unit is not resident, first grows it, or waits while
  /// another thread grows it. `use` must not visit any slot (this is checked), and it must not keep a
  /// reference to the unit. If the grower throws, all visits that wait for the slot and all later visits of
  /// it throw the same exception. Throws Error (kMemory) when other users of the budget have left too little
  /// for the slot.
  template <class Use>
  decltype(auto) visit(uint32_t slot, int thread, Use&& use) {
    Resident& unit = pin(slot, thread);
    const Unpin unpin_at_end{*this, thread};
    return std::forward<Use>(use)(unit);
  }

  /// A hint: may be outdated immediately.
  bool is_resident(uint32_t slot) const {
    return slots_[slot].unit.load(std::memory_order_relaxed) != nullptr;
  }

  /// Records that the unit was useful, for false_expansions.
  void mark_hit(uint32_t slot) { set_flag(slots_[slot].hit); }

  /// Grows all units and never evicts afterwards; call before the first visit. Returns early when the job's
  /// progress is cancelled. Throws Error (kMemory) when not everything fits.
  void grow_all(const Job& job);

  size_t slot_count() const { return slots_.size(); }
  ResidencyCounts counts() const;

 private:
  struct Slot {
    std::atomic<Resident*> unit{nullptr};
    std::atomic<bool> used{false};  // since the last visit of the clock's hand
    std::atomic<bool> hit{false};   // since it was grown
    bool growing = false;           // this and the following members: guarded by mutex_
    bool touched = false;
    uint8_t credit = 0;       // rounds of the clock's hand that it may stay unused
    uint32_t dropped_at = 0;  // number of expansions at the time of its eviction
    size_t bytes = 0;
  };
  struct alignas(64) Hazard {
    std::atomic<Resident*> unit{nullptr};
  };
  struct Unpin {
    Residency& residency;
    int thread;
    ~Unpin() { residency.unpin(thread); }
  };
  /// Units removed from the index, to be freed without the mutex; still charged.
  struct Victims {
    std::vector<std::pair<uint32_t, std::unique_ptr<Resident>>> units;
    int64_t bytes = 0;
  };
  enum class Reservation { kGranted, kLater, kNever };

  static void set_flag(std::atomic<bool>& flag) {
    if (!flag.load(std::memory_order_relaxed)) flag.store(true, std::memory_order_relaxed);
  }

  Resident& pin(uint32_t slot, int thread) {
    Slot& s = slots_[slot];
    Resident* unit = s.unit.load(std::memory_order_acquire);
    std::atomic<Resident*>& hazard = hazards_[static_cast<size_t>(thread)].unit;
    PELAGE_CHECK(hazard.load(std::memory_order_relaxed) == nullptr);  // visits do not nest
    if (never_evicts_) {
      // Nothing is evicted, so the pin serves only to detect nested visits.
      if (!unit) unit = &pin_slowly(slot, thread);
      hazard.store(unit, std::memory_order_relaxed);
      return *unit;
    }
    if (unit) {
      // In the single order of sequentially consistent operations, either the evictor sees this store, or we
      // see that the unit is no longer in the index.
      hazard.store(unit, std::memory_order_seq_cst);
      if (s.unit.load(std::memory_order_seq_cst) == unit) {
        set_flag(s.used);
        return *unit;
      }
      unpin(thread);
    }
    return pin_slowly(slot, thread);
  }
  void unpin(int thread) {
    std::atomic<Resident*>& hazard = hazards_[static_cast<size_t>(thread)].unit;
    if (never_evicts_) {
      hazard.store(nullptr, std::memory_order_relaxed);
      return;
    }
    hazard.store(nullptr, std::memory_order_seq_cst);
    if (waiting_for_memory_.load(std::memory_order_seq_cst) > 0) wake();
  }

  Resident& pin_slowly(uint32_t slot, int thread);
  Resident* grow(std::unique_lock<std::mutex>& lock, uint32_t slot, int thread, int64_t reserved,
                 Victims& victims);
  Reservation reserve(int64_t bytes, Victims& victims);
  Reservation evict(int64_t bytes, Victims& victims);
  bool is_pinned(const Resident* unit) const;
  void charge(int64_t bytes);
  /// Waits until something changed, at most for `timeout`.
  void sleep(std::unique_lock<std::mutex>& lock, std::optional<std::chrono::milliseconds> timeout = {});
  void wake();
  void refuse_small_budget() const;
  [[noreturn]] void throw_too_full(uint32_t slot, int64_t needed) const;

  Grower& grower_;
  MemoryLedger& ledger_;
  const MemoryTag tag_;
  const MemoryBudget budget_;
  std::vector<Slot> slots_;
  std::vector<Hazard> hazards_;
  bool never_evicts_;  // nothing is ever evicted, so pins are not needed; fixed before the first visit
  MemoryCharge index_charge_;
  std::atomic<int> waiting_for_memory_{0};  // threads waiting for a pin or a reservation to be released

  mutable std::mutex mutex_;
  std::condition_variable
      changed_;      // a growth ended, or memory or a pin was released while a thread waited for memory
  ClockRing clock_;  // slots with a unit; this and the following: guarded by mutex_
  GrowthThrottle throttle_;
  std::map<uint32_t, std::exception_ptr> failures_;
  int growing_ = 0;
  int64_t held_ = 0;  // charged for units and reservations
  ResidencyCounts counts_;
};

}  // namespace pelage
