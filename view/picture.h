// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "render/camera/camera.h"
#include "render/film/frame_header.h"
#include "render/frame/frame_result.h"

namespace pelage {

/// A layer of a picture: the channels "R", "G", "B" and "A" are the layer "beauty"; "key.diffuse.R" belongs
/// to the layer "key.diffuse"; a channel without a dot, such as "Z", is a layer by itself.
std::string layer_of(const std::string& channel);

/// Some layers of a picture at one moment of its render. Immutable.
struct Picture {
  uint64_t version = 0;  ///< greater for each later picture
  int width = 0, height = 0;
  int grid = 1;          ///< see PassState; pixels between those of the grid are still empty
  uint32_t samples = 0;  ///< min sample count of a pixel of the grid
  std::map<std::string, std::vector<ExrChannel>> layers;  ///< by name
};

/// A finished frame, from which any layer can be taken.
struct FinishedFrame {
  FrameResult result;
  FrameHeader header;
  Camera camera;
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
  int edits = 0;                ///< edits that were rendered so far; the first picture is no edit
  std::vector<std::string> layers;    ///< names of all layers of the picture
  std::vector<std::string> warnings;  ///< the last few warnings

  const std::string& error() const { return scene_error.empty() ? render_error : scene_error; }
  /// Returns whether the finished picture is that of the files as they are now.
  bool done() const { return at_rest && error().empty(); }
};

/// What the thread that renders hands to the threads of the server. Thread safety: all members may be called
/// from any thread.
class ViewDesk {
 public:
  ViewStatus status() const;
  /// Calls `change(status)` while no other thread sees the status.
  template <class Change>
  void update(const Change& change) {
    const std::lock_guard lock(mutex_);
    change(status_);
  }

  /// Returns the last picture; null before the first.
  std::shared_ptr<const Picture> picture() const;
  /// Replaces the picture, and gives it the next version.
  void publish(Picture picture);
  /// Publishes a picture together with its finished frame.
  void publish(Picture picture, std::unique_ptr<const FinishedFrame> frame);
  /// Frees the finished frame. Waits for threads that read it. The picture stays.
  void discard_frame();

  /// Returns a layer of the last picture. Takes it from the finished frame if there is one. Otherwise, asks
  /// for the layer, so that the next picture has it. Null if the picture has no such layer yet.
  std::shared_ptr<const Picture> with_layer(const std::string& layer);
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
  mutable std::mutex mutex_;  // guards status_, picture_, wanted_
  ViewStatus status_;
  std::shared_ptr<const Picture> picture_;
  uint64_t version_ = 0;
  std::map<std::string, double> wanted_;  // time of the last request, by layer

  mutable std::mutex frame_mutex_;  // guards frame_; never locked while mutex_ is
  std::unique_ptr<const FinishedFrame> frame_;
  uint64_t frame_version_ = 0;  // version of the picture of frame_
};

/// Returns the layers of a film that `wanted` accepts, by name, and all names of layers in `names`.
std::map<std::string, std::vector<ExrChannel>> film_layers(
    const Film& film, const std::function<bool(const std::string& layer)>& wanted,
    std::vector<std::string>* names = nullptr);

}  // namespace pelage
