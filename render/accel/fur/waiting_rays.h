// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace pelage {

/// The rays of one thread that wait for pages of fur. Stores the next steps of each ray, and a queue of rays
/// for each page. Only the constructor allocates memory.
class WaitingRays {
 public:
  static constexpr uint32_t kNone = ~0u;

  /// A treelet whose box a ray intersects, and the distance at which the ray enters the box. A ray never has
  /// the same step twice.
  struct Step {
    float entry = 0;
    uint32_t treelet = 0;

    bool operator<(const Step& o) const { return entry != o.entry ? entry < o.entry : treelet < o.treelet; }
  };

  /// The next few steps of a ray, in ascending order. Steps that do not fit are found by a new search when
  /// these steps have been used up.
  class UpcomingSteps {
   public:
    static constexpr size_t kMaxSteps = 6;

    bool is_empty() const { return begin_ == end_; }
    bool is_full() const { return end_ - begin_ == kMaxSteps; }
    /// The first and the last step. Steps are in ascending order unless bring_forward() was called.
    const Step& front() const { return steps_[begin_]; }
    const Step& back() const { return steps_[size_t(end_) - 1]; }
    void pop() { ++begin_; }
    void clear() { begin_ = end_ = 0; }
    /// Inserts a step in ascending order. Must not be called between pop() and clear(). If there are already
    /// kMaxSteps steps, drops the largest step, which may be the new one.
    void add(const Step& step);
    /// Swaps the first step whose treelet satisfies the predicate with the front step. Does nothing if there
    /// is no such step.
    template <class Is>
    void bring_forward(const Is& is) {
      for (size_t i = begin_; i < end_; ++i) {
        if (!is(steps_[i].treelet)) continue;
        std::swap(steps_[i], steps_[begin_]);
        return;
      }
    }
    /// Returns the largest step that was added since clear(), even if it was popped.
    Step last() const;

   private:
    std::array<Step, kMaxSteps> steps_;
    uint16_t begin_ = 0, end_ = 0;
  };

  struct Ray {
    uint32_t number = 0;       ///< index among the query's rays
    uint32_t next = kNone;     ///< slot of the next ray that waits for the same page, or next free slot
    bool is_complete = false;  ///< there are no steps after the upcoming ones
    UpcomingSteps upcoming;
  };

  /// Allocates memory for at most `rays` rays that wait for `pages` pages; nothing if `rays` is 0.
  WaitingRays(size_t pages, size_t rays);
  static size_t bytes(size_t pages, size_t rays);

  bool is_full() const { return free_ == kNone; }
  bool is_empty() const { return waiting_.empty(); }
  Ray& operator[](uint32_t slot) { return rays_[slot]; }

  /// Returns a slot for one more ray; there must be a free one. A ray occupies its slot until end(), whether
  /// it waits or not.
  uint32_t begin();
  void end(uint32_t slot);

  /// Appends the ray in `slot` to the queue of `page`.
  void wait(uint32_t slot, uint32_t page);
  /// Returns the page that the most rays wait for; of several such pages, the page whose queue has existed
  /// longest. At least one ray must be waiting.
  uint32_t fullest() const;
  /// Removes the queue of a page and returns the slot of its first ray. Ray::next links the rays of the
  /// queue.
  uint32_t release(uint32_t page);
  /// Frees all slots.
  void clear();

 private:
  struct Queue {
    uint32_t first = kNone, last = kNone, count = 0;
  };

  std::vector<Ray> rays_;
  std::vector<Queue> queues_;      // by page
  std::vector<uint32_t> waiting_;  // pages with a non-empty queue
  uint32_t free_ = kNone;
};

}  // namespace pelage
