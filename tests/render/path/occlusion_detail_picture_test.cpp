// SPDX-License-Identifier: Apache-2.0
// Pictures whose secondary rays see fewer strands from afar (DistantFur), with both integrators.
#include <cmath>

#include <gtest/gtest.h>

#include "render/render_frame.h"
#include "tests/render/film/film_picture.h"
#include "tests/render/path/skin_ball_scene.h"

namespace pelage::occlusion_detail_picture_test {
namespace {

constexpr uint32_t kStrands = 3000;
constexpr float kRadius = 0.01f;

/// One of `count` chunks of the fur ball. A `fraction` of the strands, wider by its inverse.
Strands chunk_of(uint32_t index, uint32_t count, uint32_t fraction) {
  const Strands all = furball(kStrands, 0.3f, kRadius);
  StrandArrays a;
  a.first_point = {0};
  for (uint32_t s = 0; s < kStrands; ++s) {
    if (s % count != index || hash64(s, 5) % fraction != 0) continue;
    for (uint32_t p = all.first_point(s); p < all.first_point(s) + all.strand_points(s); ++p) {
      const V3f at = all.point(p);
      a.points.insert(a.points.end(), {at.x, at.y, at.z, kRadius * static_cast<float>(fraction)});
    }
    a.first_point.push_back(a.first_point.back() + all.strand_points(s));
    a.ids.push_back(all.id(s));
  }
  return Strands(std::move(a));
}

/// Strands whose rounding does not depend on their division into chunks.
class Chunk final : public Procedural {
 public:
  explicit Chunk(Strands strands) : strands_(std::move(strands)) {}
  Box3f bound(BoundSpan span) const override { return strands_.bound(span); }
  Strands generate() const override { return strands_.generate(); }
  StrandCounts counts() const override { return strands_.counts(); }
  StrandScale scale() const override { return {2 * kRadius, V3f(0), 8 * kRadius}; }
  ChunkBounds exact_bounds(BoundSpan span, int keys) const override {
    return strands_.exact_bounds(span, keys);
  }

 private:
  FixedStrands strands_;
};

struct Scene : SkinBallScene {
  explicit Scene(Integrator integrator, uint32_t chunks = 1, bool distant = true) {
    render.integrator = integrator;
    render.skin_ball = SkinBallUse::kOff;
    auto& near = fur[0].procedurals;
    near.clear();
    for (uint32_t c = 0; c < chunks; ++c) near.push_back(std::make_unique<Chunk>(chunk_of(c, chunks, 1)));
    if (!distant) return;
    fur[0].distant.from = 0.25f;
    for (uint32_t c = 0; c < chunks; ++c)
      fur[0].distant.procedurals.push_back(std::make_unique<Chunk>(chunk_of(c, chunks, 4)));
  }
};

void expect_equal(const ExrImage& a, const ExrImage& b) {
  ASSERT_EQ(a.channels.size(), b.channels.size());
  for (size_t i = 0; i < a.channels.size(); ++i)
    EXPECT_EQ(a.channels[i].pixels, b.channels[i].pixels) << a.channels[i].name;
}

class OcclusionDetailPicture : public testing::TestWithParam<Integrator> {};

TEST_P(OcclusionDetailPicture, IsTheSameForAnyThreadsAndChunks) {
  Scene scene(GetParam());
  const FrameResult whole = scene.run({}, 1);
  EXPECT_GT(whole.statistics.trace.rays_near, 1000);
  EXPECT_GT(whole.statistics.trace.rays_far, 1000);
  const ExrImage picture = picture_of(whole.film);
  expect_equal(picture, picture_of(scene.run({}, 3).film));
  Scene divided(GetParam(), 6);
  expect_equal(picture, picture_of(divided.run({}, 2).film));
}

TEST_P(OcclusionDetailPicture, KeepsTheMean) {
  double mean[2] = {0, 0}, square[2] = {0, 0};
  constexpr int kRuns = 12;
  for (const bool distant : {false, true}) {
    Scene scene(GetParam(), 1, distant);
    scene.render.samples = 48;
    for (int run = 0; run < kRuns; ++run) {
      scene.render.seed = 2 * run + distant;
      const double of_run = luminance(picture_mean(scene.run({}, 2).film).mean);
      mean[distant] += of_run / kRuns;
      square[distant] += of_run * of_run / kRuns;
    }
  }
  const auto variance = [&](int i) { return (square[i] - mean[i] * mean[i]) / (kRuns - 1); };
  // 3.3 standard errors, a false alarm in a thousand, beside the error that the switch may have.
  const double noise = 3.3 * std::sqrt(variance(0) + variance(1));
  EXPECT_NEAR(mean[1], mean[0], noise + 0.005 * mean[0]);
  EXPECT_LT(noise, 0.02 * mean[0]) << "too noisy to show a bias";
}

INSTANTIATE_TEST_SUITE_P(Both, OcclusionDetailPicture,
                         testing::Values(Integrator::kPath, Integrator::kGather), [](const auto& test) {
                           return test.param == Integrator::kPath ? "Path" : "Gather";
                         });

}  // namespace
}  // namespace pelage::occlusion_detail_picture_test
