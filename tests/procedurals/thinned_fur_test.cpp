// SPDX-License-Identifier: Apache-2.0
#include "procedurals/thinned_fur.h"

#include <map>
#include <set>

#include <gtest/gtest.h>

#include "base/temporary_folder.h"
#include "geom/curve_bounds.h"
#include "geom/io/strand_file.h"
#include "procedurals/detail/coat_stats.h"
#include "procedurals/fur.h"
#include "tests/procedurals/random_coats.h"
#include "tests/support/quiet_job.h"

namespace pelage::thinned_fur_test {
namespace {

struct Seen {
  float distance = 40;
  float focal_pixels = 800;
  float confusion = 0;  // lens
  SimplificationParams params = {};
};

Simplification seen(const RandomCoat& coat, const Seen& s) {
  LodView view;
  const V3f middle = coat.skin->bound(BoundSpan::kShutter).center();
  view.open.position = view.close.position = middle + V3f(0, 0, s.distance);
  view.open.focal_pixels = view.close.focal_pixels = s.focal_pixels;
  view.lens_diameter = s.confusion;
  view.focus_distance = 1;
  const Workers workers(1);
  CoatStats stats = coat_stats(*coat.groom, coat.rest.get(), workers);
  stats.width *= coat.skin->scale();
  stats.length *= coat.skin->scale() * coat.skin->length();
  return {s.params, view, stats, 1};
}

using Points = std::vector<float>;
/// All points of every strand that a coat gives, by id.
std::map<uint64_t, Points> by_id(const FurProcedural& fur) {
  std::map<uint64_t, Points> all;
  for (const auto& chunk : fur.split()) {
    const Strands strands = chunk->generate();
    for (size_t s = 0; s < strands.strand_count(); ++s) {
      Points& points = all[strands.id(s)];
      EXPECT_TRUE(points.empty()) << "twice: " << strands.id(s);
      for (int key = 0; key < strands.motion_keys(); ++key) {
        const auto of_key = strands.points(key).subspan(strands.first_point(s) * size_t(4),
                                                        strands.strand_points(s) * size_t(4));
        points.insert(points.end(), of_key.begin(), of_key.end());
      }
    }
  }
  return all;
}

bool contains(const Box3f& outer, const Box3f& inner) {
  return inner.isEmpty() || (outer.intersects(inner.min) && outer.intersects(inner.max));
}

TEST(ThinnedFur, CloseByItIsTheWholeCoatBitByBit) {
  const RandomCoat coat(3, {});
  Seen close;
  close.focal_pixels = 1e7f;
  close.params.motion_blur = close.params.back_facing = false;
  const auto whole = by_id(FurProcedural(coat.groom, coat.skin));
  EXPECT_TRUE(by_id(FurProcedural(coat.groom, coat.skin, seen(coat, close))) == whole);
  EXPECT_EQ(whole.size(), coat.groom->follicles().size());
}

TEST(ThinnedFur, ChunksAndLeavesDecideNothing) {
  for (const uint64_t seed : {4, 5, 6}) {
    RandomCoatOptions options;
    const RandomCoat large(seed, options);
    options.leaf_strands = 37;
    const RandomCoat small(seed, options);
    for (const float distance : {6.0f, 25.0f, 400.0f}) {
      Seen s;
      s.distance = distance;
      const auto a = by_id(FurProcedural(large.groom, large.skin, seen(large, s)));
      EXPECT_TRUE(a == by_id(FurProcedural(small.groom, small.skin, seen(small, s))));
      EXPECT_GT(a.size(), 0u);
    }
  }
}

TEST(ThinnedFur, EachStrandIsKeptForWhereItsRootStands) {
  for (const uint64_t seed : {7, 8}) {
    const RandomCoat coat(seed, {});
    Seen s;
    s.distance = 12;
    s.confusion = 0.02f;
    const Simplification lod = seen(coat, s);
    const auto direction = std::make_shared<const CoatDirection>(*coat.groom, coat.rest, Workers(1));
    const auto kept = by_id(FurProcedural(coat.groom, coat.skin, lod, direction));
    const auto pose = coat.skin->pose(BoundSpan::kShutter);
    std::set<uint64_t> expected;
    for (size_t f = 0; f < coat.groom->follicles().size(); ++f) {
      const SurfacePoint open = coat.groom->root(f, pose->skin(), 0);
      const RootPlace root{open.position, coat.groom->root(f, pose->skin(), pose->keys.size() - 1).position,
                           open.du.cross(open.dv).normalized(),
                           direction->at(coat.groom->follicles().root(f), open)};
      if (lod.width_factor(lod.share(root), coat.groom->priority(f)) > 0)
        expected.insert(coat.groom->follicles().id(f));
    }
    std::set<uint64_t> ids;
    for (const auto& [id, points] : kept) ids.insert(id);
    EXPECT_EQ(ids, expected);
    EXPECT_LT(ids.size(), 0.8 * static_cast<double>(coat.groom->follicles().size()));
    EXPECT_GT(ids.size(), 10u);
  }
}

// A turned box of a part is another box than the part of a turned box.
TEST(ThinnedFur, StrandsOnNoSkinHaveOneScaleHoweverTheyAreDivided) {
  const RandomCoat coat(5, {});
  const TemporaryFolder folder;
  GroomParams params;
  params.strands_file = {folder.path() / "coat.hair", {}};
  PosedSkin rest;
  rest.keys = {coat.rest.get(), 1};
  write_strands(params.strands_file.path, coat.groom->grow(0, rest));
  MemoryLedger ledger;
  TextureLibrary textures(ledger);
  Seen s;
  s.distance = 25;
  const auto scale_of = [&](int leaf_strands) {
    params.leaf_strands = leaf_strands;
    const std::shared_ptr<const Groom> free =
        Groom::create("free", params, nullptr, textures, QuietJob(1, ledger));
    return FurProcedural(free, coat.skin, seen(coat, s)).scale();
  };
  const StrandScale whole = scale_of(8000);
  EXPECT_GT(whole.width, 0);
  for (const int leaf_strands : {100, 7}) {
    EXPECT_EQ(scale_of(leaf_strands).width, whole.width) << leaf_strands;
    EXPECT_EQ(scale_of(leaf_strands).anchor, whole.anchor) << leaf_strands;
  }
}

TEST(ThinnedFur, FartherIsASubset) {
  const RandomCoat coat(9, {});
  std::set<uint64_t> before;
  for (size_t f = 0; f < coat.groom->follicles().size(); ++f) before.insert(f);
  for (float distance = 10; distance < 3000; distance *= 1.5f) {
    Seen s;
    s.distance = distance;
    s.params.min_share = 1e-3f;
    s.params.back_facing = false;  // from farther away more of a ball is seen
    std::set<uint64_t> now;
    for (const auto& [id, points] : by_id(FurProcedural(coat.groom, coat.skin, seen(coat, s)))) {
      EXPECT_TRUE(before.count(id));
      now.insert(id);
    }
    before = now;
  }
  EXPECT_LT(before.size(), 400u);
}

TEST(ThinnedFur, BoundsHoldWidenedStrands) {
  for (uint64_t seed = 10; seed < 18; ++seed) {
    RandomCoatOptions options;
    options.motion_keys = 1 + static_cast<int>(seed % 3);
    options.push_out = seed % 4 == 0;
    const RandomCoat coat(seed, options);
    for (const float distance : {8.0f, 40.0f, 900.0f}) {
      Seen s;
      s.distance = distance;
      s.confusion = seed % 2 == 0 ? 0.05f : 0.0f;
      const FurProcedural fur(coat.groom, coat.skin, seen(coat, s));
      const Box3f whole = fur.bound(BoundSpan::kShutter);
      for (const auto& chunk : fur.split()) {
        const Strands strands = chunk->generate();
        const Box3f truth = exact_bounds(strands);
        EXPECT_TRUE(contains(chunk->bound(BoundSpan::kShutter), truth));
        EXPECT_TRUE(contains(chunk->bound(BoundSpan::kFrame), truth));
        EXPECT_TRUE(contains(whole, truth));
        for (const BoundSpan span : {BoundSpan::kFrame, BoundSpan::kShutter})
          EXPECT_TRUE(contains(chunk->exact_bounds(span, 1).whole(), truth));
        const StrandCounts counts = chunk->counts();
        EXPECT_LE(strands.strand_count(), counts.strands);
        EXPECT_LE(strands.point_count(), counts.points);
        size_t floats = 0;
        for (const StrandAttribute& a : strands.attributes()) floats += a.values.size();
        EXPECT_LE(floats, counts.attribute_floats);
      }
    }
  }
}

TEST(ThinnedFur, AFarCharacterIsOneChunk) {
  RandomCoatOptions options;
  options.length = 8;  // thin for its length
  const RandomCoat coat(20, options);
  Seen s;
  EXPECT_GT(FurProcedural(coat.groom, coat.skin).split().size(), 2u);
  s.distance = 5000;
  EXPECT_EQ(FurProcedural(coat.groom, coat.skin, seen(coat, s)).split().size(), 1u);
}

TEST(ThinnedFur, BoxesAreRememberedForTheirViewOnly) {
  const TemporaryFolder folder;
  RandomCoatOptions options;
  options.cache = folder.path();
  const RandomCoat coat(21, options);
  Seen s;
  const auto key = [&] {
    return FurProcedural(coat.groom, coat.skin, seen(coat, s)).split()[0]->bounds_record()->key;
  };
  const ContentHash first = key();
  EXPECT_EQ(first, key());
  s.distance *= 1.001f;
  EXPECT_FALSE(first == key());
  EXPECT_FALSE(first == FurProcedural(coat.groom, coat.skin).split()[0]->bounds_record()->key);
  const auto far = FurProcedural(coat.groom, coat.skin, seen(coat, s)).split();
  s.distance *= 2;
  const auto farther = FurProcedural(coat.groom, coat.skin, seen(coat, s)).split();
  EXPECT_TRUE(*far[0]->content() == *far[0]->content());
  EXPECT_FALSE(*far[0]->content() == *farther[0]->content());
}

}  // namespace
}  // namespace pelage::thinned_fur_test
