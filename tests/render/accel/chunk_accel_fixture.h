// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <limits>
#include <string_view>

#include <gtest/gtest.h>

#include "base/progress.h"
#include "render/accel/flush_denormals.h"
#include "render/accel/resident_chunks.h"
#include "tests/render/accel/chunk_scenes.h"

namespace pelage {

/// Counts what went wrong.
class WarningCounter final : public Progress {
 public:
  void begin(std::string_view, double) override {}
  void advance(double) override {}
  void end() override {}
  void warn(std::string_view) override { ++warnings; }
  bool cancelled() const override { return false; }

  std::atomic<int> warnings{0};
};

/// Whether all that two batches hold is the same.
inline bool are_equal(const Strands& a, const Strands& b) {
  const StrandArrays &x = a.arrays(), &y = b.arrays();
  const auto same_root = [](const RootAddress& r, const RootAddress& s) {
    return r.face == s.face && r.u == s.u && r.v == s.v;
  };
  const auto same_attribute = [](const StrandAttribute& r, const StrandAttribute& s) {
    return r.name == s.name && r.frequency == s.frequency && r.components == s.components &&
           r.values == s.values;
  };
  return x.basis == y.basis && x.motion_keys == y.motion_keys && x.points == y.points &&
         x.first_point == y.first_point && x.ids == y.ids && x.root_uv == y.root_uv &&
         std::equal(x.roots.begin(), x.roots.end(), y.roots.begin(), y.roots.end(), same_root) &&
         std::equal(x.attributes.begin(), x.attributes.end(), y.attributes.begin(), y.attributes.end(),
                    same_attribute);
}

class ChunkAccelTest : public testing::Test {
 protected:
  std::unique_ptr<ChunkAccel> make(const TestChunks& chunks, std::vector<ChunkBounds> bounds,
                                   const ResidentChunksOptions& options = {}) {
    return std::make_unique<ChunkAccel>(std::move(bounds), chunks, options,
                                        Job{workers_, ledger_, progress_});
  }

  std::unique_ptr<ResidentChunks> hold(const TestChunks& chunks, std::vector<ChunkBounds> bounds,
                                       const ResidentChunksOptions& options = {}) {
    return std::make_unique<ResidentChunks>(std::move(bounds), chunks, options,
                                            Job{workers_, ledger_, progress_});
  }

  /// That every handle names the same strand in both, down to the last bit.
  static void expect_same_strands(const ResidentChunks& a, const ResidentChunks& b) {
    const FlushDenormals flush;
    Strands in_a, in_b;
    ASSERT_EQ(a.size(), b.size());
    for (uint32_t chunk = 0; chunk < a.size(); ++chunk) {
      const size_t count = strand_count(a, chunk);
      ASSERT_EQ(count, strand_count(b, chunk));
      for (uint32_t index = 0; index < count; ++index) {
        a.copy_strand({chunk, index}, 0, in_a);
        b.copy_strand({chunk, index}, 0, in_b);
        ASSERT_TRUE(are_equal(in_a, in_b)) << chunk << " " << index;
      }
    }
  }
  static size_t strand_count(const ResidentChunks& chunks, uint32_t chunk) {
    return chunks.visit(chunk, 0, [](const ChunkGeometry& geometry) { return geometry.strand_count(); });
  }

  /// That both answer every ray alike, down to the last bit. The accelerators may hold the strands in other
  /// chunks, so that each goes on from its own hits.
  void expect_same(const Accel& a, const Accel& b, uint64_t seed, uint64_t rays, int worker = 0) {
    const FlushDenormals flush;
    TraceThread ta, tb;
    ta.worker = tb.worker = worker;
    uint64_t strands = 0, skins = 0, lit = 0;
    for (uint64_t i = 0; i < rays; ++i) {
      Ray ray = i % 2 == 0 ? random_ray(seed, i) : inner_ray(seed, i);
      if (i % 5 == 0) ray.far = 3 + ray.direction.x;
      ray.secondary = secondary_;
      const Hit ha = a.closest(ray, ta), hb = b.closest(ray, tb);
      ASSERT_EQ(ha.kind, hb.kind) << i;
      ASSERT_EQ(ha.part, hb.part) << i;
      ASSERT_EQ(ha.strand_id, hb.strand_id) << i;
      ASSERT_EQ(ha.segment, hb.segment) << i;
      ASSERT_EQ(ha.distance, hb.distance) << i;
      ASSERT_EQ(ha.u, hb.u) << i;
      ASSERT_EQ(ha.v, hb.v) << i;
      if (ha.kind == HitKind::kStrand) {
        ASSERT_EQ(ta.hit_geometry.strand.arrays().points, tb.hit_geometry.strand.arrays().points);
        ASSERT_EQ(ta.hit_geometry.strand.arrays().ids, tb.hit_geometry.strand.arrays().ids);
        ++strands;
      } else if (ha.kind == HitKind::kSkin) {
        ASSERT_EQ(ta.hit_geometry.triangle.positions, tb.hit_geometry.triangle.positions);
        ++skins;
      }
      const float light = a.transmittance(ray, ta);
      ASSERT_EQ(light, b.transmittance(ray, tb)) << i;
      lit += light > 0;
      if (!ha) continue;
      // On from there: what is near a ray's start may not be seen.
      Ray onward = ray;
      onward.origin += ha.distance * ray.direction;
      onward.direction = random_ray(seed + 1, i).direction;
      Ray onward_a = onward, onward_b = onward;
      // One scene over everything knows of no strand that a ray starts on.
      if (ha.start.chunk != StrandStart::kNone) onward_a.start = ha.start, onward_b.start = hb.start;
      const Hit na = a.closest(onward_a, ta), nb = b.closest(onward_b, tb);
      ASSERT_EQ(na.strand_id, nb.strand_id) << i;
      ASSERT_EQ(na.distance, nb.distance) << i;
      ASSERT_EQ(a.transmittance(onward_a, ta), b.transmittance(onward_b, tb)) << i;
    }
    EXPECT_GT(strands, rays / 20);
    EXPECT_GT(lit, rays / 20);
    EXPECT_LT(strands + skins, rays);
  }

  /// A skin which the ray along_z(x) meets at the same distance, bit by bit, as the first strand of ladder().
  /// Embree rounds distances of triangles and of curves differently, depending on the instruction set.
  SkinMesh quad_as_far_as_strand(float x) {
    const auto distance = [&](const TestChunks& chunks) {
      TraceThread thread;
      return make(chunks, chunks.bounds(4))->closest(along_z(x), thread).distance;
    };
    TestChunks strand;
    strand.add_fur(ladder(1), 0);
    const float wanted = distance(strand);
    for (int step = 0; step <= 40; ++step) {
      for (const float sign : {1.0f, -1.0f}) {
        TestChunks skin;
        skin.add_skin(quad(sign * static_cast<float>(step) * 0.25f * std::numeric_limits<float>::epsilon()),
                      0);
        if (distance(skin) == wanted) return std::get<SkinMesh>(skin.contents[0].geometry);
      }
    }
    ADD_FAILURE() << "no skin has the distance of the strand at x = " << x;
    return quad(0);
  }

  /// From within the scene of random_chunks().
  static Ray inner_ray(uint64_t seed, uint64_t index) {
    Ray ray = random_ray(seed, index);
    ray.origin += 3.5f * ray.direction;
    return ray;
  }

  Workers workers_{2};
  MemoryLedger ledger_;
  WarningCounter progress_;
  bool secondary_ = false;  // Ray::secondary of the rays of expect_same()
};

inline constexpr AccelKind kAccelKinds[] = {AccelKind::kEmbree, AccelKind::kFur};

/// Scenes of every kind of strand.
inline constexpr int kSceneKinds = 7;
inline RandomChunkOptions scene_of_kind(int kind) {
  RandomChunkOptions o;
  switch (kind) {
    case 0:
      break;
    case 1:
      o.translucent = true;
      break;
    case 2:
      o.motion_keys = 2;
      o.translucent = true;
      break;
    case 3:
      o.motion_keys = 4;
      o.uniform = false;
      break;
    case 4:
      o.basis = CurveBasis::kLinear;
      o.translucent = true;
      break;
    case 5:
      o.basis = CurveBasis::kCatmullRom;
      o.uniform = false;
      break;
    default:
      o.basis = CurveBasis::kBSpline;
      o.uniform = false;
      o.motion_keys = 3;
      break;
  }
  return o;
}

}  // namespace pelage
