// SPDX-License-Identifier: Apache-2.0
#include "render/render_frame.h"

#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/check.h"
#include "base/error.h"
#include "base/memory_budget.h"
#include "base/stopwatch.h"
#include "render/frame/frame_geometry.h"
#include "render/frame/frame_layers.h"
#include "render/frame/frame_loop.h"
#include "render/frame/frame_saver.h"
#include "render/frame/frame_watch.h"
#include "render/frame/sample_passes.h"
#include "render/gather/gather_tracer.h"
#include "render/path/path_tracer.h"

namespace pelage {
namespace {

FilmLayers film_layers(const FrameScene& scene) {
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
  uint32_t pause_version() const override { return watch_.pause_version(); }
  void paused(const Film& film, const PassState& state) override { watch_.paused(film, state); }

 private:
  FrameGeometry& geometry_;
  const Job& job_;
  FrameWatch& watch_;
};

/// Shows coarse pictures of a frame to its watch, see FrameWatch.
class CoarsePictures {
 public:
  /// Reserves memory for the film, unless that would take more than a small part of the memory that is left.
  /// Call before the geometry takes the rest.
  CoarsePictures(const RenderScene& scene, const FrameScene& used, const Job& job)
      : settings_(coarse_settings(used)), scene_(scene, settings_), layers_(film_layers(scene_)) {
    constexpr int64_t kShare = 8;
    const int width = scene_.image.width, height = scene_.image.height;
    if (has_room(job.ledger, kShare * Film::bytes_needed(width, height, layers_)))
      film_.emplace(width, height, layers_, job.ledger);
  }
  /// Renders and shows the pictures, and adds their times to `statistics`. Returns false when cancelled.
  bool show(FrameGeometry& geometry, PathOptions path, const Job& job, FrameWatch& watch,
            FrameStatistics& statistics) {
    if (!film_) return true;
    const Stopwatch clock;
    const double growth_s = geometry.growth_cpu_s();
    path.balls = nullptr;
    const PathTracer tracer(scene_, geometry.accel(), film_->layers(), path);
    const FrameWindow window =
        frame_window(scene_.image.width, scene_.image.height, std::nullopt, layers_.splat);
    FrameLoop loop(tracer, job, *film_, window, clock);
    TighteningWatch tightening(geometry, job, watch);
    const bool done =
        SamplePasses(loop, scene_.render, job, clock, geometry.fits(), &tightening).run_coarse();
    loop.add_to(statistics);
    statistics.occlusion += loop.costs().occlusion;
    statistics.cpu_s += render_seconds(loop.costs(), geometry.growth_cpu_s() - growth_s);
    statistics.stages_s["coarse pictures"] += clock.seconds();
    film_.reset();
    return done;
  }

 private:
  const FrameSettings settings_;
  const FrameScene scene_;
  const FilmLayers layers_;
  std::optional<Film> film_;
};

/// The integrator of a frame, ready to trace tiles. `memory`: of the integrator `gather`. `costs` receives
/// the costs of making it.
std::unique_ptr<const TileIntegrator> make_integrator(const FrameScene& scene, const FrameGeometry& geometry,
                                                      const PathOptions& options, GatherTracer::Memory memory,
                                                      const Job& job, const Stopwatch& clock,
                                                      FrameResult& result, TileCosts& costs) {
  const FilmLayers& layers = result.film.layers();
  if (scene.render.integrator == Integrator::kPath)
    return std::make_unique<PathTracer>(scene, geometry.accel(), layers, options);
  auto gather = std::make_unique<GatherTracer>(scene, geometry.accel(), geometry.chunks(), layers, options,
                                               std::move(memory));
  costs += gather->fill_cache(job, clock, result.statistics);
  return gather;
}

/// Takes all samples of a frame. Returns what they cost.
TileCosts take_samples(const TileIntegrator& integrator, const RenderParams& render, FrameGeometry& geometry,
                       const FrameOptions& options, const Job& job, const Stopwatch& clock,
                       FrameResult& result) {
  FrameLoop loop(integrator, job, result.film, result.window, clock, options.saver);
  std::optional<TighteningWatch> watch;
  if (options.watch) watch.emplace(geometry, job, *options.watch);
  const SamplePasses::End end =
      SamplePasses(loop, render, job, clock, geometry.fits(), watch ? &*watch : nullptr).run();
  if (end.partial && options.saver) options.saver->save(loop.state());
  result.partial = end.partial;
  result.time_limited = end.time_limited;
  loop.report(result);
  return loop.costs();
}

/// Finds the balls inside skins, if the scene asks for them. Returns false when cancelled.
bool prepare_shadows(const RenderScene& contents, const FrameScene& scene, FrameGeometry& geometry,
                     const Job& job, PathOptions& path, FrameStatistics& statistics) try {
  if (scene.render.ball_use(scene.skins.size()) == SkinBallUse::kOff) return true;
  const Stopwatch clock;
  path.balls = &geometry.shadows(contents, job);
  statistics.stages_s["skin balls"] += clock.seconds();
  return true;
} catch (const Error& error) {
  if (error.kind() != ErrorKind::kStopped) throw;
  return false;
}

}  // namespace

FrameSettings coarse_settings(const FrameScene& scene) {
  FrameSettings settings{scene.image, scene.render};
  settings.render.integrator = Integrator::kPath;
  settings.render.samples = 1;
  settings.render.time_limit = 0;
  settings.render.skin_ball = SkinBallUse::kOff;  // finding them would delay the first picture
  settings.image.filter_samples = FilterSamples::kDrawn;
  return settings;
}

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
  const FrameScene used = options.settings ? FrameScene(scene, *options.settings) : FrameScene(scene);
  PELAGE_CHECK(used.image.width == scene.image.width && used.image.height == scene.image.height);
  if (options.region) check_region(used.image, used.render, *options.region);
  if (options.saver) check_saving(used.render);
  const FilmLayers layers = film_layers(used);
  job.ledger.set_limit(scene.render.memory.bytes);
  const FrameWindow window =
      frame_window(scene.image.width, scene.image.height, options.region, layers.splat);
  const int width = window.film.width(), height = window.film.height();
  require_memory(job.ledger, Film::bytes_needed(width, height, layers), "the frame buffer");
  FrameResult result{Film(width, height, layers, job.ledger), window};
  result.dual = used.render.indirect == IndirectLight::kDual;
  const MemoryCharge counts =
      reserve(job.ledger, MemoryTag::kFilm, SamplePasses::bytes_needed(used.render, int64_t{width} * height),
              "the sample counts of adaptive sampling");
  GatherTracer::Memory memory;
  if (used.render.integrator == Integrator::kGather) memory = GatherTracer::reserve(used, job);
  std::optional<CoarsePictures> coarse;
  if (used.render.integrator == Integrator::kGather && options.watch && !options.region)
    coarse.emplace(scene, used, job);
  if (!geometry) geometry = FrameGeometry::make(scene, job, result.statistics, kept);
  PathOptions path = options.path;
  result.partial = !geometry ||
                   (coarse && !coarse->show(*geometry, path, job, *options.watch, result.statistics)) ||
                   !prepare_shadows(scene, used, *geometry, job, path, result.statistics);
  if (result.partial) return result;

  const double prepared_s = clock.seconds();
  const double prepared_cpu_s = geometry->growth_cpu_s();
  TileCosts costs;
  const auto integrator =
      make_integrator(used, *geometry, path, std::move(memory), job, clock, result, costs);
  costs += take_samples(*integrator, used.render, *geometry, options, job, clock, result);
  result.statistics.occlusion += costs.occlusion;
  result.statistics.cpu_s += render_seconds(costs, geometry->growth_cpu_s() - prepared_cpu_s);
  geometry->add_to(result.statistics);
  result.statistics.stages_s["render"] += clock.seconds() - prepared_s;
  return result;
}

}  // namespace pelage
