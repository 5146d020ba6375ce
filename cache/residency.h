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

/// Something that can be dropped and made again.
class Resident {
 public:
  virtual ~Resident() = default;
};

/// Makes the residents of a Residency. Thread safety: every member may be called from many threads at once,
/// for different slots.
class Grower {
 public:
  struct Grown {
    std::unique_ptr<Resident> unit;  ///< null: it takes more than was reserved, see grow()
    size_t bytes = 0;                ///< held from now on, at most reserve_bytes
  };
  virtual ~Grower() = default;
  /// Upper bound of the bytes held at any moment while `slot` is grown and afterwards. May become less once
  /// the slot has been grown, more only by what grow() said.
  virtual size_t reserve_bytes(uint32_t slot) const = 0;
  /// For messages: what the slot is of, or nothing.
  virtual std::string name(uint32_t) const { return {}; }
  /// Same slot, same content. Called by a thread that pins nothing; visits nothing itself. May throw. Where
  /// it turns out that the slot takes more than was reserved, it gives no unit and says in `bytes` how much,
  /// which reserve_bytes() says from then on: it is called again when so much is reserved, and holds nothing
  /// until then.
  virtual Grown grow(uint32_t slot) = 0;
};

/// What `render.memory` allows for everything that MemoryLedger::budgeted() counts.
struct MemoryBudget {
  uint64_t limit = 0;  ///< bytes; 0 is no limit
};

/// A fixed number of slots whose units are grown on first visit, held while the budget allows and grown again
/// when they are needed again. How much is held never changes what a visit sees.
///
/// A visit pins its unit by one store to a slot of the thread's own (a hazard pointer [Michael04]) and a
/// second look at the index; nothing is locked. Growth and eviction are rare and happen under one mutex,
/// except for the growing and the freeing themselves. A unit is freed after it was taken out of the index and
/// no thread was seen to pin it; when one pins it after all, it goes back. Reservations are all or nothing: a
/// thread reserves what growing can take at most before it claims the slot, and until then it holds nothing,
/// neither memory nor pin nor claim. So a thread that needs room can have all that the others do not pin or
/// grow at this moment, and they get done: every budget that holds the largest slot finishes. One that holds
/// the largest slots of all threads at once lets none of them wait for room. Where the units that each thread
/// comes back to do not fit together, fewer threads grow at a time (GrowthThrottle).
///
/// Whatever else is charged to budgeted tags is seen by the next reservation; what may grow while a Residency
/// works (poses, say) should be charged at its most before.
///
/// Thread safety: visit, is_resident, mark_hit and counts from any thread; each number `thread` by one thread
/// at a time. The others by one thread while nobody visits.
class Residency {
 public:
  /// `threads`: visits carry 0 .. threads-1. Throws Error (kMemory) when the budget does not hold the largest
  /// slot beside what the ledger has already.
  Residency(Grower& grower, size_t slots, int threads, const MemoryBudget& budget, MemoryLedger& ledger,
            MemoryTag tag);
  /// Drops everything. No visit is under way.
  ~Residency();
  /// What a Residency holds beside its units.
  static size_t index_bytes(size_t slots, int threads);
  Residency(const Residency&) = delete;
  Residency& operator=(const Residency&) = delete;

  /// Calls use(Resident&) and returns what it returns, growing the unit before or waiting for the thread that
  /// does. `use` visits nothing itself and keeps no reference. What a grower throws, everybody who visits
  /// that slot gets, now and later. Throws Error (kMemory) when the rest of the budget was taken by others.
  template <class Use>
  decltype(auto) visit(uint32_t slot, int thread, Use&& use) {
    Resident& unit = pin(slot, thread);
    const Unpin unpin_at_end{*this, thread};
    return std::forward<Use>(use)(unit);
  }

  /// A hint: it may change at once.
  bool is_resident(uint32_t slot) const {
    return slots_[slot].unit.load(std::memory_order_relaxed) != nullptr;
  }

  /// The unit was of use, for false_expansions.
  void mark_hit(uint32_t slot) { set_flag(slots_[slot].hit); }

  /// Grows everything and never evicts again; before the first visit. Leaves early when `progress` is
  /// cancelled. Throws Error (kMemory) when it does not fit.
  void grow_all(const Job& job);

  size_t slot_count() const { return slots_.size(); }
  ResidencyCounts counts() const;

 private:
  struct Slot {
    std::atomic<Resident*> unit{nullptr};
    std::atomic<bool> used{false};  // since the hand of the clock came by
    std::atomic<bool> hit{false};   // since it was grown
    bool growing = false;           // this and the following: guarded by mutex_
    bool touched = false;
    uint8_t credit = 0;       // rounds of the clock's hand that it may stay unused
    uint32_t dropped_at = 0;  // how many expansions there had been
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
  /// Units taken out of the index, to be freed without the mutex; still charged.
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
    if (never_evicts_) return unit ? *unit : pin_slowly(slot, thread);
    std::atomic<Resident*>& hazard = hazards_[static_cast<size_t>(thread)].unit;
    PELAGE_CHECK(hazard.load(std::memory_order_relaxed) == nullptr);
    if (unit) {
      // In the one order of sequentially consistent operations, either the evictor sees this store or we see
      // that the index no longer has the unit.
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
    if (never_evicts_) return;
    hazards_[static_cast<size_t>(thread)].unit.store(nullptr, std::memory_order_seq_cst);
    if (waiting_for_memory_.load(std::memory_order_seq_cst) > 0) wake();
  }

  Resident& pin_slowly(uint32_t slot, int thread);
  Resident* grow(std::unique_lock<std::mutex>& lock, uint32_t slot, int thread, int64_t reserved,
                 Victims& victims);
  Reservation reserve(int64_t bytes, Victims& victims);
  Reservation evict(int64_t bytes, Victims& victims);
  bool is_pinned(const Resident* unit) const;
  void charge(int64_t bytes);
  /// Until something changed, or `timeout` so long.
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
  bool never_evicts_;  // nothing is ever evicted, so nothing need be pinned; fixed before the first visit
  MemoryCharge index_charge_;
  std::atomic<int> waiting_for_memory_{0};  // threads that wait until a pin or a reservation is let go

  mutable std::mutex mutex_;
  std::condition_variable changed_;  // a growth ended, or something was let go while somebody starved
  ClockRing clock_;                  // slots with a unit; this and the following: guarded by mutex_
  GrowthThrottle throttle_;
  std::map<uint32_t, std::exception_ptr> failures_;
  int growing_ = 0;
  int64_t held_ = 0;  // charged for units and reservations
  ResidencyCounts counts_;
};

}  // namespace pelage
