// SPDX-License-Identifier: Apache-2.0
#include "render/camera/camera.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/hash.h"

namespace pelage {
namespace {

constexpr int kWidth = 320, kHeight = 180;

float random(uint64_t a, uint64_t b) { return unit_float(hash64(a, b, random_use("camera test"))); }

CameraParams moving_camera() {
  CameraParams params;
  params.position = Keyed<V3f>({{1.0, V3f(3, 4, 9)}, {2.0, V3f(5, 3, 8)}});
  params.look_at = Keyed<V3f>({{1.0, V3f(0, 1, 0)}, {2.0, V3f(1, 1, 0)}});
  params.fov = Keyed<float>({{1.0, 30.0f}, {2.0, 40.0f}});
  params.shutter = V2f(-0.25f, 0.5f);
  params.motion_keys = 3;
  return params;
}

TEST(Camera, ProjectUndoesRay) {
  const Camera camera(moving_camera(), 1.5, kWidth, kHeight);
  for (uint64_t i = 0; i < 300; ++i) {
    const float x = random(i, 0) * kWidth, y = random(i, 1) * kHeight, time = random(i, 2);
    const CameraRay ray = camera.ray(x, y, V2f(0.5f), time);
    const float distance = 1 + 20 * random(i, 3);
    const auto raster = camera.project(ray.origin + distance * ray.direction, time);
    ASSERT_TRUE(raster);
    EXPECT_NEAR(raster->x, x, 2e-3f);
    EXPECT_NEAR(raster->y, y, 2e-3f);
    EXPECT_NEAR(raster->z, distance * ray.direction.dot(camera.axis(time)), 1e-4f * distance);
    EXPECT_FALSE(camera.project(ray.origin - distance * ray.direction, time));
  }
}

TEST(Camera, OrthographicRaysAreParallel) {
  CameraParams params = moving_camera();
  params.orthographic = Keyed<float>({{1.0, 6.0f}, {2.0, 8.0f}});
  params.lens = LensParams{};
  const Camera camera(params, 1.5, kWidth, kHeight);
  EXPECT_FALSE(camera.has_lens());
  for (uint64_t i = 0; i < 100; ++i) {
    const float x = random(i, 0) * kWidth, y = random(i, 1) * kHeight, time = random(i, 2);
    const CameraRay ray = camera.ray(x, y, V2f(0.5f), time);
    EXPECT_EQ(ray.direction, camera.axis(time));
    const V3f at = ray.origin + (1 + 20 * random(i, 3)) * ray.direction;
    const auto raster = camera.project(at, time);
    ASSERT_TRUE(raster);
    EXPECT_NEAR(raster->x, x, 2e-3f);
    EXPECT_NEAR(raster->y, y, 2e-3f);
    EXPECT_TRUE(camera.may_see(Box3f(at, at)));
    V3f ndc;
    const V3f still = camera.ray(x, y, V2f(0.5f), camera.frame_time()).origin + 3.0f * camera.axis(0.5f);
    camera.world_to_ndc().multVecMatrix(still, ndc);
    const auto expected = camera.project_at_frame(still, 0);
    EXPECT_NEAR(ndc.x * kWidth, expected->x, 1e-2f);
    EXPECT_NEAR(ndc.y * kHeight, expected->y, 1e-2f);
  }
  // 180 pixels are 7 units high at the frame, at any distance.
  for (const float distance : {0.1f, 1e3f})
    EXPECT_NEAR(camera.view().pixels_per_unit(camera.view().position + V3f(distance, 0, 0)), 180 / 7.0f,
                1e-3f);
  EXPECT_NEAR(pixels_per_unit(camera.lod_view(), V3f(3, 2, 1)), 180 / 6.5f, 1e-3f)
      << "when the shutter opens";
  EXPECT_FALSE(camera.may_see(Box3f(V3f(100), V3f(101))));
}

TEST(Camera, AShiftMovesThePictureInItsPlane) {
  for (const bool parallel : {false, true}) {
    CameraParams params = moving_camera();
    if (parallel) params.projection = CameraProjection::kOrthographic;
    const Camera plain(params, 1.5, kWidth, kHeight);
    params.shift = V2f(0.25f, -0.5f);
    const Camera camera(params, 1.5, kWidth, kHeight);
    for (uint64_t i = 0; i < 100; ++i) {
      const float x = random(i, 0) * kWidth, y = random(i, 1) * kHeight, time = random(i, 2);
      const CameraRay ray = camera.ray(x, y, V2f(0.5f), time);
      const CameraRay same = plain.ray(x + 0.25f * kWidth, y + 0.5f * kHeight, V2f(0.5f), time);
      EXPECT_LT((ray.direction - same.direction).length(), 1e-6f);
      EXPECT_LT((ray.origin - same.origin).length(), 2e-5f);
      const V3f at = ray.origin + (1 + 20 * random(i, 3)) * ray.direction;
      const auto raster = camera.project(at, time);
      ASSERT_TRUE(raster);
      EXPECT_NEAR(raster->x, x, 2e-3f);
      EXPECT_NEAR(raster->y, y, 2e-3f);
      EXPECT_TRUE(camera.may_see(Box3f(at - V3f(1e-3f), at + V3f(1e-3f))));
      const V3f still = camera.ray(x, y, V2f(0.5f), camera.frame_time()).origin +
                        3.0f * camera.ray(x, y, V2f(0.5f), camera.frame_time()).direction;
      V3f ndc;
      camera.world_to_ndc().multVecMatrix(still, ndc);
      const auto expected = camera.project_at_frame(still, 0);
      EXPECT_NEAR(ndc.x * kWidth, expected->x, 1e-2f);
      EXPECT_NEAR(ndc.y * kHeight, expected->y, 1e-2f);
    }
    EXPECT_NEAR(camera.screen_window_center().x, 0.25f * camera.screen_window_width(), 1e-6f);
  }
  CameraParams params;  // from z = 10; half the picture is 1 high and 2 wide at distance 1
  params.fov = 90;
  params.shift = V2f(0.5f, 0);
  const Camera camera(params, 1, 200, 100);
  const auto sees = [&](float x) { return camera.may_see(Box3f(V3f(x, 0, 0), V3f(x, 0, 0))); };
  EXPECT_FALSE(sees(-0.1f));
  EXPECT_TRUE(sees(0.1f));
  EXPECT_TRUE(sees(39.9f));
  EXPECT_FALSE(sees(40.1f));
}

TEST(Camera, PhotographicKeys) {
  CameraParams params;
  params.focal_length = Keyed<float>(50.0f);
  params.sensor = 36;
  EXPECT_NEAR(params.fov_at(1, 1.5f), 2 * std::atan(12 / 50.0) * 180 / M_PI, 1e-4);
  params.f_stop = 2.0f;
  params.meters_per_unit = 0.01f;
  EXPECT_NEAR(Camera(params, 1, 300, 200).lod_view().lens_diameter, 2.5f, 1e-6f) << "25 mm in centimetres";
  EXPECT_NEAR(Camera(params, 1, 300, 200).lod_view().focus_distance, 10, 1e-5f) << "look_at";
  params.focal_length.reset();
  params.fov = static_cast<float>(2 * std::atan(12 / 50.0) * 180 / M_PI);
  EXPECT_NEAR(Camera(params, 1, 300, 200).lod_view().lens_diameter, 2.5f, 1e-5f);
  params.projection = CameraProjection::kOrthographic;
  EXPECT_NEAR(params.height_at(1, 1.5f), 10 * 24 / 50.0, 1e-5) << "what the lens shows at look_at";
  EXPECT_FALSE(Camera(params, 1, 300, 200).has_lens());
}

TEST(Camera, ProjectedLengthIsTheSumOfTheProjectedEdgesBeforeTheCamera) {
  const Camera camera(moving_camera(), 1.5, kWidth, kHeight);
  int behind = 0;
  for (uint64_t i = 0; i < 100; ++i) {
    const float time = random(i, 0);
    std::vector<float> points;
    double expected = 0;
    std::optional<V3f> from;
    for (uint64_t k = 0; k < 8; ++k) {
      const float distance = 20 * random(i, 3 * k + 1) - (i % 2 == 0 ? 4 : 0);
      const CameraRay ray =
          camera.ray(random(i, 3 * k + 2) * kWidth, random(i, 3 * k + 3) * kHeight, V2f(0.5f), time);
      const V3f p = ray.origin + distance * ray.direction;
      points.insert(points.end(), {p.x, p.y, p.z, 0.01f});
      const auto to = camera.project(p, time);
      if (to && from) expected += std::hypot(to->x - from->x, to->y - from->y);
      if (!to) ++behind;
      from = to;
    }
    EXPECT_NEAR(camera.projected_length(points, time), expected, 1e-4 * expected);
  }
  EXPECT_GT(behind, 20);
}

TEST(Camera, LooksAlongMinusZWithYDown) {
  const Camera camera(CameraParams{}, 1, kWidth, kHeight);
  const auto middle = camera.project({0, 0, 0}, 0), right = camera.project({1, 0, 0}, 0),
             above = camera.project({0, 1, 0}, 0);
  EXPECT_FLOAT_EQ(middle->x, 0.5f * kWidth);
  EXPECT_FLOAT_EQ(middle->y, 0.5f * kHeight);
  EXPECT_GT(right->x, middle->x);
  EXPECT_LT(above->y, middle->y);
  // Half the vertical field of view reaches the upper edge.
  EXPECT_NEAR(camera.project({0, 10 * std::tan(20 * 3.14159265f / 180), 0}, 0)->y, 0.0f, 1e-3f);
}

TEST(Camera, LensRaysMeetInThePlaneOfFocus) {
  CameraParams params = moving_camera();
  params.lens = LensParams{2.0f, 0.5f, 7.0f};
  const Camera camera(params, 1.5, kWidth, kHeight);
  CameraParams pinhole_params = params;
  pinhole_params.lens.reset();
  const Camera pinhole(pinhole_params, 1.5, kWidth, kHeight);
  float widest = 0;
  for (uint64_t i = 0; i < 300; ++i) {
    const float x = random(i, 0) * kWidth, y = random(i, 1) * kHeight, time = random(i, 2);
    const CameraRay ray = camera.ray(x, y, V2f(random(i, 4), random(i, 5)), time);
    const float along = ray.direction.dot(camera.axis(time));
    const V3f focus = ray.origin + (7.0f / along) * ray.direction;
    const auto raster = pinhole.project(focus, time);
    EXPECT_NEAR(raster->x, x, 3e-3f);
    EXPECT_NEAR(raster->y, y, 3e-3f);
    EXPECT_NEAR((ray.origin - camera.position(time)).dot(camera.axis(time)), 0, 1e-5f);
    widest = std::max(widest, (ray.origin - camera.position(time)).length());
  }
  EXPECT_LE(widest, 0.125f + 1e-5f);  // focal length / (2 f-stop)
  EXPECT_GT(widest, 0.115f);
}

TEST(Camera, MovesOverTheShutterAsItsKeysSay) {
  const Camera camera(moving_camera(), 1.5, kWidth, kHeight);
  const CameraParams params = moving_camera();
  for (float time : {0.0f, 0.5f, 1.0f}) {
    EXPECT_LT((camera.position(time) - params.position.at(1.25 + 0.75 * double{time})).length(), 1e-5f);
  }
  EXPECT_FLOAT_EQ(camera.frame_time(), 1.0f / 3);
  EXPECT_FLOAT_EQ(camera.shutter_frames(), 0.75f);
  EXPECT_LT((camera.view().position - params.position.at(1.5)).length(), 1e-6f);
}

// What decides about detail: both ends of the shutter, and the lens.
TEST(Camera, DetailKnowsItsShutterAndLens) {
  CameraParams params;
  params.position = Keyed<V3f>({{0, V3f(0, 0, 10)}, {1, V3f(8, 0, 10)}});
  params.look_at = Keyed<V3f>({{0, V3f(0)}, {1, V3f(8, 0, 0)}});
  params.fov = Keyed<float>(60);
  params.shutter = V2f(-0.25f, 0.25f);
  params.lens = LensParams{2, 5, 7};
  const LodView view = Camera(params, 0.5, 200, 100).lod_view();
  EXPECT_NEAR(view.open.position.x, 2, 1e-5);
  EXPECT_NEAR(view.close.position.x, 6, 1e-5);
  EXPECT_NEAR(view.open.focal_pixels, 50 / std::tan(0.5235988f), 1e-3);
  EXPECT_NEAR(view.lens_diameter, 2.5f, 1e-6);  // focal length over f-stop
  EXPECT_NEAR(view.focus_distance, 7, 1e-6);
  params.lens.reset();
  EXPECT_EQ(Camera(params, 0.5, 200, 100).lod_view().lens_diameter, 0);
}

TEST(Camera, HeaderMatricesAgreeWithProjection) {
  const Camera camera(moving_camera(), 1.5, kWidth, kHeight);
  for (uint64_t i = 0; i < 100; ++i) {
    const V3f p(2 * random(i, 6) - 1, 2 * random(i, 7) - 1, 2 * random(i, 8) - 1);
    const auto raster = camera.project_at_frame(p, 0);
    V3f ndc, local;
    camera.world_to_ndc().multVecMatrix(p, ndc);  // divides by w
    camera.world_to_camera().multVecMatrix(p, local);
    // The picture shows this width at distance 1.
    EXPECT_NEAR(local.x / local.z, (ndc.x - 0.5f) * camera.screen_window_width(), 1e-4f);
    EXPECT_NEAR(ndc.x * kWidth, raster->x, 1e-2f);
    EXPECT_NEAR(ndc.y * kHeight, raster->y, 1e-2f);
    EXPECT_NEAR(local.z, raster->z, 1e-4f);
    EXPECT_EQ(local.x > 0, raster->x > 0.5f * kWidth);
    EXPECT_EQ(local.y > 0, raster->y < 0.5f * kHeight);
  }
}

TEST(Camera, ImpossiblePosesAreErrors) {
  CameraParams on_target;
  on_target.look_at = on_target.position;
  EXPECT_THROW(Camera(on_target, 1, kWidth, kHeight), Error);
  CameraParams upward;
  upward.look_at = V3f(0, 5, 10);
  EXPECT_THROW(Camera(upward, 1, kWidth, kHeight), Error);
}

TEST(Camera, SeesBoxesThatMeetThePicture) {
  CameraParams params;
  params.position = V3f(0, 0, 10);
  params.fov = 90;
  const Camera camera(params, 1, 200, 100);  // as high as far, twice as wide
  const auto box = [](const V3f& at) { return Box3f(at - V3f(1), at + V3f(1)); };
  EXPECT_TRUE(camera.may_see(box(V3f(0, 0, 0))));
  EXPECT_TRUE(camera.may_see(box(V3f(20, 0, 0))));
  EXPECT_FALSE(camera.may_see(box(V3f(23.5f, 0, 0))));
  EXPECT_FALSE(camera.may_see(box(V3f(-23.5f, 0, 0))));
  EXPECT_FALSE(camera.may_see(box(V3f(0, 13, 0))));
  EXPECT_FALSE(camera.may_see(box(V3f(0, -13, 0))));
  EXPECT_FALSE(camera.may_see(box(V3f(0, 0, 12))));
  EXPECT_TRUE(camera.may_see(box(V3f(0, 0, 10))));  // it stands in it
  EXPECT_TRUE(camera.may_see(Box3f(V3f(-1000), V3f(1000))));
  EXPECT_FALSE(camera.may_see(Box3f()));
}

// What any ray passes, it may see; what no ray of a lens this wide comes to, it does not.
TEST(Camera, SeesThroughAllOfTheLens) {
  CameraParams params;
  params.position = V3f(0, 0, 10);
  params.fov = 90;
  LensParams lens;
  lens.focal_length = 4;
  lens.f_stop = 1;  // a radius of 2
  lens.focus_distance = 10;
  params.lens = lens;
  const Camera camera(params, 1, 200, 100);
  const auto point = [](const V3f& at) { return Box3f(at, at); };
  int beyond = 0;
  params.lens.reset();
  const Camera pinhole(params, 1, 200, 100);
  for (uint64_t i = 0; i < 20000; ++i) {
    const auto number = [&](uint64_t k) { return unit_float(hash64(i, k, random_use("lens test"))); };
    // Often at a border of the picture, through the edge of the lens.
    const float x = i % 3 == 0 ? 200 * number(0) : i % 3 == 1 ? 0.0f : 200.0f;
    const CameraRay ray = camera.ray(x, 100 * number(1), {i % 2 == 0 ? 0.999f : number(2), number(3)}, 0);
    const V3f at = ray.origin + 40 * number(4) * ray.direction;
    const V3f inward = 1e-4f * (V3f(0, 0, at.z) - at);  // rounding
    EXPECT_TRUE(camera.may_see(point(at + inward))) << i;
    beyond += !pinhole.may_see(point(at + inward));
  }
  EXPECT_GT(beyond, 1000);
  EXPECT_FALSE(camera.may_see(point(V3f(20.1f, 0, 0))));  // in focus
  EXPECT_TRUE(camera.may_see(point(V3f(10.9f, 0, 5))));   // half as far: blurred by half the radius
  EXPECT_FALSE(camera.may_see(point(V3f(11.1f, 0, 5))));
  EXPECT_TRUE(camera.may_see(point(V3f(41.9f, 0, -10))));  // twice as far: by all of it
  EXPECT_FALSE(camera.may_see(point(V3f(42.1f, 0, -10))));
  EXPECT_FALSE(camera.may_see(point(V3f(0, 0, 11))));
}

TEST(Camera, SeesWhatItPassesWhileTheShutterIsOpen) {
  CameraParams params;
  params.position = Keyed<V3f>({{1.0, V3f(0, 0, 10)}, {2.0, V3f(100, 0, 10)}});
  params.look_at = Keyed<V3f>({{1.0, V3f(0)}, {2.0, V3f(100, 0, 0)}});
  const Box3f there(V3f(24, -1, -1), V3f(26, 1, 1));  // between the keys
  EXPECT_FALSE(Camera(params, 1, 100, 100).may_see(there));
  params.shutter = V2f(0, 0.5f);
  EXPECT_TRUE(Camera(params, 1, 100, 100).may_see(there));
}

}  // namespace
}  // namespace pelage
