// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "render/film/film.h"

namespace pelage {

/// How far a frame has come when a pass over its pixels ends.
struct PassState {
  uint32_t samples = 0;     ///< min sample count over the traced pixels
  double mean_samples = 0;  ///< mean sample count over the traced pixels
  int grid = 1;  ///< greater than 1: only the pixels whose x and y are multiples of `grid` are sure to have
                 ///< samples; 0: no pass over the whole picture has ended
  bool coarse = false;  ///< the film is that of FrameWatch's coarse pictures, not the frame's
  PixelBox full;        ///< all pixels of this box have samples, whatever `grid` is; may be empty
};

/// Sees a frame while it is rendered. The calls are made on the thread that renders, between two passes, when
/// no other thread writes the film. A slow watch delays the render.
///
/// A watch may choose a region. Its pixels get all their samples before the other pixels get more; with
/// adaptive sampling or a time limit, each pass renders the region first. The film is the same in the end.
/// With the integrator `gather` or splatted samples, a region consists of whole tiles, because the order of
/// their samples matters.
///
/// With a watch, the passes are shorter. With the integrator `path`, the first sample of every pixel is taken
/// on grids of 8, 4 and 2 pixels first, unless samples are splatted. With `gather`, coarse pictures on such
/// grids come before the skin balls and the reflection cache, which take long: `path` makes them with
/// coarse_settings(), in a film of their own, which is then freed. They are left out for a region of the
/// picture and where memory is short. The film of the frame is the same in the end.
class FrameWatch {
 public:
  virtual ~FrameWatch() = default;
  virtual void passed(const Film& film, const PassState& state) = 0;
  /// Returns the region, in pixels of the film; empty for none. This function and the next one may be
  /// called by any thread, at any time.
  virtual std::optional<PixelBox> region() const = 0;
  /// Returns a number that changes with the region; 0 if there has never been a region.
  virtual uint32_t region_version() const = 0;
  /// Returns a number that changes when the watch asks for a pause. The pass under way then ends early,
  /// paused() is called, and the pass continues. May be called by any thread, at any time.
  virtual uint32_t pause_version() const { return 0; }
  /// Called like passed(), in a pause.
  virtual void paused(const Film&, const PassState&) {}
};

}  // namespace pelage
