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

/// Two cameras with parallel axes. Their pictures are shifted horizontally, so that points at the convergence
/// distance have the same position in both.
struct StereoCamera {
  float focal_pixels = 0;    ///< focal length, in pixels of the picture's width
  float eye_separation = 0;  ///< scene units from the given eye to the other; positive: right, negative: left
  float convergence = std::numeric_limits<float>::infinity();  ///< scene units along the camera axis
};

/// Returns the parallax of a point at `depth`: its x in the other eye's picture minus its x in the given
/// picture, in pixels. Infinite depth and infinite convergence are allowed.
inline float parallax(const StereoCamera& camera, float depth) {
  return camera.focal_pixels * camera.eye_separation * (1 / camera.convergence - 1 / depth);
}

/// Returns the parallax of every pixel as vectors for a FlowField. `depth`: as for the constructor of
/// FlowField.
std::vector<Flow> parallax_field(const std::vector<float>& depth, const StereoCamera& camera);

/// Default of StereoJob::longest_fill, in pixels: fills every gap.
inline constexpr int kFillEverything = FlowField::kLargestSide;

/// Default of `strip_rows` of stereo_rows(): number of rows that a worker processes at a time.
inline constexpr int kStripRows = 16;

enum class StereoFilter { kLanczos, kBox };

/// Rows of the other eye's picture to make, and their input. The vectors of the field are the parallax, so
/// the picture at time 1 is the picture of the other eye.
struct StereoJob {
  const FlowField* field = nullptr;
  WarpTarget target{6, 0, 0};
  StereoFilter filter = StereoFilter::kLanczos;
  RowEnds ends;          ///< whether the source is cut off at its sides
  int longest_fill = 0;  ///< max number of pixels to fill in each gap; below kFillEverything, gaps at the
                         ///< ends of a row are not filled
  int width = 0, height = 0;        ///< size of the whole result
  int first_row = 0, last_row = 0;  ///< rows first_row <= y < last_row
  /// If given, `invented` receives the filled fraction of each pixel, and `missing` the fraction that stayed
  /// empty.
  std::optional<Plane> invented, missing;
};

/// Makes some rows of the other eye's picture with the algorithm Pixstereo [Neulander13]: warps the picture
/// to the other eye, fills the areas that only the other eye sees, and converts samples to pixels. Uses
/// `layers` and `progress` as blur_rows() does. `strip_rows`: number of rows that a worker processes at a
/// time; does not affect pixels.
void stereo_rows(const StereoJob& job, const PostLayers& layers, int strip_rows, const Workers& workers,
                 Progress& progress);

/// Returns the number of rows above and below the rows of a job that the filter reads.
int stereo_margin(StereoFilter filter);

}  // namespace pelage
