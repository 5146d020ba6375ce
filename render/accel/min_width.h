// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/vector.h"
#include "lod/lod_view.h"
#include "render/sampling/sample_stream.h"

namespace pelage {

/// The min width of strands in the picture. A camera sample sees thinner strands as if they had this width,
/// and passes through them with a probability that makes up for it: the mean of width * opacity stays the
/// same.
struct MinWidth {
  LodView view;  ///< the camera
  float pixels = 0;

  /// Returns the radius, in scene units, of a strand of the min width at a point. It is measured at the
  /// middle of the picture when the shutter opens.
  float radius_at(const V3f& point) const { return 0.5f * pixels / pixels_per_unit(view, point); }
  /// Returns the radius of a strand of the min width at this distance from the camera.
  float radius_at(float distance) const { return 0.5f * pixels / pixels_per_unit(view, distance); }
  /// Returns a box that contains what may be seen of strands inside `box`.
  Box3f around(const Box3f& box) const {
    if (box.isEmpty()) return box;
    V3f reach(0);
    for (int axis = 0; axis < 3; ++axis) {
      const float eye = view.open.position[axis];
      reach[axis] = std::max(std::abs(box.min[axis] - eye), std::abs(box.max[axis] - eye));
    }
    const V3f margin(radius_at(reach.length()));
    return {box.min - margin, box.max + margin};
  }

  /// The random numbers of camera samples that see widened strands. The samples of a pixel are stratified: of
  /// those that cross a strand, about the right number stops there.
  static constexpr uint32_t kSamples = 64;
  /// Returns Ray::random of a sample. `pixel`: hash of the pixel and of sample / kSamples.
  static uint32_t random_of(uint64_t pixel, uint32_t sample) {
    return (static_cast<uint32_t>(pixel) & ~(kSamples - 1)) | sample % kSamples;
  }
  /// Whether a sample stops at a crossing with a widened strand. `crossing`: hash of the crossing. `share`:
  /// true width / width.
  static bool stops(uint32_t random, uint64_t crossing, float share) {
    return share >= 1 || SampleStream(crossing, random / kSamples, 0, random % kSamples).next1d() < share;
  }
};

}  // namespace pelage
