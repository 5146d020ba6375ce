// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "post/band_job.h"
#include "post/stereo.h"

namespace pelage {

struct StereoFileParams {
  PostFileParams file{{}, {}, 6, {}, int64_t{4} << 30};  ///< fill: by default every gap
  std::optional<std::string> view;  ///< to start from; default "left" if there is one, else the default view
  std::optional<float> eye_separation;  ///< scene units; default 6.5 cm where the file says what a unit is
  float convergence = std::numeric_limits<float>::infinity();  ///< scene units
  std::optional<float> focal_pixels;                           ///< instead of the camera of the file
  std::optional<float> fov_deg;                                ///< vertical; the same
  std::string parallax;  ///< layer to take the parallax from, by `file.vectors`, instead of a camera
  bool to_left = false;  ///< makes the left eye, of the right one
  StereoFilter filter = StereoFilter::kLanczos;
  int strip_rows = kStripRows;
};

/// `pelage stereo` on one file: the other eye's picture of one view, parts named for it. The layer
/// `invented` of the part with the colours says what part of each pixel was filled (`mask`) and what part
/// stayed empty (`hole`). Matrices of the camera, if there are any, become the other eye's. Throws Error:
/// kInput when the view, its depth or a camera is missing, and as BandJob does.
PostReport stereo_file(const std::filesystem::path& input, const std::filesystem::path& output,
                       const StereoFileParams& params, const Job& job);

/// Focal length in pixels from the matrices worldToCamera and worldToNDC of a header, in its standard
/// meaning (row vectors, NDC from 0 to 1); nothing where they are missing or singular.
std::optional<float> focal_pixels_of(const ExrPart& part);

/// The matrices as the other eye has them.
void move_camera(ExrPart& part, const StereoCamera& camera);

}  // namespace pelage
