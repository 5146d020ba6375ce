// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "render/film/film_sums.h"
#include "render/sampling/pixel_moments.h"
#include "tests/render/path/path_scene.h"

namespace pelage {
namespace {

constexpr int kWallWidth = 48, kWallHeight = 64, kPictures = 2;

/// A wall of overlapping strands that hang down, as in the coat of a penguin: each is shaded at its root by
/// those above, and bright at its tip. The pixels are a unit large.
Strands hanging() {
  StrandArrays a;
  a.first_point = {0};
  for (uint32_t i = 0; i < 2500; ++i) {
    SampleStream stream(3, i, 0, 0);
    const V2f at = stream.next2d(), lean = stream.next2d();
    const V3f root((at.x - 0.5f) * 1.3f * kWallWidth, (at.y - 0.5f) * 1.5f * kWallHeight, 0);
    const V3f along(2 * (lean.x - 0.5f), -14, 3 + lean.y);
    for (const float v : {0.0f, 0.5f, 1.0f}) {
      const V3f p = root + v * along;
      a.points.insert(a.points.end(), {p.x, p.y, p.z, 0.5f});
    }
    a.first_point.push_back(3 * (i + 1));
    a.ids.push_back(i);
  }
  return Strands(std::move(a));
}

/// Means of the luminance of each row of pixels.
std::vector<double> row_means(PathScene& scene, int64_t first_seed) {
  std::vector<double> rows(kWallHeight);
  for (int seed = 0; seed < kPictures; ++seed) {
    scene.render.seed = first_seed + seed;
    const FrameResult result = scene.run();
    for (int y = 0; y < kWallHeight; ++y) {
      for (int x = 0; x < kWallWidth; ++x)
        rows[static_cast<size_t>(y)] += luminance(result.film.radiance(x, y)) / (kWallWidth * kPictures);
    }
  }
  return rows;
}

/// A gather point at the border of a tile shares light only among the points on one side. Without
/// DepthProfile, the last rows of tiles are 12 % too dark here, and the first ones 11 % too bright (8 % each
/// with bounces).
TEST(GatherBorders, RowsOfPixelsAtTheBordersOfTilesAreAsBrightAsWithPaths) {
  PathScene scene(kWallWidth, kWallHeight);
  scene.camera.position = V3f(0, 0, 3000);
  scene.camera.fov = 2 * std::atan(0.5f * kWallHeight / 3000) * 57.29578f;
  scene.add_fur(hanging(), diffuse_fibre(Rgb(0.6f)));
  scene.add_sky(Rgb(1));
  scene.render.samples = 32;
  for (const int bounces : {0, 2}) {
    scene.render.bounces = bounces;
    scene.render.integrator = Integrator::kPath;
    const std::vector<double> paths = row_means(scene, 100);
    scene.render.integrator = Integrator::kGather;
    const std::vector<double> gather = row_means(scene, 0);
    PixelMoments last, first, others;
    for (int y = 1; y + 1 < kWallHeight; ++y) {
      const int in_tile = y % FilmSums::kTileSide;
      const double off = gather[static_cast<size_t>(y)] / paths[static_cast<size_t>(y)] - 1;
      (in_tile == 0 ? first : in_tile == FilmSums::kTileSide - 1 ? last : others).add(off);
    }
    EXPECT_LT(std::abs(first.mean - others.mean), 0.025) << bounces << " bounces";
    EXPECT_LT(std::abs(last.mean - others.mean), 0.025) << bounces << " bounces";
    EXPECT_LT(std::abs(others.mean), 0.01) << bounces;
  }
}

}  // namespace
}  // namespace pelage
