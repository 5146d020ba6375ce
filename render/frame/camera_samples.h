// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "render/accel/accel.h"
#include "render/film/filter_sampler.h"
#include "render/sampling/sample_stream.h"
#include "render/scene/render_scene.h"

namespace pelage {

/// Number of the SampleStream draw for each use in a sample. The numbers do not depend on the course of the
/// path. Each vertex of the path has several draws, from kFirstVertex on.
enum class SampleDraw : uint32_t { kFilm = 0, kLens = 1, kTime = 2, kFirstVertex = 3 };

struct CameraSample {
  Ray ray;
  V2f offset{0};  ///< from the centre of the pixel, in pixels
};

/// The camera samples of a frame. A sample is a function of (seed, pixel, number of the sample).
class CameraSamples {
 public:
  /// `scene` must outlive this object. With `splatted`, samples are spread evenly over their pixel.
  CameraSamples(const RenderScene& scene, const Accel& accel, bool splatted);

  /// The random numbers of a sample.
  SampleStream stream(int x, int y, uint32_t sample) const;
  /// `stream`: of the same sample.
  CameraSample draw(int x, int y, uint32_t sample, SampleStream& stream) const;

 private:
  const RenderScene& scene_;
  const bool opaque_;
  const FilterSampler place_;
};

}  // namespace pelage
