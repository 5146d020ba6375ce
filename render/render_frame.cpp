// SPDX-License-Identifier: Apache-2.0
#include "render/render_frame.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "base/error.h"
#include "base/memory_budget.h"
#include "base/stopwatch.h"
#include "render/frame/frame_geometry.h"
#include "render/frame/frame_layers.h"
#include "render/frame/frame_loop.h"
#include "render/frame/frame_saver.h"
#include "render/frame/frame_watch.h"
#include "render/frame/sample_schedule.h"
#include "render/gather/gather_loop.h"
#include "render/path/path_tracer.h"
#include "render/sampling/adaptive_rule.h"

namespace pelage {
namespace {

FilmLayers film_layers(const RenderScene& scene) {
  std::vector<FilmLayers::LightInfo> lights;
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    lights.push_back({scene.lights.light(i).name(), scene.lights.light(i).visible()});
  }
  return frame_layers(scene.image, scene.render, lights, scene.materials);
}

/// Uses the boxes of the chunks that grew for the first sample of each pixel.
class TighteningWatch final : public FrameWatch {
 public:
  TighteningWatch(FrameGeometry& geometry, const Job& job, FrameWatch& watch)
      : geometry_(geometry), job_(job), watch_(watch) {}
  void passed(const Film& film, const PassState& state) override {
    watch_.passed(film, state);
    if (state.samples <= 1) geometry_.tighten(job_);
  }
  std::optional<PixelBox> region() const override { return watch_.region(); }
  uint32_t region_version() const override { return watch_.region_version(); }

 private:
  FrameGeometry& geometry_;
  const Job& job_;
  FrameWatch& watch_;
};

/// Renders with one path after another.
TileCosts trace_paths(const RenderScene& scene, FrameGeometry& geometry, const FrameOptions& options,
                      const Job& job, const Stopwatch& clock, FrameResult& result) {
  const PathTracer tracer(scene, geometry.accel(), result.film.layers(), options.path);
  FrameLoop loop(tracer, job, result.film, result.window, clock, options.saver);
  std::optional<TighteningWatch> watch;
  if (options.watch) watch.emplace(geometry, job, *options.watch);
  const ScheduleEnd end =
      SampleSchedule(loop, scene.render, job, clock, geometry.fits(), watch ? &*watch : nullptr).run();
  if (end.partial && options.saver) options.saver->save(loop.state());
  result.partial = end.partial;
  result.time_limited = end.time_limited;
  result.samples = loop.min_samples();
  result.clamped_fraction = loop.clamped_fraction();
  result.mean_samples = loop.mean_samples();
  result.noise = frame_noise(result.film.moments());
  result.first_tile_s = loop.first_tile_s();
  loop.add_to(result.statistics);
  return loop.costs();
}

TileCosts gather(const RenderScene& scene, FrameGeometry& geometry, const FrameOptions& options,
                 GatherLoop::Memory& tiles, const Job& job, const Stopwatch& clock, FrameResult& result) {
  std::optional<TighteningWatch> watch;
  if (options.watch) watch.emplace(geometry, job, *options.watch);
  GatherLoop loop(scene, geometry.accel(), geometry.chunks(), options.path, tiles, geometry.fits(), job,
                  clock, result, watch ? &*watch : nullptr, options.saver);
  loop.run();
  return loop.costs();
}

/// Finds the balls inside skins, if the scene asks for them. Returns false when cancelled.
bool prepare_shadows(const RenderScene& scene, FrameGeometry& geometry, const Job& job, PathOptions& path,
                     FrameStatistics& statistics) try {
  if (scene.render.ball_use(scene.skins.size()) == SkinBallUse::kOff) return true;
  const Stopwatch clock;
  path.balls = &geometry.shadows(scene, job);
  statistics.stages_s["skin balls"] += clock.seconds();
  return true;
} catch (const Error& error) {
  if (error.kind() != ErrorKind::kStopped) throw;
  return false;
}

}  // namespace

void check_region(const ImageParams& image, const RenderParams& render, const PixelBox& region) {
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorKind::kArguments,
                fmt::format("region {},{},{},{}: {}", region.x0, region.y0, region.x1, region.y1, why));
  };
  const bool inside =
      region.x0 >= 0 && region.y0 >= 0 && region.x1 <= image.width && region.y1 <= image.height;
  if (region.x0 >= region.x1 || region.y0 >= region.y1)
    refuse("it has no pixels; X1 must be greater than X0, and Y1 greater than Y0");
  if (!inside) refuse(fmt::format("the picture has {} x {} pixels", image.width, image.height));
  if (render.adaptive) refuse("`adaptive` sampling needs the whole picture");
}

void check_saving(const RenderParams& render) {
  const auto refuse = [](const std::string& why) {
    throw Error(ErrorKind::kArguments, "checkpoints do not work with " + why);
  };
  if (render.adaptive)
    refuse("`adaptive` sampling, where the sample count of a pixel depends on the whole picture");
  if (render.time_limit > 0) refuse("`time_limit`, because the picture then depends on the speed of the run");
}

FrameResult render_frame(const RenderScene& scene, const Job& job, const FrameOptions& options) {
  std::unique_ptr<FrameGeometry> geometry;
  return render_frame(scene, job, options, geometry);
}

FrameResult render_frame(const RenderScene& scene, const Job& job, const FrameOptions& options,
                         std::unique_ptr<FrameGeometry>& geometry, KeptFur* kept) {
  const Stopwatch clock;
  if (options.region) check_region(scene.image, scene.render, *options.region);
  if (options.saver) check_saving(scene.render);
  const FilmLayers layers = film_layers(scene);
  job.ledger.set_limit(scene.render.memory.bytes);
  const FrameWindow window =
      frame_window(scene.image.width, scene.image.height, options.region, layers.splat);
  const int width = window.film.width(), height = window.film.height();
  require_memory(job.ledger, Film::bytes_needed(width, height, layers), "the frame buffer");
  const bool gathers = scene.render.integrator == Integrator::kGather;
  FrameResult result{Film(width, height, layers, job.ledger), window};
  GatherLoop::Memory tiles = gathers ? GatherLoop::reserve_tiles(scene, job) : GatherLoop::Memory{};
  if (!geometry) geometry = FrameGeometry::make(scene, job, result.statistics, kept);
  FrameOptions used = options;
  result.partial = !geometry || !prepare_shadows(scene, *geometry, job, used.path, result.statistics);
  if (result.partial) return result;

  const double prepared_s = clock.seconds();
  const double prepared_cpu_s = geometry->growth_cpu_s();
  const TileCosts costs = gathers ? gather(scene, *geometry, used, tiles, job, clock, result)
                                  : trace_paths(scene, *geometry, used, job, clock, result);
  result.statistics.occlusion += costs.occlusion;
  result.statistics.cpu_s += render_seconds(costs, geometry->growth_cpu_s() - prepared_cpu_s);
  geometry->add_to(result.statistics);
  result.statistics.stages_s["render"] += clock.seconds() - prepared_s;
  return result;
}

}  // namespace pelage
