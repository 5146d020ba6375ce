// SPDX-License-Identifier: Apache-2.0
#include <fstream>

#include "base/file.h"
#include "tests/groom/cached_coats.h"

namespace pelage {
namespace {

using GroomCacheTest = CachedCoatTest;

TEST_F(GroomCacheTest, WarmAndColdAreTheSameToTheLastBit) {
  const LimitSurface pose = posed(0.7f, 0.2f);
  const LimitSurface both[] = {*rest_, pose};
  const PosedSkin moving{both, {}, 1.3f, {}, 0.8f};
  for (const char* freeze : {"length", "comb", "clump", "frizz", "noise", "width", "color"}) {
    std::filesystem::remove_all(cache());
    const Coat coat{kEveryFrozenOperator, freeze};
    const auto cold = make(coat, 1);
    EXPECT_FALSE(cold->cache_report()->fresh);
    EXPECT_TRUE(cold->cache_report()->stored);
    const auto warm = make(coat, 3);
    EXPECT_TRUE(warm->cache_report()->fresh) << warm->cache_report()->summary();
    EXPECT_EQ(bits(*cold, moving), bits(*warm, moving)) << freeze;
    for (size_t leaf = 0; leaf < cold->follicles().leaves().size(); ++leaf)
      EXPECT_EQ(cold->conservative_bound(leaf, moving), warm->conservative_bound(leaf, moving));
    EXPECT_EQ(cold->content_hash(), warm->content_hash());
  }
  EXPECT_TRUE(warnings_.empty()) << warnings_.front();
}

TEST_F(GroomCacheTest, NoPointMovesByMoreThanATwentiethOfAWidth) {
  const LimitSurface pose = posed(0.4f, 0.3f);
  const PosedSkin skin{{&pose, 1}, {}, 1.5f, {}};
  const auto plain = all(*make(Coat{kEveryFrozenOperator, ""}), skin);
  for (const char* freeze : {"comb", "clump", "noise", "width", "color"}) {
    const auto cached = all(*make(Coat{kEveryFrozenOperator, freeze}), skin);
    ASSERT_EQ(plain.size(), cached.size());
    for (size_t leaf = 0; leaf < plain.size(); ++leaf) {
      const Strands &a = plain[leaf], &b = cached[leaf];
      ASSERT_EQ(a.point_count(), b.point_count());
      for (size_t s = 0; s < a.strand_count(); ++s) {
        ASSERT_EQ(a.id(s), b.id(s));
        float width = 0;
        for (uint32_t p = a.first_point(s); p < a.first_point(s) + a.strand_points(s); ++p)
          width = std::max(width, 2 * a.radius(p));
        for (uint32_t p = a.first_point(s); p < a.first_point(s) + a.strand_points(s); ++p) {
          ASSERT_LE((a.point(p) - b.point(p)).length(), width / 20) << freeze;
          ASSERT_NEAR(a.radius(p), b.radius(p), width / 1000) << freeze;
        }
      }
      const StrandAttribute *ca = a.find_attribute("color"), *cb = b.find_attribute("color");
      ASSERT_EQ(ca->values.size(), cb->values.size());
      for (size_t i = 0; i < ca->values.size(); ++i) ASSERT_NEAR(ca->values[i], cb->values[i], 0.005f);
    }
  }
}

}  // namespace
}  // namespace pelage
