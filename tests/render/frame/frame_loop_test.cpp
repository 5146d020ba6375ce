// SPDX-License-Identifier: Apache-2.0
#include "render/frame/frame_loop.h"

#include <algorithm>
#include <atomic>
#include <numeric>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "base/job.h"

namespace pelage::frame_loop_test {
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

using Bytes = std::vector<std::vector<std::byte>>;

/// Asks for the state at random moments, keeps it, and cancels the job after some of these.
class RandomMoments final : public FrameSaver, public Progress {
 public:
  /// `saves_left`: cancels after this count of saves; negative: never.
  RandomMoments(uint64_t seed, int saves_left, Bytes kept = {})
      : seed_(seed), saves_left_(saves_left), kept_(std::move(kept)) {
    draw();
  }
  bool due() const override { return calls_.fetch_sub(1) <= 0; }
  void save(const FrameState& state) override {
    kept_.clear();
    for (const auto& block : state) kept_.emplace_back(block.begin(), block.end());
    ++saves_;
    if (--saves_left_ == 0) cancelled_ = true;
    draw();
  }
  bool restore(const FrameState& state) override {
    for (size_t i = 0; i < kept_.size(); ++i) std::copy(kept_[i].begin(), kept_[i].end(), state[i].begin());
    return !kept_.empty();
  }
  void begin(std::string_view, double) override {}
  void advance(double) override {}
  void end() override {}
  bool cancelled() const override { return cancelled_; }

  const Bytes& kept() const { return kept_; }
  int saves() const { return saves_; }

 private:
  // More calls than there are tiles, so that each save has new samples.
  void draw() { calls_ = 20 + static_cast<int>(hash64(seed_, saves_) % 300); }

  uint64_t seed_;
  int saves_ = 0, saves_left_;
  Bytes kept_;
  mutable std::atomic<int> calls_{0};
  std::atomic<bool> cancelled_{false};
};

Film film_after(const std::vector<uint32_t>& passes, FilmLayers layers, int threads, MemoryLedger& ledger) {
  Film film(kWidth, kHeight, layers, ledger);
  const Workers workers(threads);
  NoProgress progress;
  const Stopwatch clock;
  const RandomSamples samples;
  FrameLoop loop(samples, {workers, ledger, progress}, film, frame_window(kWidth, kHeight, {}, layers.splat),
                 clock);
  for (const uint32_t count : passes) {
    EXPECT_EQ(loop.pass({[count](size_t) { return count; }, {}, count == 1}), PassEnd::kDone);
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

/// The samples of the left half take 20 us more.
class SlowLeft final : public RandomSamples {
 public:
  void trace(int x, int y, uint32_t sample, SampleScratch& scratch) const override {
    RandomSamples::trace(x, y, sample, scratch);
    const Stopwatch clock;
    while (x < kWidth / 2 && clock.seconds() < 20e-6) {
    }
  }
};

/// Adds up the progress of tiles, one after the other.
class TileProgress final : public Progress {
 public:
  void begin(std::string_view, double) override {}
  void advance(double amount) override { amounts.push_back(amount); }
  void end() override {}
  bool cancelled() const override { return false; }
  std::vector<double> amounts;
};

TEST(FrameLoop, ProgressCountsTilesByWhatTheirSamplesCost) {
  MemoryLedger ledger;
  Film film(kWidth, kHeight, {}, ledger);
  const Workers workers(1);
  TileProgress progress;
  const Stopwatch clock;
  const SlowLeft samples;
  FrameLoop loop(samples, {workers, ledger, progress}, film, frame_window(kWidth, kHeight, {}, {}), clock);
  const auto pass = [&](uint32_t count) {
    progress.amounts.clear();
    loop.pass({[=](size_t) { return count; }, {}});
    return std::accumulate(progress.amounts.begin(), progress.amounts.end(), 0.0);
  };
  EXPECT_EQ(pass(1), kWidth * kHeight);
  EXPECT_EQ(*std::max_element(progress.amounts.begin(), progress.amounts.end()), 256);
  EXPECT_NEAR(pass(3), 2 * kWidth * kHeight, 1e-6) << "the same sum";
  // The two whole tiles on the left count more than the others, whatever else the machine does.
  std::sort(progress.amounts.begin(), progress.amounts.end());
  EXPECT_GT(progress.amounts.back(), 2 * 256);
}

TEST(FrameLoop, AStateSavedAtAnyMomentLeadsToTheSameFilm) {
  MemoryLedger ledger;
  for (const bool splatted : {false, true}) {
    FilmLayers layers;
    layers.noise = !splatted;
    if (splatted) layers.splat = PixelFilter::kBlackmanHarris;
    Film whole = film_after({11}, layers, 1, ledger);
    int saves = 0;
    for (uint64_t seed = 0; seed < 12; ++seed) {
      const int threads = 1 + static_cast<int>(seed % 3);
      // Each run begins with the state that the last run saved before it was cancelled.
      Bytes kept;
      PassEnd end = PassEnd::kCancelled;
      for (uint64_t run = 0; end != PassEnd::kDone; ++run) {
        Film film(kWidth, kHeight, layers, ledger);
        const Workers workers(threads);
        RandomMoments moments(hash64(seed, run), run < 5 ? 2 : -1, kept);
        const Stopwatch clock;
        const RandomSamples samples;
        FrameLoop loop(samples, {workers, ledger, moments}, film,
                       frame_window(kWidth, kHeight, {}, layers.splat), clock, &moments);
        for (const uint32_t count : {1u, 3u, 11u}) {
          end = loop.pass({[count](size_t) { return count; }, {}, count == 1});
          if (end != PassEnd::kDone) break;
        }
        kept = moments.kept();
        saves += moments.saves();
        if (end != PassEnd::kDone) continue;
        const FrameState wanted = whole.state(), got = film.state();
        for (size_t i = 0; i < wanted.size(); ++i)
          ASSERT_TRUE(std::equal(wanted[i].begin(), wanted[i].end(), got[i].begin()))
              << splatted << seed << i;
      }
    }
    EXPECT_GT(saves, 60);
  }
}

}  // namespace
}  // namespace pelage::frame_loop_test
