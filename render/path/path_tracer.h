// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "render/film/film.h"
#include "render/frame/camera_samples.h"
#include "render/frame/frame_shading.h"
#include "render/frame/shadow_catcher.h"
#include "render/frame/tile_integrator.h"
#include "render/path/path_walk.h"

namespace pelage {

/// The integrator `path`: computes each sample of a pixel from one path (PathWalk). A path depends only on
/// the scene, the pixel and the index of the sample in its pixel.
class PathTracer final : public SampleIntegrator {
 public:
  PathTracer(const FrameScene& scene, const Accel& accel, const FilmLayers& layers,
             const PathOptions& options);

  std::unique_ptr<SampleScratch> make_scratch() const override;
  void trace(int x, int y, uint32_t sample, SampleScratch& scratch) const override;

 private:
  struct Scratch;
  class FilmSink;

  const FrameScene scene_;
  const Accel& accel_;
  const FilmLayers& layers_;
  FrameShading shading_;
  CameraSamples camera_;
  ShadowCatcher catcher_;
  PathWalk<FilmSink> walk_;
};

}  // namespace pelage
