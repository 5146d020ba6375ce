// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "post/band_job.h"
#include "post/stereo.h"

namespace pelage {

struct StereoFileParams {
  PostFileParams file{{}, {}, 6, {}, int64_t{4} << 30};  ///< fill: every gap by default
  std::optional<std::string> view;      ///< input view; default "left" if it exists, else the default view
  std::optional<float> eye_separation;  ///< scene units; default 6.5 cm where the file defines a unit
  float convergence = std::numeric_limits<float>::infinity();  ///< scene units
  std::optional<float> focal_pixels;                           ///< overrides the camera of the file
  std::optional<float> fov_deg;                                ///< vertical; overrides the camera of the file
  std::string parallax;  ///< layer that contains the parallax, as described by `file.vectors`; empty:
                         ///< computed from a camera
  bool to_left = false;  ///< makes the left eye from the right one
  StereoFilter filter = StereoFilter::kLanczos;
  int strip_rows = kStripRows;
};

/// `pelage stereo` on one file: makes the other eye's picture of one view, with parts named after the other
/// eye. The layer `invented` of the part with the colours contains the filled fraction (`mask`) and the empty
/// fraction (`hole`) of each pixel. Camera matrices, if any, become the other eye's. Throws Error: kInput
/// when the view, its depth or a camera is missing; also throws the errors of BandJob.
PostReport stereo_file(const std::filesystem::path& input, const std::filesystem::path& output,
                       const StereoFileParams& params, const Job& job);

/// Focal length in pixels from the matrices worldToCamera and worldToNDC of a header, in its standard
/// meaning (row vectors, NDC from 0 to 1); nothing where they are missing or singular.
std::optional<float> focal_pixels_of(const ExrPart& part);

/// Converts the camera matrices to the other eye.
void move_camera(ExrPart& part, const StereoCamera& camera);

}  // namespace pelage
