// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace pelage {

/// The rays of one thread that wait for pages of fur: of each where it goes next, and of each page who waits
/// for it. Takes its memory once.
class WaitingRays {
 public:
  static constexpr uint32_t kNone = ~0u;

  /// A treelet on the way of a ray, and where the ray enters its box. No two of a ray are equal.
  struct Step {
    float entry = 0;
    uint32_t treelet = 0;

    bool operator<(const Step& o) const { return entry != o.entry ? entry < o.entry : treelet < o.treelet; }
  };

  /// The first few of the steps that a ray has before it. Those behind them are found again when it gets
  /// there.
  class UpcomingSteps {
   public:
    static constexpr size_t kMaxSteps = 6;

    bool is_empty() const { return begin_ == end_; }
    bool is_full() const { return end_ - begin_ == kMaxSteps; }
    /// In order, unless bring_forward() was called.
    const Step& front() const { return steps_[begin_]; }
    const Step& back() const { return steps_[size_t(end_) - 1]; }
    void pop() { ++begin_; }
    void clear() { begin_ = end_ = 0; }
    /// Into its place, before any is popped; the last one makes room for it, unless it would be the last.
    void add(const Step& step);
    /// The first of them of whose treelet it is true, if there is any, comes to the front.
    template <class Is>
    void bring_forward(const Is& is) {
      for (size_t i = begin_; i < end_; ++i) {
        if (!is(steps_[i].treelet)) continue;
        std::swap(steps_[i], steps_[begin_]);
        return;
      }
    }
    /// The last in order of those that were added.
    Step last() const;

   private:
    std::array<Step, kMaxSteps> steps_;
    uint16_t begin_ = 0, end_ = 0;
  };

  struct Ray {
    uint32_t number = 0;       ///< among the rays that are asked for
    uint32_t next = kNone;     ///< the slot of the next ray that waits for the same page, or that is free
    bool is_complete = false;  ///< no steps come after those ahead
    UpcomingSteps upcoming;
  };

  /// Room for so many rays; none: no memory.
  WaitingRays(size_t pages, size_t rays);
  static size_t bytes(size_t pages, size_t rays);

  bool is_full() const { return free_ == kNone; }
  bool is_empty() const { return waiting_.empty(); }
  Ray& operator[](uint32_t slot) { return rays_[slot]; }

  /// A slot for one ray more, unless it is full. Rays are in slots from here to end(), whether they wait or
  /// not.
  uint32_t begin();
  void end(uint32_t slot);

  /// The ray joins the end of a page's queue.
  void wait(uint32_t slot, uint32_t page);
  /// The page that most rays wait for; of equal ones the one that was waited for first. Unless it is empty.
  uint32_t fullest() const;
  /// Ends the queue of a page: its first slot.
  uint32_t release(uint32_t page);
  /// All slots are free again.
  void clear();

 private:
  struct Queue {
    uint32_t first = kNone, last = kNone, count = 0;
  };

  std::vector<Ray> rays_;
  std::vector<Queue> queues_;      // by page
  std::vector<uint32_t> waiting_;  // pages whose queues are not empty
  uint32_t free_ = kNone;
};

}  // namespace pelage
