// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "render/accel/accel.h"
#include "render/film/pixel_filter.h"
#include "render/sampling/sample_stream.h"
#include "render/scene/frame_scene.h"

namespace pelage {

/// Dimension of SampleStream for each use of random numbers in a sample. Dimensions do not depend on the
/// course of the path. Each vertex of the path has several; those of the first vertex start at kFirstVertex.
enum class SampleDimension : uint32_t { kFilm = 0, kLens = 1, kTime = 2, kFirstVertex = 3 };
/// Dimensions of a vertex of a path, from its first dimension on.
enum class VertexDimension : uint32_t { kLight = 0, kLobe = 1, kRoulette = 3, kLightChoice = 4, kCount = 5 };
/// Sets the next random number of `stream` to a dimension of a vertex; the first vertex is 0.
inline void seek(SampleStream& stream, VertexDimension dimension, uint32_t vertex = 0) {
  stream.seek(static_cast<uint32_t>(SampleDimension::kFirstVertex) +
              static_cast<uint32_t>(VertexDimension::kCount) * vertex + static_cast<uint32_t>(dimension));
}

struct CameraSample {
  Ray ray;
  V2f offset{0};  ///< from the centre of the pixel, in pixels
};

/// Generates the camera samples of a frame. A sample depends only on the scene, the pixel and the index of
/// the sample in its pixel.
class CameraSamples {
 public:
  /// `scene` must outlive this object. With `splatted`, samples are distributed uniformly over their pixel;
  /// otherwise, their density is proportional to the pixel filter.
  CameraSamples(const FrameScene& scene, const Accel& accel, bool splatted);

  /// Returns the random numbers of a sample.
  SampleStream stream(int x, int y, uint32_t sample) const;
  /// Returns the camera ray of a sample. `stream`: the result of stream() for the same sample.
  CameraSample sample(int x, int y, uint32_t sample, SampleStream& stream) const;

 private:
  const FrameScene scene_;
  const bool opaque_, widens_;
  const FilterSampler place_;
};

}  // namespace pelage
