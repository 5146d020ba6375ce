// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace pelage {

/// Memory that holds everything about a frame that has been sampled in part: its film, in blocks. The blocks
/// of all renders of the same frame have the same sizes. A render whose blocks get the bytes of another
/// render continues where the other one was, and ends with the same film.
using FrameState = std::vector<std::span<std::byte>>;

/// Stores the state of a frame from time to time while it is rendered, so that a later render can continue.
///
/// save() and restore() are called on the thread that renders, when no other thread writes the film.
class FrameSaver {
 public:
  virtual ~FrameSaver() = default;
  /// Returns whether the state should be saved now. The threads then stop between two samples (or two
  /// portions of samples that share light), save() is called, and the render continues. Must return false
  /// right after save(), so that the render proceeds. Cheap; any thread may call it at any time.
  virtual bool due() const = 0;
  /// Stores the state. Also called when the render is cancelled.
  virtual void save(const FrameState& state) = 0;
  /// Called once before the first sample. Fills all blocks with a stored state and returns true, or leaves
  /// them unchanged and returns false.
  virtual bool restore(const FrameState& state) = 0;
};

}  // namespace pelage
