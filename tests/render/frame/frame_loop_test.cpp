// SPDX-License-Identifier: Apache-2.0
#include "render/frame/frame_loop.h"

#include <gtest/gtest.h>

#include "base/hash.h"
#include "base/job.h"

namespace pelage {
namespace {

/// Samples of random brightness at random places in their pixels.
class RandomSamples : public SampleIntegrator {
 public:
  std::unique_ptr<SampleScratch> make_scratch() const override { return std::make_unique<SampleScratch>(); }
  void trace(int x, int y, uint32_t sample, SampleScratch& scratch) const override {
    const auto random = [&](int i) { return unit_float(hash64(x, y, sample, i)); };
    scratch.sample = {};
    scratch.sample.radiance = Rgb(random(0), random(1), random(2));
    scratch.sample.alpha = random(3);
    scratch.sample.offset = V2f(random(4) - 0.5f, random(5) - 0.5f);
  }
};

constexpr int kWidth = 40, kHeight = 35;

Film film_after(const std::vector<uint32_t>& passes, FilmLayers layers, int threads, MemoryLedger& ledger) {
  Film film(kWidth, kHeight, layers, ledger);
  const Workers workers(threads);
  NoProgress progress;
  const Stopwatch clock;
  const RandomSamples samples;
  FrameLoop loop(samples, {workers, ledger, progress}, film, frame_window(kWidth, kHeight, {}, layers.splat),
                 clock);
  for (const uint32_t count : passes) {
    EXPECT_EQ(loop.pass([count](size_t, uint32_t) { return count; }, count == 1), PassEnd::kDone);
  }
  return film;
}

TEST(FrameLoop, ThePictureDoesNotDependOnPassesAndThreads) {
  MemoryLedger ledger;
  for (const bool splatted : {false, true}) {
    FilmLayers layers;
    if (splatted) layers.splat = PixelFilter::kBlackmanHarris;
    const Film at_once = film_after({11}, layers, 1, ledger);
    const Film in_passes = film_after({1, 2, 4, 11}, layers, 3, ledger);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        ASSERT_EQ(at_once.radiance(x, y), in_passes.radiance(x, y)) << splatted << " " << x << " " << y;
        ASSERT_EQ(at_once.alpha(x, y), in_passes.alpha(x, y));
        ASSERT_EQ(at_once.samples(x, y), 11u);
      }
    }
  }
}

}  // namespace
}  // namespace pelage
