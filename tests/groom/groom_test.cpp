// SPDX-License-Identifier: Apache-2.0
#include "groom/groom.h"

#include <filesystem>
#include <map>
#include <numeric>

#include "base/temporary_folder.h"
#include "geom/closest_point.h"
#include "geom/curve_bounds.h"
#include "geom/io/strand_file.h"
#include "geom/tessellation.h"
#include "tests/geom/cages.h"
#include "tests/groom/cached_coats.h"
#include "tests/groom/kept_strands.h"
#include "tests/groom/operator_harness.h"
#include "tests/groom/scene_text.h"
#include "tests/support/quiet_job.h"

namespace pelage {
namespace {

class GroomTest : public OperatorTest {
 protected:
  std::shared_ptr<const Groom> grow_coat(const std::string& operators, int64_t strands = 3000, int leaf = 500,
                                         int threads = 2) {
    GroomParams params = scene_text::read<GroomParams>("skin: ball\nstrands: " + std::to_string(strands) +
                                                       "\nleaf_strands: " + std::to_string(leaf));
    params.operators = scene_text::read<OperatorList>(operators);
    return Groom::create("coat", params, rest_, textures_, QuietJob(threads, ledger_));
  }

  /// The ball turned, moved and bent a little.
  LimitSurface posed(float turn, float bend) const {
    std::vector<V3f> positions = shapes::ball_cage(1.2f).positions;
    for (V3f& p : positions) {
      const float angle = turn + bend * p.y, c = std::cos(angle), s = std::sin(angle);
      p = V3f(c * p.x + s * p.z + 3, p.y * (1 + 0.2f * bend) - 1, c * p.z - s * p.x);
    }
    return {rest_->shared_topology(), positions};
  }

  /// The points of every strand by id: 4 floats each, of all keys.
  static std::map<uint64_t, std::vector<float>> by_id(const Groom& groom, const PosedSkin& pose) {
    std::map<uint64_t, std::vector<float>> result;
    for (size_t leaf = 0; leaf < groom.follicles().leaves().size(); ++leaf) {
      const Strands strands = groom.grow(leaf, pose);
      for (size_t s = 0; s < strands.strand_count(); ++s) {
        std::vector<float>& points = result[strands.id(s)];
        EXPECT_TRUE(points.empty()) << "an id stands twice";
        for (int key = 0; key < strands.motion_keys(); ++key) {
          const auto all =
              strands.points(key).subspan(strands.first_point(s) * 4, strands.strand_points(s) * 4);
          points.insert(points.end(), all.begin(), all.end());
        }
        if (const StrandAttribute* color = strands.find_attribute("color")) {
          const size_t width =
              color->frequency == AttributeClass::kPerPoint ? 3 * strands.strand_points(s) : 3;
          const auto first = color->values.begin() + static_cast<std::ptrdiff_t>(s * width);
          points.insert(points.end(), first, first + static_cast<std::ptrdiff_t>(width));
        }
      }
    }
    return result;
  }
};

TEST_F(GroomTest, AStrandIsTheSameWhateverTheLeavesThreadsAndBatches) {
  const LimitSurface pose = posed(0.7f, 0.2f);
  const PosedSkin skin{{&pose, 1}, {}, 1, {}};
  const auto first = by_id(*grow_coat(kEveryFrozenOperator, 3000, 500, 1), skin);
  ASSERT_EQ(first.size(), 3000u);
  EXPECT_EQ(first, by_id(*grow_coat(kEveryFrozenOperator, 3000, 8000, 4), skin));
  EXPECT_EQ(first, by_id(*grow_coat(kEveryFrozenOperator, 3000, 37, 3), skin));
}

TEST_F(GroomTest, SomeStrandsAreThoseOfTheWhole) {
  const auto groom = grow_coat(kEveryFrozenOperator);
  const PosedSkin skin{{rest_.get(), 1}, {}, 1, {}};
  std::vector<uint32_t> some;
  std::vector<float> width;
  for (uint32_t s = 3; s < 290; s += 7) {
    some.push_back(s);
    width.push_back(0.5f + static_cast<float>(s));
  }
  const KeptStrands kept{some, width, {}};
  const Strands whole = groom->grow(1, skin), part = groom->grow(1, skin, &kept);
  expect_strands_of(whole, kept, part);
  const KeptStrands none;
  EXPECT_EQ(groom->grow(1, skin, &none).strand_count(), 0u);
  for (size_t s = 1; s < whole.strand_count(); ++s) EXPECT_LT(whole.id(s - 1), whole.id(s));
}

TEST_F(GroomTest, ContrastPullsVariationToItsMean) {
  const auto groom = grow_coat(
      "- color: {value: [0.9, 0.9, 0.9], variation: 0.9}\n"
      "- color: {value: [0.8, 0.4, 0.2], variation: 0.5}\n");
  const PosedSkin skin{{rest_.get(), 1}, {}, 1, {}};
  const Strands whole = groom->grow(0, skin);
  std::vector<uint32_t> all(whole.strand_count());
  std::iota(all.begin(), all.end(), 0u);
  const std::vector<float> width(all.size(), 1.0f), contrast(all.size(), 0.25f);
  const KeptStrands kept{all, width, contrast};
  const Strands pulled = groom->grow(0, skin, &kept);
  for (size_t i = 0; i < whole.strand_count(); ++i) {
    for (size_t c = 0; c < 3; ++c) {
      const float mean = 0.75f * std::array{0.8f, 0.4f, 0.2f}[c];  // of what the last operator gives
      const float before = whole.find_attribute("color")->values[3 * i + c];
      EXPECT_NEAR(pulled.find_attribute("color")->values[3 * i + c], mean + 0.25f * (before - mean), 1e-5f);
    }
  }
}

TEST_F(GroomTest, FrozenOperatorsGiveTheSameOffsetsInAnyPose) {
  const auto groom = grow_coat(kEveryFrozenOperator);
  const LimitSurface pose = posed(1.1f, 0.3f);
  const LimitSurface both[] = {*rest_, pose};
  const PosedSkin skin{both, {}, 1.7f, {}};
  float largest = 0;
  for (size_t leaf = 0; leaf < groom->follicles().leaves().size(); ++leaf) {
    const Strands strands = groom->grow(leaf, skin);
    ASSERT_EQ(strands.motion_keys(), 2);
    for (size_t s = 0; s < strands.strand_count(); ++s) {
      const RootAddress& root = strands.root(s);
      const Frame a = rest_->frame(root.face, root.u, root.v), b = pose.frame(root.face, root.u, root.v);
      const size_t first = strands.first_point(s);
      for (size_t p = 0; p < strands.strand_points(s); ++p) {
        const V3f x = a.to_local(strands.point(first + p, 0) - strands.point(first, 0));
        const V3f y = b.to_local(strands.point(first + p, 1) - strands.point(first, 1));
        largest = std::max(largest, (x - y).length());
        EXPECT_EQ(strands.radius(first + p, 0), strands.radius(first + p, 1));
      }
    }
  }
  EXPECT_LT(largest, 2e-6f * 4);  // rounding of positions about 4 from the origin
}

TEST_F(GroomTest, ConservativeBoundsContainEveryStrand) {
  TestRandom random(5);
  for (int round = 0; round < 12; ++round) {
    const auto number = [&](float low, float high) { return std::to_string(random.between(low, high)); };
    std::string operators = "- length: {value: " + number(0.1f, 1) + ", variation: " + number(0, 1) + "}\n";
    const std::vector<std::string> choice{
        "- comb: {lift: " + number(0, 1) + ", curve: " + number(0, 1) + "}\n",
        "- bend: {angle: " + number(0, 180) + ", profile: " + number(0.5f, 2) + "}\n",
        "- clump: {spacing: " + number(0.05f, 0.6f) + ", amount: " + number(0, 1) + "}\n",
        "- curl: {radius: " + number(0, 0.2f) + ", turns: " + number(-4, 4) + "}\n",
        "- frizz: {amplitude: " + number(0, 0.2f) + ", frequency: " + number(0, 10) + "}\n",
        "- noise: {amplitude: " + number(0, 0.2f) + "}\n",
        "- width: {root: " + number(0, 0.2f) + ", tip: " + number(0, 0.2f) + "}\n"};
    for (int i = 0; i < 5; ++i) operators += choice[static_cast<size_t>(random.unit() * 6.999f)];
    const auto groom = grow_coat(operators, 600, 100);
    const LimitSurface keys[] = {posed(random.unit(), 0.1f), posed(random.unit() + 1, -0.2f)};
    const PosedSkin skin{keys, {}, random.between(0.3f, 3), {}};
    for (size_t leaf = 0; leaf < groom->follicles().leaves().size(); ++leaf) {
      const Box3f bound = groom->conservative_bound(leaf, skin);
      const Box3f exact = exact_bounds(groom->grow(leaf, skin));
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(bound.min[axis], exact.min[axis]) << operators;
        EXPECT_GE(bound.max[axis], exact.max[axis]) << operators;
      }
    }
  }
}

TEST_F(GroomTest, LiveOperatorsSeeThePose) {
  const auto groom = grow_coat(
      "- length: {value: 0.5}\n- comb: {lift: 0, direction: [0, -1, 0]}\n- push_out: {offset: 0.01}\n");
  EXPECT_TRUE(groom->needs_closest_point());
  const LimitSurface keys[] = {posed(0, 0), posed(0.4f, 0.1f)};
  View view;
  view.focal_pixels = 1e9f;
  const SkinMesh mesh = tessellate(keys, view, {4, 8}, workers_);
  std::vector<ClosestPointTree> trees;
  for (int key = 0; key < 2; ++key) trees.emplace_back(mesh, key);
  const PosedSkin skin{keys, trees, 1, {}};
  for (size_t leaf = 0; leaf < groom->follicles().leaves().size(); ++leaf) {
    const Strands strands = groom->grow(leaf, skin);
    const Box3f bound = groom->conservative_bound(leaf, skin), exact = exact_bounds(strands);
    EXPECT_TRUE(bound.intersects(exact.min) && bound.intersects(exact.max));
    for (int key = 0; key < 2; ++key) {
      for (size_t p = 0; p < strands.point_count(); ++p) {
        ClosestPoint nearest;
        ASSERT_TRUE(trees[static_cast<size_t>(key)].closest(strands.point(p, key), 10, nearest));
        EXPECT_TRUE(!nearest.inside || nearest.distance < 2e-4f);
      }
    }
  }
}

TEST_F(GroomTest, ColoursTakeNoMoreThanTheyNeed) {
  const PosedSkin skin{{rest_.get(), 1}, {}, 1, {}};
  const auto frequency = [&](const std::string& operators) {
    const Strands strands = grow_coat(operators, 300, 100)->grow(0, skin);
    const StrandAttribute* color = strands.find_attribute("color");
    EXPECT_EQ(color->components, 3);
    return color->frequency;
  };
  EXPECT_EQ(frequency("- color: {value: [1, 0.5, 0.2]}\n"), AttributeClass::kConstant);
  EXPECT_EQ(frequency("- color: {value: {attribute: random}}\n"), AttributeClass::kPerStrand);
  EXPECT_EQ(frequency(kEveryFrozenOperator), AttributeClass::kPerPoint);
  EXPECT_EQ(grow_coat("- width:\n", 300, 100)->grow(0, skin).find_attribute("color"), nullptr);
}

TEST_F(GroomTest, CombinationsThatMakeNoSenseAreRefused) {
  const auto refused = [&](const std::string& text, std::shared_ptr<const LimitSurface> rest) {
    const auto params = scene_text::read<GroomParams>(text);
    try {
      Groom::create("coat", params, std::move(rest), textures_, job_);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refused("strands: 10\n", nullptr).find("needs a skin"), std::string::npos);
  EXPECT_NE(refused("skin: ball\n", rest_).find("strands"), std::string::npos);
  EXPECT_NE(refused("skin: ball\nstrands: 10\nstrands_file: a.hair\n", rest_).find("must not be given"),
            std::string::npos);
  EXPECT_NE(refused("strands_file: nowhere.hair\n", nullptr).find("nowhere.hair"), std::string::npos);
}

TEST_F(GroomTest, FieldsMayReadTheRandomNumbersOfStrandsAndClumps) {
  const auto groom = grow_coat(
      "- length: {value: {product: [0.5, {attribute: random}]}}\n- clump: {spacing: 0.2}\n"
      "- width: {root: {product: [0.1, {attribute: clump}]}}\n");
  const PosedSkin skin{{rest_.get(), 1}, {}, 1, {}};
  const Strands strands = groom->grow(0, skin);
  float longest = 0, widest = 0;
  for (size_t s = 0; s < strands.strand_count(); ++s) {
    longest = std::max(longest, (strands.point(8 * s + 7) - strands.point(8 * s)).length());
    widest = std::max(widest, strands.radius(8 * s));
  }
  EXPECT_GT(longest, 0.4f);
  EXPECT_LE(longest, 0.5f);
  EXPECT_GT(widest, 0.04f);
  EXPECT_LE(widest, 0.05f);
  EXPECT_LT(groom->conservative_bound(0, skin).size().x, 10);
  try {
    grow_coat("- color:\n- width: {root: {attribute: color}}\n");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("'width' has no upper limit"), std::string::npos);
    EXPECT_EQ(error.problems().front().position.line, 3);
  }
}

TEST_F(GroomTest, ImportedStrandsFollowTheSkin) {
  // A coat written to a file and read back grows as itself, on the rest skin and, to the rounding of the
  // binding to triangles, in a pose.
  const TemporaryFolder folder;
  const auto path = folder.path() / "coat.hair";
  const auto original = grow_coat("- length: {value: 0.4}\n- comb:\n- width:\n", 400, 400);
  const LimitSurface pose = posed(0.9f, 0.2f);
  const LimitSurface keys[] = {*rest_, pose};
  const PosedSkin skin{keys, {}, 1, {}};
  const Strands expected = original->grow(0, skin);
  write_strands(path, expected);
  GroomParams params = scene_text::read<GroomParams>("skin: ball\nleaf_strands: 60");
  params.strands_file = {path, {}};
  const auto imported = Groom::create("imported", params, rest_, textures_, job_);
  ASSERT_EQ(imported->follicles().size(), 400u);
  EXPECT_GT(imported->follicles().leaves().size(), 5u);
  for (size_t leaf = 0; leaf < imported->follicles().leaves().size(); ++leaf) {
    const Strands strands = imported->grow(leaf, skin);
    const Box3f bound = imported->conservative_bound(leaf, skin), exact = exact_bounds(strands);
    EXPECT_TRUE(bound.intersects(exact.min) && bound.intersects(exact.max));
    for (size_t s = 0; s < strands.strand_count(); ++s) {
      const auto i = static_cast<size_t>(strands.id(s));  // the order of the file
      for (size_t p = 0; p < 8; ++p) {
        EXPECT_LT((strands.point(s * 8 + p, 0) - expected.point(i * 8 + p, 0)).length(), 1e-5f);
        EXPECT_LT((strands.point(s * 8 + p, 1) - expected.point(i * 8 + p, 1)).length(), 0.02f);
      }
    }
  }
}

struct WarningLog final : Progress {
  void begin(std::string_view, double) override {}
  void advance(double) override {}
  void end() override {}
  void warn(std::string_view line) override { lines.emplace_back(line); }
  bool cancelled() const override { return false; }
  std::vector<std::string> lines;
};

// A file in another unit or of another character is rendered where it is, with a warning.
TEST_F(GroomTest, StrandsFarFromTheirSkinStayWhereTheyAre) {
  const TemporaryFolder folder;
  const auto original = grow_coat("- length: {value: 0.4}\n- width:\n", 60, 400);
  const Strands near = original->grow(0, {{rest_.get(), 1}, {}, 1, {}});
  const float size = rest_->control_bounds().size().length();
  for (const float away : {0.05f * size, 100.0f}) {
    const auto path = folder.path() / "coat.hair";
    StrandArrays moved = near.arrays();
    for (size_t i = 0; i < moved.points.size(); i += 4) moved.points[i] += away;
    const Strands in_file(std::move(moved));
    write_strands(path, in_file);
    for (const char* attach : {"auto", "skin", "none"}) {
      GroomParams params = scene_text::read<GroomParams>(std::string("skin: ball\nattach: ") + attach);
      params.strands_file = {path, {"scene.yaml", 7, 3}};
      WarningLog log;
      const std::vector<std::string>& warnings = log.lines;
      const auto groom = Groom::create("g", params, rest_, textures_, Job{workers_, ledger_, log});
      const bool is_far = away == 100 && *attach == 'a';
      EXPECT_EQ(groom->grows_on_skin(), *attach != 'n' && !is_far) << away << attach;
      ASSERT_EQ(warnings.size(), is_far ? 1u : 0u) << away << attach;
      if (is_far) {
        EXPECT_EQ(warnings[0].find("scene.yaml:7:3: the strands of coat.hair begin 9"), 0u) << warnings[0];
        EXPECT_NE(warnings[0].find("units from skin 'ball', which is"), std::string::npos) << warnings[0];
      }
      // At rest all of them lie where the file puts them.
      const PosedSkin rest =
          groom->grows_on_skin() ? PosedSkin{{rest_.get(), 1}, {}, 1, {}} : PosedSkin{{}, {}, 1, {}};
      const Strands strands = groom->grow(0, rest);
      ASSERT_EQ(strands.point_count(), in_file.point_count());
      for (size_t s = 0; s < strands.strand_count(); ++s) {
        for (size_t p = 0; p < 8; ++p) {
          EXPECT_LT((strands.point(8 * s + p) - in_file.point(8 * strands.id(s) + p)).length(), 1e-4f);
        }
      }
    }
  }
}

TEST_F(GroomTest, StrandsOfAFileNeedAFaceToFollow) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "coat.hair";
  write_strands(path, grow_coat("- length:\n- width:\n", 20, 400)->grow(0, {{rest_.get(), 1}, {}, 1, {}}));
  ControlMesh holes = cube_cage();
  holes.holes = {0, 1, 2, 3, 4, 5};
  const auto rest = std::make_shared<const LimitSurface>(
      SurfaceTopology::create(holes, SubdivisionScheme::kCatmullClark, BoundaryRule::kEdgeAndCorner, "test"),
      holes.positions);
  GroomParams params = scene_text::read<GroomParams>("skin: ball");
  params.strands_file = {path, {"scene.yaml", 7, 3}};
  EXPECT_FALSE(Groom::create("g", params, rest, textures_, job_)->grows_on_skin());
  params.attach = Attachment::kSkin;
  try {
    Groom::create("g", params, rest, textures_, job_);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.problems().front().position.line, 7);
  }
  EXPECT_THROW(Groom::create("g", params, nullptr, textures_, job_), Error);
}

TEST_F(GroomTest, FreeStrandsGoWhereTheyAreTaken) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "coat.hair";
  const auto original = grow_coat("- length: {value: 0.4}\n- width:\n", 100, 400);
  const Strands expected = original->grow(0, {{rest_.get(), 1}, {}, 1, {}});
  write_strands(path, expected);
  GroomParams params;
  params.strands_file = {path, {}};
  const auto free = Groom::create("free", params, nullptr, textures_, job_);
  const Strands still = free->grow(0, {});
  EXPECT_FALSE(still.has_roots());
  M44f transform;
  transform.rotate(V3f(0.3f, 0.5f, 0.1f));
  transform *= M44f().setScale(2.0f);
  transform *= M44f().setTranslation(V3f(1, 2, 3));
  const PosedSkin pose{{}, {}, 2, {&transform, 1}};
  const Strands moved = free->grow(0, pose);
  const Box3f bound = free->conservative_bound(0, pose), exact = exact_bounds(moved);
  EXPECT_TRUE(bound.intersects(exact.min) && bound.intersects(exact.max));
  for (size_t p = 0; p < expected.point_count(); ++p) {
    EXPECT_LT((still.point(p) - expected.point(p)).length(), 1e-5f);
    EXPECT_LT((moved.point(p) - expected.point(p) * transform).length(), 1e-5f);
    EXPECT_NEAR(moved.radius(p), 2 * expected.radius(p), 1e-6f);
  }
}

}  // namespace
}  // namespace pelage
