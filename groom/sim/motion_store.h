// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "base/content_store.h"
#include "groom/strands/guide_turns.h"

namespace pelage {

/// The simulated motion of one coat in one frame.
struct FrameMotionData {
  GuideTurns half;           ///< half a frame before the frame
  GuideTurns whole;          ///< at the frame
  std::vector<float> state;  ///< at the frame (GuideSimulation::state())
};

/// Stored motion of one coat: one entry of a content store per frame. A damaged entry counts as missing.
/// Turns are rounded to 16 bits per number. Thread safety: const members may be called from any thread.
class MotionStore {
 public:
  /// Raised whenever a simulation gives other results than before.
  static constexpr int kVersion = 3;

  /// `key`: hash of everything that determines the motion.
  MotionStore(ContentStore store, const ContentHash& key) : store_(std::move(store)), key_(key) {}

  const ContentStore& store() const { return store_; }
  std::filesystem::path file(int frame) const;
  /// Reads the motion of guides with this number of segments altogether. Empty when missing or damaged;
  /// `warn` is told of damage. Without `with_state`, the state stays empty.
  std::optional<FrameMotionData> read(int frame, size_t segments, bool with_state,
                                      const WarningSink& warn) const;
  /// Returns whether the motion is stored now.
  bool write(int frame, const FrameMotionData& motion, const WarningSink& warn) const;

 private:
  ContentHash key_of(int frame) const;
  ContentStore store_;
  ContentHash key_;
};

}  // namespace pelage
