// SPDX-License-Identifier: Apache-2.0
// Boxes and thinned coats are those recorded with their versions.
#include <gtest/gtest.h>

#include "groom/cache/groom_identity.h"
#include "procedurals/bounds/bounds_file.h"
#include "procedurals/bounds/segment_parts.h"
#include "procedurals/detail/coat_stats.h"
#include "procedurals/fur.h"
#include "procedurals/thinned_fur.h"
#include "tests/geom/random_strands.h"
#include "tests/procedurals/random_coats.h"
#include "tests/support/recorded_results.h"

namespace pelage {
namespace {

TEST(StoredVersions, Boxes) {
  StageResult result;
  for (const int keys : {1, 2}) {
    const Strands strands = random_strands(3, {.strands = 300, .motion_keys = 2});
    const ChunkBounds bounds = SegmentParts(strands).exact_bounds(keys);
    std::vector<float> boxes;
    for (const Box3f& box : bounds.boxes) {
      for (const V3f& v : {box.min, box.max}) boxes.insert(boxes.end(), {v.x, v.y, v.z});
    }
    std::vector<float> cell_bounds;
    for (size_t b = 0; b < bounds.cell_bounds.count(); ++b) {
      const Box3f box = bounds.cell_bounds.box(b, 0.25f);
      for (const V3f& v : {box.min, box.max}) cell_bounds.insert(cell_bounds.end(), {v.x, v.y, v.z});
    }
    result.add("boxes at " + std::to_string(keys), boxes);
    result.add("cell bounds at " + std::to_string(keys), cell_bounds);
  }
  RecordedResults().check("boxes", {{"boxes", kBoundsVersion}},
                          "kBoundsVersion in procedurals/bounds/bounds_file.h", result);
}

TEST(StoredVersions, ThinnedCoats) {
  OperatorList operators;
  stacks::add<Length>(operators, {.value = Field(0.4f), .variation = 0.5f});
  stacks::add<Frizz>(operators, {.amplitude = Field(0.05f)});
  stacks::add<Width>(operators, {.root = Field(0.02f), .tip = Field(0.005f)});
  const RandomCoat coat(5, {.operators = operators});
  LodView view;
  const V3f middle = coat.skin->bound(BoundSpan::kShutter).center();
  view.open.position = middle + V3f(0, 0, 14);
  view.close.position = middle + V3f(1, 0, 14);
  view.open.focal_pixels = view.close.focal_pixels = 800;
  view.lens_diameter = 0.02f;
  view.focus_distance = 10;
  const Workers workers(1);
  CoatStats stats = coat_stats(*coat.groom, coat.rest.get(), workers);
  stats.width *= coat.skin->scale();
  stats.length *= coat.skin->scale() * coat.skin->length();
  SimplificationParams coarse;
  coarse.quality = 0.5f;
  StageResult result;
  for (const bool far : {false, true}) {
    const Simplification lod(far ? coarse : SimplificationParams(), view, stats, 1);
    std::vector<float> points;
    std::vector<uint64_t> ids;
    for (const auto& chunk : FurProcedural(coat.groom, coat.skin, lod).split()) {
      const Strands strands = chunk->generate();
      for (int key = 0; key < strands.motion_keys(); ++key)
        points.insert(points.end(), strands.points(key).begin(), strands.points(key).end());
      for (size_t s = 0; s < strands.strand_count(); ++s) ids.push_back(strands.id(s));
      for (const StrandAttribute& a : strands.attributes())
        points.insert(points.end(), a.values.begin(), a.values.end());
    }
    EXPECT_GT(ids.size(), 30u);
    result.add(far ? "far points" : "points", points);
    result.add(far ? "far ids" : "ids", ids);
  }
  GroomParams params;
  params.operators = operators;
  auto versions = growth_versions(GroomIdentity(params, 1, OperatorStack(operators), coat.rest.get()));
  versions.emplace_back("pose", growth_version::kPose);
  versions.emplace_back("thinned", ThinnedFurProcedural::kVersion);
  RecordedResults().check("thinned coats", versions,
                          "ThinnedFurProcedural::kVersion in procedurals/thinned_fur.h", result);
}

}  // namespace
}  // namespace pelage
