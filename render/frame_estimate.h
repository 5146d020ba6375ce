// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "base/job.h"
#include "image/exr.h"
#include "render/scene/render_scene.h"

namespace pelage {

/// Memory (in bytes) and CPU time (in seconds) of what a frame prepares to save shadow rays: skin
/// balls.
struct ShadowEstimate {
  int64_t making_bytes = 0;  ///< while balls are made, before the first ray
  int64_t held_bytes = 0;    ///< until the end of the frame
  double cpu_s = 0;
};

/// Makes the balls of a few skins, and computes the others from their sizes.
ShadowEstimate estimate_shadows(const RenderScene& scene, const Job& job);

/// Memory (in bytes) and CPU time (in seconds) that rendering a frame will take, computed without tracing a
/// ray. The caller has already posed the scene; what this took is measured, not estimated.
///
/// Fur and skins: every chunk of the frame counts, also outside the view, because shadow rays and bounces
/// reach it. A fixed selection of chunks is grown, and the size of the others follows from their counts.
struct FrameEstimate {
  int64_t scene_bytes = 0;      ///< resident set of this process with the posed and divided scene
  int64_t preparing_bytes = 0;  ///< largest resident set of this process until then
  int64_t film_bytes = 0;       ///< frame buffer
  int64_t buffer_bytes = 0;     ///< sample buffers and reflection cache of `gather`
  ShadowEstimate shadows;       ///< skin balls
  int64_t box_bytes = 0;        ///< boxes of the chunks
  int64_t measuring_bytes = 0;  ///< chunks that threads grow to measure their boxes
  int64_t chunk_bytes = 0;      ///< fur and skins in memory at once, and chunks that threads grow meanwhile
  int64_t library_bytes = 0;    ///< program and libraries, beyond what is in memory already
  int64_t writing_bytes = 0;    ///< rows of the picture while it is written; the chunks are freed by then
  bool fits = true;             ///< whether all chunks fit `render.memory` together

  int64_t chunks = 0, strands = 0;
  double measuring_cpu_s = 0;  ///< growing chunks to measure their boxes; 0 if a cache has the boxes
  double growing_cpu_s = 0;    ///< growing every chunk once
  double tracing_cpu_s = 0;    ///< rays and shading: roughly, from the count of samples

  double writing_cpu_s = 0;  ///< compressing the picture, roughly

  /// Returns the largest resident set of the process, at any time of the run.
  int64_t peak_bytes() const;
  /// Returns the CPU time from the first box to the end.
  double cpu_s() const {
    return measuring_cpu_s + growing_cpu_s + shadows.cpu_s + tracing_cpu_s + writing_cpu_s;
  }
};

/// Estimates a frame. `region`: the only pixels to render; empty for the whole picture. Throws the errors of
/// render_frame() that need no ray: of kind kMemory if `render.memory` is too small.
FrameEstimate estimate_frame(const RenderScene& scene, const Job& job, const std::optional<PixelBox>& region);

}  // namespace pelage
