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

/// Two parallel cameras whose pictures are shifted against each other, so that what lies at the distance of
/// convergence is at the same place in both.
struct StereoCamera {
  float focal_pixels = 0;  ///< focal length, in pixels of the picture's width
  float eye_separation =
      0;  ///< scene units; the other eye is to the right, or with a negative one to the left
  float convergence = std::numeric_limits<float>::infinity();  ///< scene units along the camera axis
};

/// Where a point at `depth` lies in the other eye: pixels to the right of where it is. Infinite depth and
/// infinite convergence are meant.
inline float parallax(const StereoCamera& camera, float depth) {
  return camera.focal_pixels * camera.eye_separation * (1 / camera.convergence - 1 / depth);
}

/// The same for every pixel, as a field's vectors; depth as FlowField takes it.
std::vector<Flow> parallax_field(const std::vector<float>& depth, const StereoCamera& camera);

/// Pixels of a gap that are filled by default: every gap is filled.
inline constexpr int kFillEverything = FlowField::kLargestSide;

/// Rows of the strips that are held at a time unless somebody says otherwise.
inline constexpr int kStripRows = 16;

enum class StereoFilter { kLanczos, kBox };

/// The field holds the parallax (time 1 is the other eye). Rows and columns are those of BlurJob. `invented`
/// and `missing`, where given, get the part of each pixel that was filled, and the part that stayed empty.
struct StereoJob {
  const FlowField* field = nullptr;
  WarpTarget target{6, 0, 0};
  StereoFilter filter = StereoFilter::kLanczos;
  RowEnds ends;               ///< whether the source is cut off at its sides, rather than over
  int longest_fill = 0;       ///< pixels of a gap that are filled
  int width = 0, height = 0;  ///< of the whole result
  int first_row = 0, last_row = 0;
  std::optional<Plane> invented, missing;
};

/// Pixstereo [Neulander13]: warps the picture once, to the other eye, fills what that eye sees and the first
/// one did not, and resolves. Layers, progress and cancelling as in blur_rows. `strip_rows`: of the strips
/// that a worker holds at a time; changes no pixel.
void stereo_rows(const StereoJob& job, const PostLayers& layers, int strip_rows, const Workers& workers,
                 Progress& progress);

/// Rows beyond first_row .. last_row that the filter looks at.
int stereo_margin(StereoFilter filter);

}  // namespace pelage
