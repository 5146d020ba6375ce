// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "view/picture.h"
#include "view/pixel_queries.h"
#include "view/view_control.h"
#include "view/view_status.h"

namespace pelage {

/// The pictures and the status of a live render. The thread that renders writes them, and the threads of the
/// server read them. Thread safety: all members may be called from any thread.
class ViewState {
 public:
  ViewStatus status() const;
  /// Calls `change(status)` while no other thread sees the status.
  template <class Change>
  void update(const Change& change) {
    const std::lock_guard lock(mutex_);
    change(status_);
  }

  /// What clients have changed about the picture.
  ViewControl& control() { return control_; }
  /// What clients ask about its pixels.
  PixelQueries& why() { return why_; }

  /// Returns the last picture; null before the first.
  std::shared_ptr<const Picture> picture() const;
  /// Replaces the picture, and gives it the next version.
  void publish(Picture picture);
  /// Publishes a picture together with its finished frame.
  void publish(Picture picture, std::unique_ptr<const FinishedFrame> frame);
  /// Frees the finished frame. Waits for threads that read it. The picture stays.
  void discard_frame();

  /// Returns the last picture with these layers. Takes them from the finished frame if there is one.
  /// Otherwise, asks for them, so that the next picture has them. Null if the picture does not have all of
  /// them yet.
  std::shared_ptr<const Picture> with_layers(const std::vector<std::string>& layers);
  /// Returns whether a layer was asked for within the last seconds.
  bool is_wanted(const std::string& layer) const;
  /// Calls `use(frame)` with the finished frame; returns false if there is none. The frame stays until `use`
  /// returns.
  template <class Use>
  bool with_frame(const Use& use) const {
    const std::lock_guard lock(frame_mutex_);
    if (frame_) use(*frame_);
    return frame_ != nullptr;
  }

 private:
  ViewControl control_;
  PixelQueries why_;

  mutable std::mutex mutex_;  // guards status_, picture_, wanted_
  ViewStatus status_;
  std::shared_ptr<const Picture> picture_;
  uint64_t version_ = 0;
  std::map<std::string, double> wanted_;  // time of the last request, by layer

  mutable std::mutex frame_mutex_;  // guards frame_; never locked while mutex_ is
  std::unique_ptr<const FinishedFrame> frame_;
  uint64_t frame_version_ = 0;  // version of the picture of frame_
};

}  // namespace pelage
