// SPDX-License-Identifier: Apache-2.0
#include "render/frame/skin_shadows.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "geom/io/obj_file.h"
#include "render/accel/flush_denormals.h"
#include "render/frame/frame_geometry.h"
#include "render/sampling/sample_stream.h"
#include "render/sampling/warp.h"
#include "tests/geom/eared_skin.h"
#include "tests/procedurals/fixed.h"
#include "tests/soak.h"
#include "tests/support/data.h"
#include "tests/support/effort.h"
#include "tests/support/quiet_job.h"

namespace pelage {
namespace {

RenderScene scene_of(const SkinMesh& mesh) {
  SkinPart skin;
  skin.name = "test.skin";
  skin.skin = std::make_shared<FixedSkin>(mesh);
  return {{},
          {skin},
          {LambertParams{}},
          LightSet({}),
          Camera(CameraParams{}, 1, 100, 100),
          ImageParams{},
          RenderParams{}};
}

/// Counts of random rays from points on, above and below a skin.
struct Outcomes {
  uint64_t blocked = 0;         // by the accelerator
  uint64_t proved = 0;          // by balls
  uint64_t wrongly_proved = 0;  // by balls, but not by the accelerator
};

Outcomes shoot(const SkinMesh& mesh, uint64_t rays) {
  const RenderScene scene = scene_of(mesh);
  QuietJob job;
  FrameStatistics statistics;
  const auto geometry = FrameGeometry::make(scene, job, statistics);
  const SkinShadows shadows(scene, job);
  Box3f box;
  for (size_t v = 0; v < mesh.vertex_count(); ++v) box.extendBy(mesh.position(v));
  const float size = 0.5f * box.size().length();
  const FlushDenormals flush;
  TraceThread thread;
  HitGeometry hit_geometry;
  Outcomes outcomes;
  for (uint64_t i = 0; i < rays; ++i) {
    SampleStream stream(5, static_cast<uint32_t>(i), static_cast<uint32_t>(i >> 32), 0);
    const auto triangle =
        std::min(static_cast<size_t>(stream.next1d() * static_cast<float>(mesh.triangle_count())),
                 mesh.triangle_count() - 1);
    hit_geometry.triangle.assign_triangle(mesh, triangle);
    const V2f u = stream.next2d();
    Hit hit;
    hit.kind = HitKind::kSkin;
    hit.u = std::sqrt(u.x) * u.y;
    hit.v = std::sqrt(u.x) * (1 - u.y);
    Ray ray;
    ray.time = i % 3 == 0 ? 0.0f : stream.next1d();
    V3f corner[3];
    for (size_t c = 0; c < 3; ++c) corner[c] = position_at(hit_geometry.triangle, c, ray.time);
    const V3f normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
    // Most heights are those of fur; some points are below the skin.
    const V2f h = stream.next2d();
    const float height = (h.x < 0.1f ? -0.3f : 0.5f) * h.y * h.y * h.y * size;
    ray.origin = (1 - hit.u - hit.v) * corner[0] + hit.u * corner[1] + hit.v * corner[2] + height * normal;
    ray.direction = uniform_direction(stream.next2d());
    if (i % 4 == 0) ray.far = 4 * size * stream.next1d();
    const SkinShadow shadow = shadows.below(hit, hit_geometry, ray.time);
    const bool proved = shadow.ball.radius > 0 && shadow.blocks(ray.origin, ray.direction, ray.far);
    const bool blocked = !(geometry->accel().transmittance(ray, thread) > 0);
    outcomes.blocked += blocked;
    outcomes.proved += proved;
    outcomes.wrongly_proved += proved && !blocked;
  }
  return outcomes;
}

/// A thousandth of 10 million rays; PELAGE_SOAK=1000 sends all of them.
uint64_t ray_count() { return repetitions(10000 * soak_scale()); }

SkinMesh subdivided(const std::filesystem::path& file) {
  const LimitSurface surface = surface_of(read_obj(file));
  View view;
  view.position = surface.control_bounds().center() + V3f(0, 0, 2 * surface.control_bounds().size().length());
  view.focal_pixels = 600;
  return tessellate(std::span(&surface, 1), view, {}, Workers(2));
}

TEST(SkinShadows, NeverBlockFreeRaysOnACageWithThinEars) {
  const Outcomes still = shoot(eared_skin(), ray_count());
  EXPECT_EQ(still.wrongly_proved, 0u);
  EXPECT_GT(still.proved, still.blocked / 3);
}

TEST(SkinShadows, NeverBlockFreeRaysOnAMovingSkin) {
  const Outcomes outcomes = shoot(moving(eared_skin()), ray_count());
  EXPECT_EQ(outcomes.wrongly_proved, 0u);
  EXPECT_GT(outcomes.proved, outcomes.blocked / 10);
}

TEST(SkinShadows, ProveNothingOnAnOpenPatch) {
  const Outcomes outcomes = shoot(flat_skin(grid_cage(6, 6)), ray_count());
  EXPECT_GT(outcomes.blocked, 0u);
  EXPECT_EQ(outcomes.proved, 0u);
}

TEST(SkinShadows, NeverBlockFreeRaysOnTheRat) {
  const auto file = std::filesystem::path(PELAGE_SOURCE_DIR) / "examples/rat.obj";
  const Outcomes outcomes = shoot(subdivided(file), ray_count());
  EXPECT_EQ(outcomes.wrongly_proved, 0u);
  EXPECT_GT(outcomes.proved, outcomes.blocked / 4);
}

TEST(SkinShadows, NeverBlockFreeRaysOnSpot) {
  PELAGE_REQUIRE_DATA();
  const Outcomes outcomes = shoot(subdivided(data_folder() / "mesh/spot_control_mesh.obj"), ray_count());
  EXPECT_EQ(outcomes.wrongly_proved, 0u);
  EXPECT_GT(outcomes.proved, outcomes.blocked / 4);
}

// A ball proves exactly what the intersection with a sphere says, for lights outside the skin.
TEST(SkinShadows, AgreeWithASphere) {
  const Box3f box(V3f(-1), V3f(1));
  const SkinShadow shadow{{V3f(0), 1}, &box};
  uint64_t proved = 0;
  for (uint32_t i = 0; i < 100000; ++i) {
    SampleStream stream(3, i, 0, 0);
    const V3f origin = (1.001f + stream.next1d()) * uniform_direction(stream.next2d());
    const V3f direction = uniform_direction(stream.next2d());
    const V3d o(origin), d(direction);
    const double b = o.dot(d), c = o.length2() - 1;
    if (std::abs(b * b - c) < 1e-4) continue;
    const bool hits = b < 0 && b * b > c;
    EXPECT_EQ(shadow.blocks(origin, direction, INFINITY), hits);
    const float far = 4 * stream.next1d();
    const bool ends_inside = box.intersects(origin + far * direction);
    if (ends_inside) {
      EXPECT_FALSE(shadow.blocks(origin, direction, far));  // the light may be inside the skin
    }
    proved += hits;
  }
  EXPECT_GT(proved, 5000u);
}

}  // namespace
}  // namespace pelage
