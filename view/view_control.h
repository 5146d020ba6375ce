// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/vector.h"
#include "image/exr.h"
#include "scene/value_edits.h"
#include "view/light_changes.h"

namespace pelage {

/// A camera that a client has moved. In scene units.
struct CameraMove {
  V3f position{0, 0, 10}, look_at{0};
  bool operator==(const CameraMove&) const = default;
};

/// Returns the values of a scene with this camera. The other keys of the block `camera` stay.
std::vector<ValueEdit> camera_edits(const CameraMove& move);

/// Returns camera_edits() as options `--set`.
std::vector<Override> camera_overrides(const CameraMove& move);

/// What clients of a view have changed about its picture, apart from the files. Thread safety: all members
/// may be called from any thread.
class ViewControl {
 public:
  /// Returns the moved camera; empty while the camera is that of the scene.
  std::optional<CameraMove> camera() const { return locked(camera_); }
  void set_camera(std::optional<CameraMove> camera) {
    const std::lock_guard lock(mutex_);
    camera_ = camera;
    if (changed_) changed_();
  }

  /// Returns the chosen frame; empty for the first frame of the scene.
  std::optional<int> frame() const { return locked(frame_); }
  void set_frame(std::optional<int> frame) {
    const std::lock_guard lock(mutex_);
    frame_ = frame;
    if (changed_) changed_();
  }

  /// Returns whether many bounces are estimated by dual scattering, whatever the scene says.
  bool dual() const { return locked(dual_); }
  void set_dual(bool dual) {
    const std::lock_guard lock(mutex_);
    dual_ = dual;
    if (changed_) changed_();
  }

  /// Returns what clients have changed about the lights of the scene.
  LightChanges lights() const { return locked(lights_); }
  /// Calls `change(lights())` while no other thread sees them.
  template <class Change>
  void change_lights(const Change& change) {
    const std::lock_guard lock(mutex_);
    change(lights_);
    if (changed_) changed_();
  }
  /// Does the same, so that undo_rig() takes the change back. Changes with the same name of a gesture are
  /// taken back together.
  template <class Change>
  void change_rig(const Change& change, const std::string& gesture = {}) {
    const std::lock_guard lock(mutex_);
    LightChanges before = lights_;
    change(lights_);
    if (gesture.empty() || gesture != gesture_ || undo_.empty()) undo_.push_back(std::move(before));
    forget_oldest();
    gesture_ = gesture;
    if (changed_) changed_();
  }
  /// Takes the last change_rig() back. Returns false if there is none since the scene file got or lost
  /// lights.
  bool undo_rig() {
    const std::lock_guard lock(mutex_);
    if (undo_.empty()) return false;
    lights_ = std::move(undo_.back());
    undo_.pop_back();
    gesture_.clear();
    if (changed_) changed_();
    return true;
  }
  bool can_undo_rig() const {
    const std::lock_guard lock(mutex_);
    return !undo_.empty();
  }
  /// Forgets what undo_rig() would take back: the changes were made to another scene file.
  void forget_rig() {
    const std::lock_guard lock(mutex_);
    undo_.clear();
  }
  /// Ends changes that the scene file has now, unless newer ones have replaced them. A newer change of an
  /// added light becomes one of a light of the scene.
  void end_lights(const LightChanges& ended) {
    forget_rig();
    change_lights([&](LightChanges& lights) {
      for (const auto& [name, change] : ended) {
        const auto found = lights.find(name);
        if (found == lights.end()) continue;
        if (found->second == change)
          lights.erase(found);
        else if (found->second.added_type == change.added_type)
          found->second.added_type.clear();
      }
    });
  }
  /// Announces that a command is going to write lights into the scene file. This change of the file does not
  /// end their changes.
  void begin_writing_lights(const std::set<RigItem>& items) {
    const std::lock_guard lock(mutex_);
    writing_lights_.insert(items.begin(), items.end());
  }
  /// Returns those of some lights that were announced since the last call that named them.
  std::set<RigItem> take_written_lights(const std::set<RigItem>& items) {
    const std::lock_guard lock(mutex_);
    std::set<RigItem> written;
    for (const RigItem& item : items) {
      if (writing_lights_.erase(item) > 0) written.insert(item);
    }
    return written;
  }

  /// Ends the choice of a frame, unless a newer choice has replaced it.
  void end_frame(int frame) {
    if (this->frame() == frame) set_frame({});
  }
  /// Ends a move of the camera, unless a newer move has replaced it.
  void end_camera(const CameraMove& move) {
    if (camera() == move) set_camera({});
  }
  /// Announces that a command is going to write the camera into the scene file. This change of the file does
  /// not end a newer move of the camera.
  void begin_writing() { writing_ = true; }
  /// Returns whether begin_writing() was called since the last call.
  bool take_written() { return writing_.exchange(false); }

  /// Returns the pixels that are to be refined before all others; empty for none.
  std::optional<PixelBox> region() const { return locked(region_); }
  void set_region(std::optional<PixelBox> region) {
    const std::lock_guard lock(mutex_);
    region_ = region;
    ++region_version_;
  }
  /// Returns how often the region was set.
  uint32_t region_version() const { return region_version_; }

  /// Calls `changed` after each change of the camera, the frame, the lights or dual(). An empty function ends
  /// these calls.
  void on_change(std::function<void()> changed) {
    const std::lock_guard lock(mutex_);
    changed_ = std::move(changed);
  }

 private:
  static constexpr size_t kMaxUndo = 200, kMaxUndoChanges = 40'000;

  /// Keeps what undo_rig() needs within its limits; the last step always stays.
  void forget_oldest() {
    size_t changes = 0, steps = 0;
    for (auto step = undo_.rbegin(); step != undo_.rend(); ++step) {
      changes += step->size();
      if (steps > 0 && (changes > kMaxUndoChanges || steps == kMaxUndo)) break;
      ++steps;
    }
    undo_.erase(undo_.begin(), undo_.end() - static_cast<std::ptrdiff_t>(steps));
  }

  template <class T>
  T locked(const T& value) const {
    const std::lock_guard lock(mutex_);
    return value;
  }

  mutable std::mutex mutex_;  // guards all
  std::optional<CameraMove> camera_;
  std::optional<int> frame_;
  LightChanges lights_;
  std::vector<LightChanges> undo_;  // lights_ before each change_rig()
  std::string gesture_;             // of the last change_rig()
  std::set<RigItem> writing_lights_;
  bool dual_ = false;
  std::optional<PixelBox> region_;
  std::atomic<uint32_t> region_version_{0};
  std::function<void()> changed_;
  std::atomic<bool> writing_{false};
};

}  // namespace pelage
