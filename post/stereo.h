// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "post/fill_holes.h"
#include "post/flow_field.h"
#include "post/layers.h"
#include "post/motion_blur.h"

namespace pelage {

/// Two parallel cameras whose pictures are shifted horizontally, so that points at the convergence distance
/// coincide.
struct StereoCamera {
  float focal_pixels = 0;  ///< focal length, in pixels of the picture's width
  float eye_separation =
      0;  ///< scene units; the other eye is to the right, or with a negative one to the left
  float convergence = std::numeric_limits<float>::infinity();  ///< scene units along the camera axis
};

/// Horizontal offset, in pixels to the right, of a point at `depth` in the other eye. Infinite depth and
/// infinite convergence are allowed.
inline float parallax(const StereoCamera& camera, float depth) {
  return camera.focal_pixels * camera.eye_separation * (1 / camera.convergence - 1 / depth);
}

/// The same for every pixel, as a field's vectors; depth as in FlowField.
std::vector<Flow> parallax_field(const std::vector<float>& depth, const StereoCamera& camera);

/// Default max size of gaps to fill, in pixels: every gap is filled.
inline constexpr int kFillEverything = FlowField::kLargestSide;

/// Default number of rows in a strip.
inline constexpr int kStripRows = 16;

enum class StereoFilter { kLanczos, kBox };

/// The field contains the parallax (time 1 is the other eye). Rows and columns as in BlurJob. `invented`, if
/// given, receives the filled fraction of each pixel; `missing`, if given, receives the fraction that stayed
/// empty.
struct StereoJob {
  const FlowField* field = nullptr;
  WarpTarget target{6, 0, 0};
  StereoFilter filter = StereoFilter::kLanczos;
  RowEnds ends;               ///< whether the source is cut off at its sides
  int longest_fill = 0;       ///< max number of pixels to fill in a gap
  int width = 0, height = 0;  ///< size of the whole result
  int first_row = 0, last_row = 0;
  std::optional<Plane> invented, missing;
};

/// Pixstereo [Neulander13]: warps the picture once, to the other eye, fills areas that only that eye sees,
/// and resolves. Layers, progress and cancelling as in blur_rows. `strip_rows`: rows that a worker processes
/// at a time; does not affect pixels.
void stereo_rows(const StereoJob& job, const PostLayers& layers, int strip_rows, const Workers& workers,
                 Progress& progress);

/// Number of rows beyond first_row .. last_row that the filter reads.
int stereo_margin(StereoFilter filter);

}  // namespace pelage
