// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/vector.h"
#include "view/picture.h"
#include "view/pixel_queries.h"
#include "view/view_control.h"

namespace pelage {

struct SceneEdit;

/// The camera of the scene at the first frame. In scene units and degrees.
struct ViewCamera {
  V3f position{0}, look_at{0}, up{0, 1, 0};
  float fov = 40;
  float height = 0;    ///< of an orthographic picture, scene units; 0: perspective, or from `fov`
  bool moved = false;  ///< by a client; the scene file has another camera
};

/// Progress of the current render, as state.json reports it.
struct ViewStatus {
  bool at_rest = false;         ///< the render of the last edit without an error is complete
  std::string scene_error;      ///< problems of the scene file; empty if there are none
  std::string render_error;     ///< problems of reading the assets or of rendering; empty if there are none
  std::string stage;            ///< "read", "pose", "bound", "render" ...; empty at rest
  double progress = 0;          ///< fraction of the stage
  double mean_samples = 0;      ///< mean sample count of a pixel
  int wanted_samples = 0;       ///< sample count of a pixel when done
  int64_t strands_regrown = 0;  ///< strands grown again since the last edit
  double first_pixels_s = 0;    ///< seconds from the edit to its first picture; 0 before
  double render_s = 0;          ///< seconds from the edit to the end of the render; 0 before
  int64_t memory_bytes = 0;     ///< memory in use, as the ledger counts it
  std::shared_ptr<const SceneEdit> edit;  ///< the edit that is rendered; null before the first
  int edits = 0;                          ///< edits that were rendered so far; the first picture is no edit
  int frame = 1;                          ///< the frame that is shown
  std::vector<int> frames;                ///< the first 10,000 frames of the scene
  ViewCamera camera;
  std::vector<ViewLight> lights;    ///< of the shown scene, with what clients have changed
  std::string camera_note;          ///< why the camera is no longer the one that a client moved; may be empty
  std::vector<std::string> layers;  ///< names of all layers of the picture
  std::vector<std::string> warnings;  ///< the last few warnings

  const std::string& error() const { return scene_error.empty() ? render_error : scene_error; }
  /// Returns whether the finished picture shows the current content of the files.
  bool done() const { return at_rest && error().empty(); }
};

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
  /// Notes that a page asks for the state. `page`: chosen by the page; empty for other clients.
  void see_page(const std::string& page);
  /// Returns how many pages have asked within the last seconds.
  size_t pages() const;

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

  mutable std::mutex mutex_;  // guards status_, picture_, wanted_, pages_
  ViewStatus status_;
  std::shared_ptr<const Picture> picture_;
  uint64_t version_ = 0;
  std::map<std::string, double> wanted_;  // time of the last request, by layer
  std::map<std::string, double> pages_;   // time of the last request, by page

  mutable std::mutex frame_mutex_;  // guards frame_; never locked while mutex_ is
  std::unique_ptr<const FinishedFrame> frame_;
  uint64_t frame_version_ = 0;  // version of the picture of frame_
};

}  // namespace pelage
