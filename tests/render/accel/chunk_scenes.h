// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <stdexcept>
#include <vector>

#include "base/hash.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "geom/curve_bounds.h"
#include "procedurals/bounds/segment_parts.h"
#include "render/accel/chunk_accel.h"
#include "render/accel/part_bounds.h"
#include "tests/geom/random_strands.h"
#include "tests/render/accel/accel_scenes.h"
#include "tests/render/accel/embree_accel.h"

namespace pelage {

/// Existing chunks, copied each time they are grown.
class TestChunks final : public ChunkGrower {
 public:
  ChunkContents grow(uint32_t chunk) const override {
    if (chunk == fails_at) throw std::runtime_error("no hair today");
    return contents[chunk];
  }
  bool is_skin(uint32_t chunk) const override {
    return std::holds_alternative<SkinMesh>(contents[chunk].geometry);
  }
  uint32_t part(uint32_t chunk) const override { return contents[chunk].part; }
  ChunkCounts counts(uint32_t chunk) const override {
    ChunkCounts n;
    if (const auto* fur = std::get_if<FurContents>(&contents[chunk].geometry)) {
      n.strands = fur->strands.strand_count();
      n.points = fur->strands.point_count();
      n.segments = n.points;
      n.motion_keys = fur->strands.motion_keys();
      for (const StrandAttribute& a : fur->strands.attributes()) n.attribute_floats += a.values.size();
    } else {
      const auto& skin = std::get<SkinMesh>(contents[chunk].geometry);
      n.vertices = skin.vertex_count();
      n.triangles = skin.triangle_count();
      n.motion_keys = skin.motion_keys;
    }
    return n;
  }

  StrandScale scale(uint32_t) const override { return {0.024f, V3f(0.1f, -0.2f, 0.05f), widest}; }

  void add_fur(Strands strands, uint32_t part, std::vector<float> opacity = {}) {
    for (float& o : opacity) o = packed_value(o);
    contents.push_back({FurContents{std::move(strands), std::move(opacity)}, part});
  }
  void add_skin(SkinMesh mesh, uint32_t part) { contents.push_back({std::move(mesh), part}); }

  /// The same things in one eager scene. It has the layout of chunks: with AVX2, the last bits of Embree's
  /// answers depend on the layout.
  std::unique_ptr<EmbreeAccel> oracle(CurveShape shape) const {
    std::vector<AccelStrands> strands;
    std::vector<const SkinMesh*> skins;
    for (const ChunkContents& chunk : contents) {
      if (const auto* fur = std::get_if<FurContents>(&chunk.geometry)) {
        strands.push_back({&fur->strands, chunk.part, fur->opacity});
      } else {
        skins.push_back(&std::get<SkinMesh>(chunk.geometry));
      }
    }
    EmbreeOptions options;
    options.shape = shape;
    options.compact = true;
    return std::make_unique<EmbreeAccel>(std::move(strands), std::move(skins), options, Workers(2));
  }

  /// Boxes of every chunk: of its parts, or one box around all that is `slack` times too large.
  std::vector<ChunkBounds> bounds(size_t max_parts, float slack = 1) const {
    std::vector<ChunkBounds> result;
    for (const ChunkContents& chunk : contents) {
      result.push_back(part_bounds(chunk, 200, max_parts));
      if (slack == 1) continue;
      const Box3f box = result.back().whole();
      const V3f more = 0.5f * (slack - 1) * box.size();
      result.back() = {1, {Box3f(box.min - more, box.max + more)}};
    }
    return result;
  }

  /// Boxes as they are measured before the first ray: exact ones and fine ones.
  std::vector<ChunkBounds> measured_bounds(int keys, const SegmentDivision& division = {}) const {
    std::vector<ChunkBounds> result;
    for (const ChunkContents& chunk : contents) {
      const auto* fur = std::get_if<FurContents>(&chunk.geometry);
      result.push_back(fur ? SegmentParts(fur->strands, division).exact_bounds(keys)
                           : part_bounds(chunk, 200, 8));
    }
    return result;
  }

  std::vector<ChunkContents> contents;
  uint32_t fails_at = ~0u;
  float widest = 0;  // of all coats
};

/// What a scene of random_chunks() is made of.
struct RandomChunkOptions {
  size_t chunks = 12;
  size_t strands = 120;
  CurveBasis basis = CurveBasis::kPinnedBSpline;
  bool uniform = true;  ///< equally many points in each strand
  int motion_keys = 1;
  bool translucent = false;
  bool skins = true;
};

inline TestChunks random_chunks(uint64_t seed, const RandomChunkOptions& o) {
  TestChunks chunks;
  for (uint64_t c = 0; c < o.chunks; ++c) {
    const auto number = [&](uint64_t i) {
      return signed_float(hash64(seed, c, i, random_use("test chunk")));
    };
    RandomStrandOptions s;
    s.strands = o.strands;
    s.min_points = o.uniform ? 6 : 1;
    s.max_points = o.uniform ? 6 : 9;
    s.radius = 0.012f;
    s.basis = o.basis;
    s.motion_keys = o.motion_keys;
    s.centre = 0.7f * V3f(number(0), number(1), number(2));
    StrandArrays arrays = Strands(random_strands(hash64(seed, c), s)).release();
    // Ids are unique within a part; neighbouring chunks are of one part, and every fourth is of another.
    const auto part = static_cast<uint32_t>(c % 4 == 3 ? 1 : 0);
    for (uint64_t& id : arrays.ids) id = hash64(id, 99) % 1000 * 64 + c;
    StrandAttribute color{"color", AttributeClass::kPerStrand, 3, {}};
    for (size_t i = 0; i < 3 * s.strands; ++i) {
      color.values.push_back(packed_value(unit_float(hash64(seed, c, i, random_use("test color")))));
    }
    arrays.attributes.push_back(std::move(color));
    std::vector<float> opacity;
    if (o.translucent && c % 3 != 0) {
      for (size_t i = 0; i < arrays.first_point.back(); ++i) {
        opacity.push_back(c % 3 == 1 ? 0.3f : std::abs(signed_float(hash64(seed, c, i))));
      }
    }
    chunks.add_fur(Strands(std::move(arrays)), part, std::move(opacity));
  }
  if (o.skins) {
    for (uint32_t k = 0; k < 2; ++k) {
      SkinMesh mesh = quad(k == 0 ? 0.9f : -0.2f);
      chunks.add_skin(std::move(mesh), k);
    }
  }
  return chunks;
}

}  // namespace pelage
