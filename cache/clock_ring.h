// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pelage {

/// A ring of numbers below a fixed capacity, with a hand on one of them, for CLOCK replacement [Corbato68]:
/// the hand moves around the ring and evicts entries that were not used since its last visit. Not thread
/// safe.
class ClockRing {
 public:
  explicit ClockRing(size_t capacity) : links_(capacity) {}

  bool empty() const { return size_ == 0; }
  size_t size() const { return size_; }
  size_t bytes() const { return links_.capacity() * sizeof(Link); }
  /// The number under the hand. The ring must not be empty.
  uint32_t hand() const { return hand_; }
  void advance() { hand_ = links_[hand_].next; }

  /// Adds a number that is not in the ring, at the position that the hand reaches last.
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

  /// Removes the number under the hand and moves the hand to the next one.
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
