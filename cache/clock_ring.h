// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pelage {

/// A ring of slot numbers 0 .. capacity-1 for CLOCK replacement [Corbato68]. The hand points to one number of
/// the ring. A cache moves the hand around the ring, and evicts each slot that was not used since the hand
/// last passed it. Not thread safe.
class ClockRing {
 public:
  explicit ClockRing(size_t capacity) : links_(capacity) {}

  bool empty() const { return size_ == 0; }
  size_t size() const { return size_; }
  /// Heap memory.
  size_t bytes() const { return links_.capacity() * sizeof(Link); }
  /// Returns the number under the hand. The ring must not be empty.
  uint32_t hand() const { return hand_; }
  /// Moves the hand to the next number. The ring must not be empty.
  void advance() { hand_ = links_[hand_].next; }

  /// Adds a number that is not in the ring, directly behind the hand, so that the hand reaches it last.
  void insert(uint32_t number) {
    if (size_++ == 0) {
      links_[number] = {number, number};
      hand_ = number;
      return;
    }
    const uint32_t last = links_[hand_].previous;
    links_[number] = {last, hand_};
    links_[last].next = number;
    links_[hand_].previous = number;
  }

  /// Removes a number of the ring. If it is under the hand, moves the hand to the next number.
  void remove(uint32_t number) {
    const uint32_t hand = hand_;
    hand_ = number;
    remove_hand();
    if (hand != number) hand_ = hand;
  }

  /// Removes the number under the hand, moves the hand to the next number, and returns the removed number.
  uint32_t remove_hand() {
    const uint32_t number = hand_;
    const Link link = links_[number];
    links_[link.previous].next = link.next;
    links_[link.next].previous = link.previous;
    hand_ = link.next;
    --size_;
    return number;
  }

 private:
  struct Link {
    uint32_t previous = 0;
    uint32_t next = 0;
  };
  std::vector<Link> links_;
  size_t size_ = 0;
  uint32_t hand_ = 0;
};

}  // namespace pelage
