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

/// A unit of memory, such as a chunk of fur, that can be evicted and grown again.
class Resident {
 public:
  virtual ~Resident() = default;
};

/// Grows the units of a Residency. Thread safety: implementations must allow calls of every member from many
/// threads at once, for different slots.
class Grower {
 public:
  struct Grown {
    std::unique_ptr<Resident> unit;  ///< null if the slot needs more memory than reserved, see grow()
    size_t bytes = 0;  ///< memory of the unit, at most reserve_bytes(); without unit: memory needed
  };
  virtual ~Grower() = default;
  /// Returns an upper bound of the memory that `slot` takes at any moment, while its unit is grown and
  /// afterwards. The bound may decrease once the slot has been grown. It may increase only to the size that
  /// grow() reported.
  virtual size_t reserve_bytes(uint32_t slot) const = 0;
  /// Returns the name of the slot's owner (such as "rat.coat") for messages; may be empty.
  virtual std::string name(uint32_t) const { return {}; }
  /// Grows the unit of a slot. Every call for a slot must grow the same content. The calling thread pins no
  /// unit. grow() must not visit the Residency. May throw.
  ///
  /// If the slot needs more memory than reserved, grow() returns no unit, and the required size in `bytes`.
  /// From then on, reserve_bytes() must return this size. The Residency then reserves this size and calls
  /// grow() again. Between the two calls, the Grower must hold no memory for the slot.
  virtual Grown grow(uint32_t slot) = 0;
};

/// Max total of the memory that MemoryLedger::budgeted() counts.
struct MemoryBudget {
  uint64_t limit = 0;  ///< in bytes; 0 means no limit
};

/// Holds units in a fixed number of slots, within a memory budget. The first visit of a slot grows its unit.
/// The unit may be evicted when memory is needed for other units. A visit after the eviction grows the unit
/// again.
///
/// Guarantees:
/// - The contents of the units that visits see do not depend on the budget.
/// - A unit stays alive until all visits that use the unit have ended.
/// - Before a slot is grown, the upper bound of its memory is charged to the ledger. The bound is charged
///   only if the sum of the budgeted tags then stays within the budget.
/// - Visits make progress if the budget can hold the largest slot in addition to all other memory of the
///   budgeted tags. The constructor rejects smaller budgets.
///
/// Why visits make progress: a thread reserves the whole upper bound of a slot before it marks the slot as
/// growing. A thread that waits has reserved no memory, pins no unit and grows no slot. Threads that pin or
/// grow a unit do not wait for memory, so they finish. Then all units can be evicted, and the waiting thread
/// obtains its memory. If the budget can hold the largest slots of all threads at once, no thread waits for
/// memory. If the budget is too small for the units that all threads need, fewer threads may grow at a time
/// (GrowthThrottle).
///
/// How it works: a visit of a resident unit takes no lock. The visit stores the unit in the hazard pointer of
/// its thread [Michael04], which pins the unit, and then checks that the unit is still in the index. Growth
/// and eviction are rare. Both lock one mutex, which is released while units are grown or freed. An eviction
/// removes a unit from the index, and then checks whether a thread pins the unit. If so, it puts the unit
/// back; if not, it frees the unit.
///
/// Other users of the budgeted tags may charge memory at any time. The next reservation takes these charges
/// into account. Memory that may increase while a Residency is in use, such as the memory of poses, must be
/// charged at its maximum before.
///
/// Thread safety: visit(), is_resident(), mark_hit() and counts() may be called from any thread. Two threads
/// must not use the same `thread` number at the same time. Call the other members from one thread, while no
/// visit is running.
class Residency {
 public:
  /// Callers of visit() must pass `thread` numbers 0 .. threads-1. Throws Error (kMemory) when the budget
  /// cannot hold the largest slot in addition to the memory already charged to the budgeted tags.
  Residency(Grower& grower, size_t slots, int threads, const MemoryBudget& budget, MemoryLedger& ledger,
            MemoryTag tag);
  /// Frees all units. No visit may be running.
  ~Residency();
  /// Returns the memory in bytes of a Residency without its units.
  static size_t index_bytes(size_t slots, int threads);
  Residency(const Residency&) = delete;
  Residency& operator=(const Residency&) = delete;

  /// Calls use(Resident&) with the unit of a slot, and returns the result of `use`. If the unit is not
  /// resident, first grows it, or waits while another thread grows it. `use` must not call visit() (this is
  /// checked) and must not keep a reference to the unit. If Grower::grow() throws an exception, all waiting
  /// and all later visits of this slot throw the same exception. Throws Error (kMemory) when other users of
  /// the budget have left too little memory for the slot.
  template <class Use>
  decltype(auto) visit(uint32_t slot, int thread, Use&& use) {
    Resident& unit = pin(slot, thread);
    const Unpin unpin_at_end{*this, thread};
    return std::forward<Use>(use)(unit);
  }

  /// Returns whether the slot has a unit. Only a hint, because another thread may evict or grow the unit at
  /// any moment.
  bool is_resident(uint32_t slot) const {
    return slots_[slot].unit.load(std::memory_order_relaxed) != nullptr;
  }

  /// Records that the unit of the slot was useful (ResidencyCounts::false_expansions).
  void mark_hit(uint32_t slot) { set_flag(slots_[slot].hit); }

  /// Puts a unit that was grown elsewhere in an empty slot. `bytes`: its memory, which is charged to the
  /// ledger. The unit may be evicted like any other. Call before the first visit.
  void adopt(uint32_t slot, std::unique_ptr<Resident> unit, size_t bytes);
  /// Removes the unit of a slot and its charge. Returns null if the slot has no unit. Call after the last
  /// visit.
  std::unique_ptr<Resident> release(uint32_t slot);

  /// Grows all units and turns off eviction for good. Call before the first visit. Returns early when the job
  /// is cancelled. Throws Error (kMemory) when the budget cannot hold all units.
  void grow_all(const Job& job);

  ResidencyCounts counts() const;

 private:
  struct Slot {
    std::atomic<Resident*> unit{nullptr};
    std::atomic<bool> used{false};  // visited since the hand of the clock last passed
    std::atomic<bool> hit{false};   // mark_hit() was called since the unit was grown
    bool growing = false;           // this and the following members: guarded by mutex_
    bool touched = false;
    uint8_t credit = 0;       // rounds of the clock's hand that the unit may stay unused
    uint32_t dropped_at = 0;  // count of expansions when the unit was last evicted
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
  /// Units removed from the index. They will be freed while the mutex is not locked. Their memory is still
  /// charged.
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
  /// Waits for a notification of changed_, or until `timeout` has passed.
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
  bool never_evicts_;  // true: no unit is evicted, so pins are not needed; fixed before the first visit
  MemoryCharge index_charge_;
  std::atomic<int> waiting_for_memory_{0};  // count of threads that wait until others release memory or pins

  mutable std::mutex mutex_;
  std::condition_variable
      changed_;      // a growth ended, or memory or a pin was released while a thread waited for memory
  ClockRing clock_;  // slots with a unit; this and the following: guarded by mutex_
  GrowthThrottle throttle_;
  std::map<uint32_t, std::exception_ptr> failures_;
  int growing_ = 0;
  int64_t held_ = 0;  // bytes charged for units and reservations
  ResidencyCounts counts_;
};

}  // namespace pelage
