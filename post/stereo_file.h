// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "post/band_job.h"
#include "post/stereo.h"

namespace pelage {

struct StereoFileParams {
  PostFileParams file{
      {}, {}, 6, {}, int64_t{4} << 30};  ///< default: 6 x 6 samples per pixel, fills all gaps, 4 GiB
  std::optional<std::string> view;       ///< input view; empty: "left" if it exists, else the file's default
  std::optional<float> eye_separation;   ///< scene units; empty: 6.5 cm, if the file defines the unit
  float convergence = std::numeric_limits<float>::infinity();  ///< scene units
  std::optional<float> focal_pixels;                           ///< empty: from the file's camera
  std::optional<float> fov_deg;  ///< vertical field of view; empty: from the file
  std::string parallax;  ///< layer that contains the parallax, in the unit of `file.vectors`; empty: the
                         ///< parallax is computed from depth and camera
  bool to_left = false;  ///< makes the left eye's picture from the right eye's
  StereoFilter filter = StereoFilter::kLanczos;
  int strip_rows = kStripRows;
};

/// Processes one file as `pelage stereo` does: reads the view of one eye and makes the picture for the other
/// eye. The parts get the names of the other eye. The part with the colours gets a layer `invented`,
/// whose channels are the filled fraction (`mask`) and the empty fraction (`hole`) of each pixel. Camera
/// matrices of the header, if any, are converted to the other eye. Throws Error (kInput) when the view, its
/// depth or a camera is missing. Passes on the errors of BandJob.
PostReport stereo_file(const std::filesystem::path& input, const std::filesystem::path& output,
                       const StereoFileParams& params, const Job& job);

/// Returns the focal length in horizontal pixels. It is computed from the matrices worldToCamera and
/// worldToNDC of a header. They have the meaning of the OpenEXR standard: row vectors, NDC from 0 to 1.
/// Returns an empty value when a matrix is missing or the focal length cannot be computed.
std::optional<float> focal_pixels_of(const ExrPart& part);

/// Converts the camera matrices of a header to the other eye. Does nothing when they are missing or singular.
void move_camera(ExrPart& part, const StereoCamera& camera);

}  // namespace pelage
