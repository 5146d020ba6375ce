// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <gtest/gtest.h>

#include "render/accel/flush_denormals.h"
#include "render/frame/frame_geometry.h"
#include "render/raster/tile_raster.h"
#include "tests/render/path/path_scene.h"
#include "tests/support/quiet_job.h"

namespace pelage {

/// Strands and skins, whose visible surfaces are found by rays and by drawing.
struct RasterScene : PathScene {
  RasterScene(int width, int height) : PathScene(width, height) {
    camera.fov = 20.0f;
    image.filter = PixelFilter::kBlackmanHarris;
  }

  /// What two ways of finding visible surfaces have in common.
  struct Agreement {
    int64_t samples = 0, hits = 0;  ///< hits: of rays
    int64_t drawn_hits = 0;         ///< of drawing
    int64_t same = 0;               ///< samples with bit-identical hits, or without any
    int64_t traced = 0;             ///< drawn samples whose ray was traced after all
    size_t chunks = 0;              ///< count of chunks of the scene
    bool not_nearer = true;         ///< no drawn hit is nearer than that of the ray

    double coverage() const { return static_cast<double>(hits) / static_cast<double>(samples); }
    double drawn_coverage() const { return static_cast<double>(drawn_hits) / static_cast<double>(samples); }
  };

  /// Compares both for `count` samples of each pixel. Calls each(pixel x, y, ray hit, drawn hit).
  template <class Each>
  Agreement compare(uint32_t count, const Each& each, bool grow_first = false) {
    RenderScene scene{
        std::move(fur), skins, materials, LightSet({}), Camera(camera, 1, image.width, image.height),
        image,          render};
    const Agreement result = compare(scene, ledger, count, each, grow_first);
    fur = std::move(scene.fur);
    return result;
  }
  Agreement compare(uint32_t count) {
    return compare(count, [](int, int, const Hit&, const Hit&) {});
  }
  /// The same for any scene. `grow_first`: whether all chunks are grown before.
  template <class Each>
  static Agreement compare(const RenderScene& scene, MemoryLedger& ledger, uint32_t count, const Each& each,
                           bool grow_first = false) {
    QuietJob job(1, ledger);
    FrameStatistics made;
    ledger.set_limit(scene.render.memory.bytes);
    const auto geometry = FrameGeometry::make(scene, job, made);
    const Accel& accel = geometry->accel();
    const CameraSamples samples(scene, accel, false);
    const TileRaster raster(scene, accel, geometry->chunks(), samples);
    const FlushDenormals flush;
    TileRaster::Scratch scratch;
    TraceThread drawing, tracing;
    Agreement result;
    result.chunks = geometry->chunks().size();
    for (uint32_t chunk = 0; grow_first && chunk < result.chunks; ++chunk)
      geometry->chunks().visit(chunk, 0, [](const ChunkGeometry&) {});
    for (const Tile& tile : tiles_along_curve(scene.image.width, scene.image.height, 16)) {
      EXPECT_TRUE(raster.find(tile, 0, count, job, 0, scratch));
      uint32_t pixel = 0;
      for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x, ++pixel) {
          for (uint32_t i = 0; i < count; ++i) {
            SampleStream stream = samples.stream(x, y, i);
            const Ray ray = samples.sample(x, y, i, stream).ray;
            const Hit drawn = raster.closest(pixel, i, drawing, scratch), hit = accel.closest(ray, tracing);
            const bool same = is_same(hit, drawn);
            if (same && hit) expect_same_geometry(tracing.hit_geometry, drawing.hit_geometry, hit);
            ++result.samples;
            result.hits += hit ? 1 : 0;
            result.drawn_hits += drawn ? 1 : 0;
            result.same += same ? 1 : 0;
            result.not_nearer = result.not_nearer && drawn.distance >= hit.distance;
            each(x, y, hit, drawn);
          }
        }
      }
      TileRaster::end(drawing, scratch);
    }
    result.traced = scratch.traced;
    return result;
  }

  static bool is_same(const Hit& a, const Hit& b) {
    return a.kind == b.kind && a.distance == b.distance && a.part == b.part && a.strand_id == b.strand_id &&
           a.segment == b.segment && a.u == b.u && a.v == b.v;
  }
  static void expect_same_geometry(const HitGeometry& a, const HitGeometry& b, const Hit& hit) {
    if (hit.kind == HitKind::kStrand) {
      ASSERT_EQ(a.strand.id(0), b.strand.id(0));
      ASSERT_EQ(a.strand.point_count(), b.strand.point_count());
      EXPECT_EQ(a.strand.point(0, 0), b.strand.point(0, 0));
    } else {
      EXPECT_EQ(a.triangle.positions, b.triangle.positions);
    }
  }
};

}  // namespace pelage
