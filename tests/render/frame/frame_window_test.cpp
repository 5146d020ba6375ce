// SPDX-License-Identifier: Apache-2.0
#include "render/frame/frame_window.h"

#include <gtest/gtest.h>

#include "render/frame/frame_watch.h"
#include "tests/geom/random_strands.h"
#include "tests/render/path/path_scene.h"

namespace pelage {
namespace {

/// Fur under a sky, with the wide filter, on a picture whose border is not that of a tile.
struct FurScene : PathScene {
  FurScene() : PathScene(57, 43) {
    RandomStrandOptions o;
    o.strands = 300;
    o.radius = 0.03f;
    add_fur(random_strands(5, o), ConeShellParams{});
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

TEST(FrameWindow, PixelsOfARegionAreThoseOfTheWholePicture) {
  for (const FilterSamples samples : {FilterSamples::kDrawn, FilterSamples::kSplatted}) {
    FurScene scene;
    scene.image.filter_samples = samples;
    const FrameResult whole = rendered(scene, {});
    for (const PixelBox& region :
         {PixelBox{3, 5, 20, 17}, PixelBox{16, 16, 32, 32}, PixelBox{15, 31, 17, 33},
          PixelBox{40, 30, 57, 43}, PixelBox{56, 0, 57, 1}, PixelBox{0, 0, 57, 43}}) {
      FrameOptions options;
      options.region = region;
      const FrameResult part = rendered(scene, options, 3);
      EXPECT_EQ(part.samples, 5u);
      EXPECT_EQ(part.mean_samples, 5);
      expect_same(pixels(part, region), pixels(whole, region));
    }
  }
}

TEST(FrameWindow, RegionsThatDependOnOtherPixelsAreRefused) {
  FurScene scene;
  FrameOptions options;
  options.region = PixelBox{0, 0, 8, 8};
  scene.render.integrator = Integrator::kGather;
  EXPECT_THROW(rendered(scene, options), Error);
  scene.render.integrator = Integrator::kPath;
  scene.render.adaptive.emplace();
  EXPECT_THROW(rendered(scene, options), Error);
  scene.render.adaptive.reset();
  options.region = PixelBox{0, 0, 58, 43};
  EXPECT_THROW(rendered(scene, options), Error);
}

/// Counts what it sees, and checks that no sample is lost between two passes.
struct Watch final : FrameWatch {
  void passed(const Film& film, const PassState& state) override {
    EXPECT_GE(state.mean_samples, mean);
    mean = state.mean_samples;
    grids.push_back(state.grid);
    for (int y = 0; y < film.height(); y += state.grid) {
      for (int x = 0; x < film.width(); x += state.grid) EXPECT_GT(film.samples(x, y), 0u);
    }
  }
  std::vector<int> grids;
  double mean = 0;
};

TEST(FrameWatch, SeesCoarsePicturesFirstAndChangesNoPixel) {
  for (const bool adaptive : {false, true}) {
    FurScene scene;
    if (adaptive) scene.render.adaptive.emplace();
    scene.render.samples = 40;
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
}  // namespace pelage
