// SPDX-License-Identifier: Apache-2.0
#include "render/frame/frame_window.h"

#include <algorithm>
#include <atomic>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "render/frame/frame_watch.h"
#include "tests/geom/random_strands.h"
#include "tests/render/path/skin_ball_scene.h"
#include "tests/support/effort.h"

namespace pelage::frame_window_test {
namespace {

/// Fur under a sky, with the wide filter, on a picture whose size is no multiple of a tile.
struct FurScene : PathScene {
  FurScene() : PathScene(57, 43) {
    RandomStrandOptions o;
    o.strands = 300;
    o.radius = 0.03f;
    ConeShellParams fibre;
    fibre.diffuse = 0.4f;  // given, so that no colour must be matched before every render
    add_fur(random_strands(5, o), fibre);
    add_sky(Rgb(0.4f));
    camera.fov = 20.0f;
    image.filter = PixelFilter::kBlackmanHarris;
    image.lod_layer = image.noise_layers = true;
    render.samples = 5;
    render.bounces = 1;
  }
};

FrameResult rendered(FurScene& scene, const FrameOptions& options, int threads = 2) {
  NoProgress progress;
  return scene.run_frame(options, threads, progress);
}

/// All channels of a box of the picture.
std::vector<ExrChannel> pixels(const FrameResult& result, const PixelBox& box) {
  const int x = result.window.film.x0, y = result.window.film.y0;
  return result.film.exr_pixels({box.x0 - x, box.y0 - y, box.x1 - x, box.y1 - y});
}

void expect_same(const std::vector<ExrChannel>& a, const std::vector<ExrChannel>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].pixels, b[i].pixels) << a[i].name;
    EXPECT_EQ(a[i].ids, b[i].ids) << a[i].name;
  }
}

TEST(FrameWindow, ContainsTheApronInWholeTiles) {
  const PixelBox region{17, 16, 32, 40};
  const FrameWindow drawn = frame_window(100, 50, region, {});
  EXPECT_EQ(drawn.traced, region);
  EXPECT_EQ(drawn.film, (PixelBox{16, 16, 32, 48}));
  const FrameWindow splatted = frame_window(100, 50, region, PixelFilter::kBlackmanHarris);
  EXPECT_EQ(splatted.traced, (PixelBox{16, 15, 33, 41}));
  EXPECT_EQ(splatted.film, (PixelBox{16, 0, 48, 48}));
  const FrameWindow corner = frame_window(100, 50, PixelBox{99, 49, 100, 50}, PixelFilter::kBlackmanHarris);
  EXPECT_EQ(corner.traced, (PixelBox{98, 48, 100, 50}));
  EXPECT_EQ(corner.film, (PixelBox{96, 48, 100, 50}));
  EXPECT_EQ(frame_window(9, 8, {}, {}).film, (PixelBox{0, 0, 9, 8}));
}

/// Integrators and kinds of samples; with a sanitizer, each of both once.
std::vector<std::pair<Integrator, FilterSamples>> kinds_of_renders() {
  std::vector<std::pair<Integrator, FilterSamples>> kinds = {{Integrator::kPath, FilterSamples::kSplatted},
                                                             {Integrator::kGather, FilterSamples::kDrawn}};
  if (!kSanitized) {
    kinds.emplace_back(Integrator::kPath, FilterSamples::kDrawn);
    kinds.emplace_back(Integrator::kGather, FilterSamples::kSplatted);
  }
  return kinds;
}

TEST(FrameWindow, PixelsOfARegionAreThoseOfTheWholePicture) {
  std::vector<PixelBox> regions = {{3, 5, 20, 17}, {15, 31, 17, 33}, {56, 0, 57, 1}};
  if (!kSanitized) {
    for (const PixelBox& more : {PixelBox{16, 16, 32, 32}, PixelBox{40, 30, 57, 43}, PixelBox{0, 0, 57, 43}})
      regions.push_back(more);
  }
  for (const auto& [integrator, samples] : kinds_of_renders()) {
    FurScene scene;
    scene.render.integrator = integrator;
    scene.image.filter_samples = samples;
    scene.image.noise_layers = integrator == Integrator::kPath;
    scene.render.samples = 2;
    const FrameResult whole = rendered(scene, {});
    for (const PixelBox& region : regions) {
      FrameOptions options;
      options.region = region;
      const FrameResult part = rendered(scene, options, 3);
      EXPECT_EQ(part.samples, whole.samples);
      EXPECT_EQ(part.mean_samples, whole.mean_samples);
      expect_same(pixels(part, region), pixels(whole, region));
    }
  }
}

TEST(FrameOptions, SettingsReplaceThoseOfTheScene) {
  for (const Integrator integrator : {Integrator::kPath, Integrator::kGather}) {
    FurScene scene;
    scene.render.integrator = integrator;
    scene.image.noise_layers = false;
    const FrameResult wanted = rendered(scene, {});
    FrameOptions options;
    options.settings = {scene.image, scene.render};
    // Whatever concerns only samples may differ.
    scene.render.integrator = integrator == Integrator::kPath ? Integrator::kGather : Integrator::kPath;
    scene.render.samples = 2;
    scene.render.bounces = 0;
    scene.render.seed = 9;
    scene.render.skin_ball = SkinBallUse::kExact;
    scene.render.clamp_indirect = 0.01f;
    scene.image.filter = PixelFilter::kBox;
    scene.image.filter_samples = FilterSamples::kSplatted;
    scene.image.light_layers = scene.image.lod_layer = false;
    const FrameResult replaced = rendered(scene, options);
    EXPECT_EQ(replaced.samples, 5u);
    expect_same(pixels(replaced, replaced.window.region), pixels(wanted, wanted.window.region));
  }
}

TEST(FrameWindow, RegionsThatDependOnOtherPixelsAreRefused) {
  FurScene scene;
  FrameOptions options;
  options.region = PixelBox{0, 0, 8, 8};
  scene.render.adaptive.emplace();
  EXPECT_THROW(rendered(scene, options), Error);
  scene.render.adaptive.reset();
  options.region = PixelBox{0, 0, 58, 43};
  EXPECT_THROW(rendered(scene, options), Error);
}

/// Records the passes, and checks that no sample is lost between two of them.
struct Watch final : FrameWatch {
  void passed(const Film& film, const PassState& state) override {
    if (state.coarse != std::exchange(coarse, state.coarse)) mean = 0;
    EXPECT_GE(state.mean_samples, mean);
    mean = state.mean_samples;
    grids.push_back(state.grid);
    for (int y = 0; y < film.height(); y += state.grid) {
      for (int x = 0; x < film.width(); x += state.grid) EXPECT_GT(film.samples(x, y), 0u);
    }
  }
  std::optional<PixelBox> region() const override { return {}; }
  uint32_t region_version() const override { return 0; }
  std::vector<int> grids;
  double mean = 0;
  bool coarse = false;
};

TEST(FrameWatch, SeesCoarsePicturesFirstAndChangesNoPixel) {
  for (const bool adaptive : {false, true}) {
    FurScene scene;
    if (adaptive) scene.render.adaptive.emplace();
    scene.render.samples = 20;
    const FrameResult alone = rendered(scene, {});
    Watch watch;
    FrameOptions options;
    options.watch = &watch;
    const FrameResult watched = rendered(scene, options, 3);
    ASSERT_GE(watch.grids.size(), 5u);
    EXPECT_EQ(std::vector<int>(watch.grids.begin(), watch.grids.begin() + 4), (std::vector<int>{8, 4, 2, 1}));
    expect_same(pixels(watched, watched.window.region), pixels(alone, alone.window.region));
  }
}

/// Asks for a pause whenever it was paused, and while a region is refined.
struct PausingWatch final : FrameWatch {
  void passed(const Film&, const PassState& state) override {
    if (state.coarse != std::exchange(coarse, state.coarse)) mean = 0;
    EXPECT_GE(state.mean_samples, mean);
    mean = state.mean_samples;
  }
  std::optional<PixelBox> region() const override { return PixelBox{3, 20, 15, 30}; }
  uint32_t region_version() const override { return 1; }
  uint32_t pause_version() const override { return version; }
  void paused(const Film& film, const PassState& state) override {
    if (state.coarse != std::exchange(coarse, state.coarse)) mean = 0;
    EXPECT_GE(state.mean_samples, mean);
    for (int y = 0; state.grid > 0 && y < film.height(); y += state.grid) {
      for (int x = 0; x < film.width(); x += state.grid) EXPECT_GT(film.samples(x, y), 0u);
    }
    if (version < 30) ++version;
  }
  std::atomic<uint32_t> version{1};
  double mean = 0;
  bool coarse = false;
};

TEST(FrameWatch, APauseChangesNoPixel) {
  for (const auto& [integrator, samples] : kinds_of_renders()) {
    FurScene scene;
    scene.render.integrator = integrator;
    scene.render.samples = 20;
    scene.image.noise_layers = false;
    scene.image.filter_samples = samples;
    const FrameResult alone = rendered(scene, {});
    PausingWatch watch;
    FrameOptions options;
    options.watch = &watch;
    const FrameResult watched = rendered(scene, options, 3);
    EXPECT_GT(watch.version, 3u);
    EXPECT_EQ(watched.mean_samples, 20);
    expect_same(pixels(watched, watched.window.region), pixels(alone, alone.window.region));
  }
}

TEST(FrameWatch, SeesThePassesOfGatherAndChangesNoPixel) {
  FurScene scene;
  scene.render.integrator = Integrator::kGather;
  scene.image.noise_layers = false;
  const FrameResult alone = rendered(scene, {});
  Watch watch;
  FrameOptions options;
  options.watch = &watch;
  const FrameResult watched = rendered(scene, options, 3);
  EXPECT_EQ(watch.grids, (std::vector<int>{8, 4, 2, 1, 1}));  // coarse pictures, then 1 and 4 samples
  EXPECT_EQ(watch.mean, 5);
  expect_same(pixels(watched, watched.window.region), pixels(alone, alone.window.region));
}

/// Records pictures and the stages of the work, in the order of their begin.
struct RecordingProgress final : NoProgress {
  void begin(std::string_view stage, double) override { events.emplace_back(stage); }
  std::vector<std::string> events;
};
struct RecordingWatch final : FrameWatch {
  explicit RecordingWatch(std::vector<std::string>& all) : events(all) {}
  void passed(const Film&, const PassState& state) override {
    events.emplace_back(state.coarse ? "coarse picture" : "picture");
  }
  std::optional<PixelBox> region() const override { return {}; }
  uint32_t region_version() const override { return 0; }
  std::vector<std::string>& events;
};

TEST(FrameWatch, SeesCoarsePicturesBeforeGatherPrepares) {
  SkinBallScene scene;
  scene.render.integrator = Integrator::kGather;
  scene.render.skin_ball = SkinBallUse::kExact;
  scene.render.bounces = 4;
  scene.render.samples = 2;
  NoProgress none;
  const FrameResult alone = scene.run_frame({}, 2, none);
  RecordingProgress progress;
  RecordingWatch watch(progress.events);
  FrameOptions options;
  options.watch = &watch;
  const FrameResult watched = scene.run_frame(options, 1, progress);
  const auto first = [&](const std::string& event) {
    return std::find(progress.events.begin(), progress.events.end(), event) - progress.events.begin();
  };
  EXPECT_EQ(std::count(progress.events.begin(), progress.events.end(), "coarse picture"), 3);
  EXPECT_LT(first("coarse picture"), first("reflection cache"));
  EXPECT_LT(first("reflection cache"), first("picture"));
  EXPECT_GT(watched.statistics.stages_s.count("coarse pictures"), 0u);
  expect_same(pixels(watched, watched.window.region), pixels(alone, alone.window.region));
}

/// Chooses a region during the render, and another one later.
struct RegionWatch final : FrameWatch {
  void passed(const Film& film, const PassState& state) override {
    bool has_all = true, others_lack = false;
    for (int y = 0; y < film.height(); ++y) {
      for (int x = 0; x < film.width(); ++x) {
        const PixelBox& box = boxes[1];
        const bool inside = x >= box.x0 && x < box.x1 && y >= box.y0 && y < box.y1;
        if (inside) has_all = has_all && film.samples(x, y) == 40;
        if (!inside) others_lack = others_lack || film.samples(x, y) < 40;
      }
    }
    if (has_all && others_lack) {
      refined_first = true;
      EXPECT_EQ(state.full, boxes[1]);
    }
    if (state.grid <= 4 && version < 2) ++version;
  }
  std::optional<PixelBox> region() const override {
    return version == 0 ? std::nullopt : std::optional(boxes[version - 1]);
  }
  uint32_t region_version() const override { return version; }

  const PixelBox boxes[2] = {{50, 0, 57, 9}, {3, 20, 21, 40}};
  std::atomic<uint32_t> version{0};
  bool refined_first = false;
};

TEST(FrameWatch, RefinesARegionFirstAndChangesNoPixel) {
  for (const char* kind : {"uniform", "adaptive", "splatted"}) {
    FurScene scene;
    scene.render.samples = 40;
    if (kind == std::string("adaptive")) scene.render.adaptive.emplace();
    if (kind == std::string("splatted")) scene.image.filter_samples = FilterSamples::kSplatted;
    const FrameResult alone = rendered(scene, {});
    RegionWatch watch;
    FrameOptions options;
    options.watch = &watch;
    const FrameResult watched = rendered(scene, options, 3);
    EXPECT_EQ(watch.refined_first, kind != std::string("adaptive")) << kind;
    EXPECT_EQ(watched.mean_samples, alone.mean_samples) << kind;
    expect_same(pixels(watched, watched.window.region), pixels(alone, alone.window.region));
  }
}

/// Chooses a region after the first pass, and another one after the second.
struct GatherRegionWatch final : FrameWatch {
  void passed(const Film& film, const PassState& state) override {
    if (state.coarse) return;
    const PixelBox& box = boxes[version == 0 ? 0 : version - 1];
    const uint32_t inside = film.samples(box.x0, box.y0);
    const uint32_t outside = film.samples(56, 42);
    if (version > 0 && inside == 100 && outside == 1) {
      ++refined;
      EXPECT_EQ(state.full, box);
      EXPECT_LT(state.mean_samples, 100);
      EXPECT_EQ(state.samples, 1u);
      for (int y = box.y0; y < box.y1; ++y) {
        for (int x = box.x0; x < box.x1; ++x) EXPECT_EQ(film.samples(x, y), 100u);
      }
    }
    if (version == 0 || (version == 1 && inside == 100)) ++version;
  }
  std::optional<PixelBox> region() const override {
    return version == 0 ? std::nullopt : std::optional(boxes[version - 1]);
  }
  uint32_t region_version() const override { return version; }

  const PixelBox boxes[2] = {{3, 20, 15, 30}, {30, 2, 33, 9}};
  std::atomic<uint32_t> version{0};
  int refined = 0;
};

TEST(FrameWatch, GatherRefinesTheTilesOfARegionFirst) {
  FurScene scene;
  scene.render.integrator = Integrator::kGather;
  scene.render.samples = 100;
  scene.image.noise_layers = false;
  const FrameResult alone = rendered(scene, {});
  GatherRegionWatch watch;
  FrameOptions options;
  options.watch = &watch;
  const FrameResult watched = rendered(scene, options, 3);
  EXPECT_EQ(watch.refined, 2);
  EXPECT_EQ(watched.mean_samples, 100);
  expect_same(pixels(watched, watched.window.region), pixels(alone, alone.window.region));
}

TEST(FrameWatch, DoesNotChangeTheOrderOfSplattedSamples) {
  FurScene scene;
  scene.image.filter_samples = FilterSamples::kSplatted;
  const FrameResult alone = rendered(scene, {});
  Watch watch;
  FrameOptions options;
  options.watch = &watch;
  const FrameResult watched = rendered(scene, options);
  EXPECT_EQ(watch.grids, (std::vector<int>{1, 1, 1, 1}));  // 1, 1, 2 and 1 samples
  expect_same(pixels(watched, watched.window.region), pixels(alone, alone.window.region));
}

}  // namespace
}  // namespace pelage::frame_window_test
