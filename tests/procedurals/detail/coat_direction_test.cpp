// SPDX-License-Identifier: Apache-2.0
#include "procedurals/detail/coat_direction.h"

#include <gtest/gtest.h>

#include "base/hash.h"
#include "base/parallel.h"
#include "image/texture_library.h"
#include "tests/groom/shapes.h"
#include "tests/groom/stacks.h"
#include "tests/support/quiet_job.h"

namespace pelage {
namespace {

/// A ball with hair that is combed one way.
class CombedBall {
 public:
  explicit CombedBall(float lift, int leaf_strands = 8000)
      : cage(shapes::ball_cage(2)), rest(shapes::surface_of(cage)), workers(2) {
    GroomParams params;
    params.skin.name = "ball";
    params.strands = 6000;
    params.points = 4;
    params.leaf_strands = leaf_strands;
    stacks::add<Length>(params.operators, {.value = Field(0.05f), .scale = Field(1.0f), .variation = 0.3f});
    stacks::add<Comb>(
        params.operators,
        {.direction = Field(Rgb(0.3f, 0, 1)), .lift = Field(lift), .amount = Field(1.0f), .curve = 0});
    groom = Groom::create("coat", params, rest, textures_, QuietJob(2, ledger_));
  }

  const ControlMesh cage;
  const std::shared_ptr<const LimitSurface> rest;
  const Workers workers;
  std::shared_ptr<const Groom> groom;

 private:
  MemoryLedger ledger_;
  TextureLibrary textures_{ledger_};
};

TEST(CoatDirection, IsHowStrandsLieInAnyPose) {
  const CombedBall ball(0.1f);
  const CoatDirection direction(*ball.groom, ball.rest, ball.workers);
  M44f turn;
  turn.rotate(V3f(0.7f, -1.2f, 2.1f));
  std::vector<V3f> positions = ball.cage.positions;
  for (V3f& p : positions) p = p * turn + V3f(3, 4, 5);
  const LimitSurface surface(ball.rest->shared_topology(), positions);
  PosedSkin pose;
  pose.keys = {&surface, 1};
  const FollicleTree& follicles = ball.groom->follicles();
  double mean = 0;
  size_t close = 0, count = 0;
  for (size_t leaf = 0; leaf < follicles.leaves().size(); ++leaf) {
    const Strands strands = ball.groom->grow(leaf, pose);
    for (size_t s = 0; s < strands.strand_count(); ++s, ++count) {
      const size_t follicle = follicles.leaves()[leaf].begin + s;
      const V3f at = direction.at(follicles.root(follicle), ball.groom->root(follicle, pose, 0));
      const uint32_t first = strands.first_point(s);
      const V3f chord =
          (strands.point(first + strands.strand_points(s) - 1) - strands.point(first)).normalized();
      EXPECT_LE(at.length(), 1.0001f);
      mean += at.dot(chord);
      close += at.dot(chord) > 0.9f;
    }
  }
  EXPECT_GT(mean / static_cast<double>(count), 0.95);
  EXPECT_GT(close, 0.93 * static_cast<double>(count));  // all but those about the two whorls of the comb
}

TEST(CoatDirection, IsContinuousAlongTheSkin) {
  const CombedBall ball(0.6f);
  const CoatDirection direction(*ball.groom, ball.rest, ball.workers);
  for (uint32_t face = 0; face < ball.rest->topology().face_count(); face += 7) {
    V3f before(0);
    for (int step = 0; step <= 1000; ++step) {
      const RootAddress root{face, static_cast<float>(step) / 1000, 0.37f};
      const V3f at = direction.at(root, ball.rest->evaluate(root.face, root.u, root.v));
      if (step > 0) {
        EXPECT_LT((at - before).length(), 0.01f) << face << " " << step;
      }
      before = at;
    }
    // And across the edge to the next face.
    const auto next = static_cast<uint32_t>(ball.rest->topology().neighbour(face, 1));
    const V3f end = ball.rest->evaluate(face, 1, 0.37f).position;
    float nearest = 1e9f;
    V3f there(0);
    for (const float t : {0.37f, 0.63f}) {
      for (const auto& [u, v] : {std::pair{0.0f, t}, {1.0f, t}, {t, 0.0f}, {t, 1.0f}}) {
        const SurfacePoint point = ball.rest->evaluate(next, u, v);
        if ((point.position - end).length() >= nearest) continue;
        nearest = (point.position - end).length();
        there = direction.at({next, u, v}, point);
      }
    }
    EXPECT_LT(nearest, 1e-5f);
    EXPECT_LT((there - before).length(), 0.01f) << face;
  }
}

TEST(CoatDirection, IsTheSameBitByBitForAnyLeaves) {
  const CombedBall whole(0.4f);
  const CoatDirection direction(*whole.groom, whole.rest, whole.workers);
  for (const int leaf_strands : {1000, 137}) {
    const CombedBall divided(0.4f, leaf_strands);
    const CoatDirection other(*divided.groom, divided.rest, divided.workers);
    for (const RootAddress& root : whole.groom->follicles().roots()) {
      const SurfacePoint point = whole.rest->evaluate(root.face, root.u, root.v);
      EXPECT_EQ(direction.at(root, point), other.at(root, point)) << leaf_strands;
    }
  }
}

}  // namespace
}  // namespace pelage
