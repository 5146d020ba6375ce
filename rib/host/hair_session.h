// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "rib/host/coat_tree.h"
#include "world/frame_coats.h"
#include "world/hair_arguments.h"

namespace pelage {

/// How many strands of a coat are grown: all; those that `render.lod` keeps; or those that the same rule
/// keeps where the picture has `pixels_per_unit` everywhere, without regard to motion, focus and facing, for
/// which only a camera has values.
struct HairDetail {
  enum class Kind { kFull, kSceneCamera, kScale };
  Kind kind = Kind::kFull;
  float pixels_per_unit = 0;
  auto operator<=>(const HairDetail&) const = default;
};

/// The coats of one character, or of all, in one frame, and their leaves. Thread safety: const members may be
/// called from any thread.
class HairFrame {
 public:
  HairFrame(FrameParts parts, const SimplificationParams& lod) : parts_(std::move(parts)), lod_(lod) {}
  const std::vector<FrameCoat>& coats() const { return parts_.coats; }
  /// Returns the leaves of a coat. `workers`: for measuring properties of the coat.
  std::shared_ptr<const CoatTree> tree(size_t coat, const HairDetail& detail, const Workers& workers) const;

 private:
  const FrameParts parts_;
  const SimplificationParams lod_;
  mutable std::mutex mutex_;  // guards the following
  mutable std::deque<std::pair<std::pair<size_t, HairDetail>, std::shared_ptr<const CoatTree>>> trees_;
};

/// A scene that serves procedurals. Its memory, including that of leaves while they grow, stays within
/// `render.memory`. Thread safety: const members may be called from any thread.
class HairSession {
 public:
  /// Reads the scene and its assets. Throws the errors of load_scene() and load_assets().
  explicit HairSession(const HairArguments& arguments);

  const SceneDescription& scene() const { return scene_; }

  /// Returns a character, or all if the name is empty, posed for a frame. Throws Error (kArguments) with the
  /// nearest name if there is no such character.
  std::shared_ptr<const HairFrame> frame(int frame, const std::string& character) const;
  std::shared_ptr<const CoatTree> tree(const HairFrame& frame, size_t coat, const HairDetail& detail) const;
  /// Returns the exact box of a range of leaves. The first call for a tree measures all its leaves.
  Box3f box(const CoatTree& tree, LeafRange range) const;
  /// Grows a leaf. Waits while there is no room for it and other threads grow leaves. Throws Error (kMemory)
  /// if there is no room although no other thread grows a leaf.
  Strands grow(const CoatTree& tree, size_t leaf) const;

 private:
  Job job() const { return {workers_, ledger_, progress_}; }

  SceneDescription scene_;
  mutable MemoryLedger ledger_;
  mutable NoProgress progress_;
  Workers workers_;
  std::unique_ptr<Assets> assets_;
  mutable std::mutex mutex_;  // guards loops of workers_ and the following two
  mutable std::map<std::pair<int, std::string>, std::weak_ptr<const HairFrame>> frames_;
  mutable std::deque<std::shared_ptr<const HairFrame>> recent_;
  mutable std::mutex growth_;  // guards growing_, and reservations of leaves
  mutable std::condition_variable grown_;
  mutable int growing_ = 0;
};

/// The sessions of a process. Keeps the session that was used last, and others as long as they have owners.
/// Thread safety: may be called from any thread.
class HairSessions {
 public:
  /// Returns the session of these arguments: the same for the same scene, overrides and threads. Throws the
  /// errors of HairSession; the next call then tries again.
  std::shared_ptr<const HairSession> of(const HairArguments& arguments);

 private:
  std::mutex mutex_;  // locked while a scene is read, so that no scene is read twice
  std::map<std::string, std::weak_ptr<const HairSession>> open_;
  std::shared_ptr<const HairSession> last_;
};

}  // namespace pelage
