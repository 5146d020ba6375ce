// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <fstream>

#include "base/file.h"
#include "base/progress.h"
#include "geom/closest_point.h"
#include "geom/io/strand_file.h"
#include "geom/tessellation.h"
#include "tests/groom/cached_coats.h"
#include "tests/groom/kept_strands.h"

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
      // Half a step of 8 bits, in linear light and as a screen has it.
      for (size_t i = 0; i < ca->values.size(); ++i) {
        ASSERT_NEAR(ca->values[i], cb->values[i], 0.5f / 255);
        ASSERT_NEAR(std::sqrt(ca->values[i]), std::sqrt(cb->values[i]), 0.5f / 255);
      }
    }
  }
}

TEST_F(GroomCacheTest, SomeStrandsAreThoseOfTheWhole) {
  const auto groom = make(Coat{kEveryFrozenOperator, "frizz"});
  std::vector<uint32_t> some{0, 1, 17, 255, 256, 300};  // blocks are of 256
  const std::vector<float> width{1, 2, 3, 4, 5, 6};
  const KeptStrands kept{some, width, {}};
  const Strands whole = groom->grow(1, at_rest()), part = groom->grow(1, at_rest(), &kept);
  expect_strands_of(whole, kept, part);
}

TEST_F(GroomCacheTest, LiveOperatorsGoOnFromTheFrozenOnes) {
  // One that pushes out of the posed skin, one that needs rest frames behind it, and fields of all kinds.
  const std::string operators =
      "- length: {value: 0.4}\n"
      "- clump: {spacing: 0.3, amount: 0.7}\n"
      "- frizz: {amplitude: 0.01, frequency: 3}\n"
      "- width: {root: {product: [0.01, {ramp: {along: y, knots: [[-1, 0.5], [1, 1]]}}]}, tip: 0.002}\n"
      "- color: {value: {product: [{attribute: clump}, {ramp: {along: strand, knots: [[0, 1], [1, "
      "0.2]]}}]}}\n"
      "- push_out: {offset: 0.01}\n"
      "- comb: {direction: [0, 1, 0], lift: 0.8, amount: 0.3}\n";
  const LimitSurface pose = posed(0.3f, 0.2f);
  View view;
  view.focal_pixels = 1e9f;
  const SkinMesh mesh = tessellate({&pose, 1}, view, {4, 8}, workers_);
  const ClosestPointTree tree(mesh, 0);
  const PosedSkin skin{{&pose, 1}, {&tree, 1}, 1, {}};
  const auto plain = bits(*make(Coat{operators, "", 600}), skin);
  for (const char* freeze : {"length", "clump", "frizz", "width", "color"}) {
    const auto cold = make(Coat{operators, freeze, 600}), warm = make(Coat{operators, freeze, 600});
    EXPECT_TRUE(warm->cache_report()->fresh);
    const auto cached = bits(*cold, skin);
    EXPECT_EQ(cached, bits(*warm, skin));
    ASSERT_EQ(cached.size(), plain.size());
    // Pushing out decides by signs, so a strand may take another way; nearly none does.
    size_t far = 0;
    for (size_t i = 0; i < plain.size(); ++i) far += std::fabs(plain[i] - cached[i]) > 2e-3f;
    EXPECT_LE(far, plain.size() / 1000) << freeze;
  }
}

TEST_F(GroomCacheTest, LengthScalesStrandsAboutTheirRootsAndNotTheirWidths) {
  for (const char* freeze : {"", "frizz"}) {
    const auto groom = make(Coat{kEveryFrozenOperator, freeze});
    PosedSkin longer = at_rest();
    longer.length = 1.7f;
    for (size_t leaf = 0; leaf < groom->follicles().leaves().size(); ++leaf) {
      const Strands a = groom->grow(leaf, at_rest()), b = groom->grow(leaf, longer);
      const Box3f bound = groom->conservative_bound(leaf, longer);
      for (size_t s = 0; s < a.strand_count(); ++s) {
        const V3f root = a.point(a.first_point(s));
        for (uint32_t p = a.first_point(s); p < a.first_point(s) + a.strand_points(s); ++p) {
          EXPECT_LE((root + (a.point(p) - root) * 1.7f - b.point(p)).length(), 2e-6f);
          EXPECT_EQ(a.radius(p), b.radius(p));
          EXPECT_TRUE(bound.intersects(b.point(p)));
        }
      }
    }
  }
}

/// Straight guides on the ball that lean away from its normals.
void write_guides(const std::filesystem::path& file, const LimitSurface& rest, float lean) {
  StrandArrays arrays;
  arrays.first_point.push_back(0);
  for (uint32_t face = 0; face < rest.topology().face_count(); ++face) {
    const Frame frame = rest.frame(face, 0.5f, 0.5f);
    const V3f root = rest.evaluate(face, 0.5f, 0.5f).position;
    for (int p = 0; p < 4; ++p) {
      const V3f point = root + (frame.normal + frame.tangent * lean) * (static_cast<float>(p) / 3);
      arrays.points.insert(arrays.points.end(), {point.x, point.y, point.z, 0.01f});
    }
    arrays.first_point.push_back(static_cast<uint32_t>(arrays.points.size() / 4));
    arrays.ids.push_back(face);
  }
  write_strands(file, Strands(std::move(arrays)));
}

TEST_F(GroomCacheTest, GuidesAreNotReadWhenTheCacheHasTheirCoatAndMakeItStaleWhenTheyChange) {
  const auto file = folder_.path() / "guides.hair";
  for (const char* freeze : {"length", "guides"}) {
    const Coat coat{"- guides: {file: " + file.string() + "}\n- length: {value: 1}\n", freeze};
    write_guides(file, *rest_, 0.5f);
    const auto cold = bits(*make(coat), at_rest());
    const auto warm = make(coat);
    EXPECT_TRUE(warm->cache_report()->fresh);
    EXPECT_EQ(cold, bits(*warm, at_rest()));

    write_guides(file, *rest_, 0.7f);
    const auto changed = make(coat);
    EXPECT_FALSE(changed->cache_report()->fresh);
    EXPECT_TRUE(changed->cache_report()->summary().starts_with("stale from guides (contents of guides.hair"))
        << changed->cache_report()->summary();
    const auto other = bits(*changed, at_rest());
    EXPECT_NE(cold, other);
    std::filesystem::remove_all(cache());
    EXPECT_EQ(other, bits(*make(coat), at_rest()));
    std::filesystem::remove_all(cache());
  }
}

TEST_F(GroomCacheTest, EditingAnOperatorRunsOnlyItAndWhatFollows) {
  const auto with = [](const std::string& amount, const std::string& amplitude) {
    return Coat{"- length: {value: 0.5}\n- comb: {direction: [0, -1, 0]}\n- clump: {spacing: 0.3, amount: " +
                    amount + "}\n- curl: {radius: 0.02}\n- frizz: {amplitude: " + amplitude + "}\n",
                "frizz"};
  };
  const auto first = make(with("0.6", "0.01"));
  EXPECT_EQ(first->cache_report()->resumed, 0u);
  EXPECT_EQ(first->cache_report()->stages.front().reason, "new");

  const auto frizzed = make(with("0.6", "0.02"));
  const GroomCacheReport& last = *frizzed->cache_report();
  EXPECT_EQ(last.resumed, 4u);
  EXPECT_EQ(last.summary(), "stale from frizz (amplitude: 0.01 -> 0.02)");

  const auto clumped = make(with("0.5", "0.02"));
  const GroomCacheReport& middle = *clumped->cache_report();
  EXPECT_EQ(middle.resumed, 2u);
  EXPECT_EQ(middle.summary(), "stale from clump (amount: 0.6 -> 0.5)");
  EXPECT_EQ(middle.stages.back().reason, "follows");

  EXPECT_EQ(files("layer").size(), 4u) << "those that nothing can go on from are gone";
  EXPECT_EQ(files("offsets").size(), 3u);

  // The same strands as when nothing is there to go on from.
  const auto resumed = bits(*clumped, at_rest());
  std::filesystem::remove_all(cache());
  EXPECT_EQ(resumed, bits(*make(with("0.5", "0.02")), at_rest()));
  EXPECT_TRUE(make(with("0.5", "0.02"))->cache_report()->fresh);
  make(with("0.6", "0.02"));
  const auto again = make(with("0.5", "0.02"));
  for (const GroomCacheReport::Stage& stage : again->cache_report()->stages)
    EXPECT_TRUE(stage.fresh) << stage.reason;
}

TEST_F(GroomCacheTest, OldStatesGoAndThoseInUseStay) {
  const auto with = [](int state) {
    return Coat{"- length: {value: 0.5}\n- frizz: {amplitude: 0." + std::to_string(100 + state) + "}\n",
                "frizz", 50};
  };
  const auto age = [&](int hours) {
    for (const char* kind : {"offsets", "follicles"}) {
      for (const auto& path : files(kind))
        std::filesystem::last_write_time(
            path, std::filesystem::file_time_type::clock::now() - std::chrono::hours(hours));
    }
  };
  for (int state = 0; state < 12; ++state) make(with(state));
  EXPECT_EQ(files("offsets").size(), 12u) << "none is a day old";
  age(30);
  make(with(20));
  EXPECT_EQ(files("offsets").size(), 8u);
  EXPECT_EQ(files("follicles").size(), 1u) << "the states have them in common";
  for (int state = 5; state < 12; ++state) EXPECT_TRUE(make(with(state))->cache_report()->fresh) << state;
  EXPECT_FALSE(make(with(4))->cache_report()->fresh);

  // Files of grooms that are no longer grown have no manifest that mentions them: they are removed by age
  // alone.
  age(24 * 40);
  make(Coat{"- length: {value: 0.7}\n", "length", 50, 500, 8, {}, "another"});
  EXPECT_EQ(files("offsets").size(), 1u);
  EXPECT_EQ(files("follicles").size(), 1u);
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(GroomCacheTest, GrowingStopsWhenTheUserSaysSo) {
  struct Stopped final : Progress {
    void begin(std::string_view, double) override {}
    void advance(double) override { ++leaves; }
    void end() override {}
    bool cancelled() const override { return leaves > 2; }
    std::atomic<int> leaves{0};
  } progress;
  const Coat coat{"- length: {value: 0.5}\n- frizz: {}\n", "frizz", 2000, 50};
  try {
    Groom::create("coat", params_of(coat), rest_, textures_, Job{workers_, ledger_, progress});
    ADD_FAILURE() << "grown to the end";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kStopped);
  }
  EXPECT_LT(progress.leaves, 10);
  EXPECT_TRUE(files("offsets").empty() && files("layer").empty());
  for (const auto& entry : std::filesystem::directory_iterator(cache()))
    EXPECT_FALSE(entry.path().filename().string().starts_with('.')) << entry.path();
}

TEST_F(GroomCacheTest, ImportedStrandsKeepTheirGapsAndTheirPointCounts) {
  const auto path = folder_.path() / "strands.hair";
  StrandArrays arrays;
  arrays.first_point = {0};
  TestRandom random(3);
  for (uint64_t i = 0; i < 700; ++i) {
    const V3f out = random.direction();
    const uint32_t count = 3 + static_cast<uint32_t>(i / 100 % 4);
    for (uint32_t p = 0; p < count; ++p) {
      const V3f at = out * (1.2f + 0.1f * static_cast<float>(p)) + random.direction() * 0.02f;
      arrays.points.insert(arrays.points.end(), {at.x, at.y, at.z, 0.003f * random.between(0.5f, 1)});
    }
    arrays.first_point.push_back(arrays.first_point.back() + count);
    arrays.ids.push_back(i);
  }
  write_strands(path, Strands(std::move(arrays)));
  GroomParams params =
      scene_text::read<GroomParams>("strands_file: " + path.string() + "\nleaf_strands: 300");
  params.operators = scene_text::read<OperatorList>("- frizz: {amplitude: 0.01}\n- length: {scale: 0.9}\n");
  for (const bool on_skin : {true, false}) {
    if (!on_skin) params.skin = {};
    const auto rest = on_skin ? rest_ : nullptr;
    const M44f turn = M44f().setEulerAngles(V3f(0.3f, 1, 0)) * M44f().translate(V3f(1, 2, 3));
    const LimitSurface pose = posed(0.5f, 0.1f);
    const PosedSkin skin =
        on_skin ? PosedSkin{{&pose, 1}, {}, 1.2f, {}} : PosedSkin{{}, {}, 1.2f, {&turn, 1}};
    params.cache.reset();
    const auto plain = all(*Groom::create("i", params, rest, textures_, job_), skin);
    params.cache.emplace();
    params.cache->directory.path = cache();
    params.cache->freeze.name = "length";
    const auto cold = Groom::create("i", params, rest, textures_, job_);
    const auto warm = Groom::create("i", params, rest, textures_, job_);
    EXPECT_TRUE(warm->cache_report()->fresh);
    EXPECT_EQ(bits(*cold, skin), bits(*warm, skin));
    const auto cached = all(*warm, skin);
    ASSERT_EQ(plain.size(), cached.size());
    for (size_t leaf = 0; leaf < plain.size(); ++leaf) {
      ASSERT_EQ(plain[leaf].point_count(), cached[leaf].point_count());
      for (size_t p = 0; p < plain[leaf].point_count(); ++p)
        ASSERT_LE((plain[leaf].point(p) - cached[leaf].point(p)).length(), 0.003f / 20);
    }
  }
}

TEST_F(GroomCacheTest, StrandsTooThinForSixteenBitsAreKeptInFull) {
  const Coat thin{"- length: {value: 2}\n- curl: {radius: 0.05}\n- width: {root: 0.00002, tip: 0.00001}\n",
                  "width"};
  const auto plain = all(*make(Coat{thin.operators, ""}), at_rest());
  const auto cached = all(*make(thin), at_rest());
  for (size_t leaf = 0; leaf < plain.size(); ++leaf) {
    for (size_t p = 0; p < plain[leaf].point_count(); ++p)
      ASSERT_LE((plain[leaf].point(p) - cached[leaf].point(p)).length(), 0.00002f / 20 + 3e-7f);
  }
}

TEST_F(GroomCacheTest, FreezingNamesAnOperatorThatCanBeFrozen) {
  const auto message = [&](const std::string& freeze) -> std::string {
    try {
      make(Coat{"- length: {value: 1}\n- push_out: {}\n- frizz: {}\n", freeze});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message("frizzy").find("did you mean 'frizz'"), std::string::npos) << message("frizzy");
  EXPECT_NE(message("push_out").find("cannot be frozen"), std::string::npos);
  EXPECT_NE(message("frizz").find("'push_out'"), std::string::npos);
  EXPECT_EQ(message("length"), "");
}

TEST_F(GroomCacheTest, RandomStacksKeepTheirTolerance) {
  const std::vector<std::string> choice{"- length: {scale: 0.8, variation: 0.5}\n",
                                        "- comb: {direction: [1, 0.3, 0], lift: 0.2, curve: 0.7}\n",
                                        "- bend: {direction: [0, 0, 1], angle: 80}\n",
                                        "- clump: {spacing: 0.4, amount: 0.8, strays: 0.2}\n",
                                        "- curl: {radius: 0.04, turns: 3}\n",
                                        "- frizz: {amplitude: 0.05, frequency: 4}\n",
                                        "- noise: {amplitude: 0.1, frequency: 3}\n",
                                        "- color: {value: [0.2, 0.5, 3], variation: 1}\n",
                                        "- width: {root: 0.004, tip: 0.006, profile: 3, variation: 0.9}\n"};
  TestRandom random(11);
  const LimitSurface pose = posed(1.1f, 0.2f);
  const PosedSkin skin{{&pose, 1}, {}, 0.7f, {}};
  for (int round = 0; round < 12; ++round) {
    Coat coat{"- length: {value: 1.5}\n", "frizz", 400, 150, 2 + static_cast<int>(random.unit() * 14)};
    for (int i = 0; i < 4; ++i) coat.operators += choice[static_cast<size_t>(random.unit() * 8.999f)];
    coat.operators += "- frizz: {amplitude: 0.01, frequency: 2}\n- width: {root: 0.006, tip: 0.001}\n";
    Coat uncached = coat;
    uncached.freeze.clear();
    const auto plain = all(*make(uncached), skin), cached = all(*make(coat), skin);
    for (size_t leaf = 0; leaf < plain.size(); ++leaf) {
      for (size_t p = 0; p < plain[leaf].point_count(); ++p) {
        ASSERT_LE((plain[leaf].point(p) - cached[leaf].point(p)).length(), 0.7f * 0.006f / 20)
            << coat.operators;
      }
    }
  }
}

}  // namespace
}  // namespace pelage
