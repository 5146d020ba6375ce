// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "render/film/film.h"
#include "render/film/filter_sampler.h"
#include "render/frame/frame_shading.h"
#include "render/frame/sample_integrator.h"
#include "render/light/direct_light.h"
#include "render/sampling/sample_stream.h"

namespace pelage {

struct PathOptions {
  DirectTechniques direct = DirectTechniques::kBoth;
  bool roulette = true;
};

/// Traces single paths through a frame. A path is a function of (scene, pixel, sample number).
///
/// At each vertex, `light_samples` shadow rays go to lights (DirectLight), and the lobes are sampled; the
/// density of the latter includes Russian roulette. At most `bounces` scatterings follow the first; Russian
/// roulette ends paths with a probability that depends on the loss of their weight.
class PathTracer final : public SampleIntegrator {
 public:
  PathTracer(const RenderScene& scene, const Accel& accel, const FilmLayers& layers,
             const PathOptions& options);

  std::unique_ptr<SampleScratch> make_scratch() const override;
  void trace(int x, int y, uint32_t sample, SampleScratch& scratch) const override;

 private:
  struct Scratch;
  struct Path;
  Ray camera_ray(int x, int y, SampleStream& stream, Scratch& scratch) const;
  void see_lights(const Ray& ray, float distance, Scratch& scratch) const;
  void sample_lights(const ScatterPoint& point, Path& path) const;
  bool is_last(const Path& path) const;
  float arriving_pdf(const FibreValue& value, const Path& path) const;
  void shadow_ray(const ScatterPoint& point, const LightPoint& to, float factor, Path& path) const;
  bool sample_lobes(const ScatterPoint& point, Path& path) const;
  void gather_lights(const ScatterPoint& point, const Ray& ray, float distance, float lobe_pdf, bool shadowed,
                     Path& path) const;

  const RenderScene& scene_;
  const Accel& accel_;
  const FilmLayers& layers_;
  PathOptions options_;
  DirectLight direct_;
  FrameShading shading_;
  FilterSampler filter_;
};

}  // namespace pelage
