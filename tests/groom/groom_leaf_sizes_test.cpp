// SPDX-License-Identifier: Apache-2.0
// How a coat is cut into leaves changes no bit of any strand, also where it passes through a cache.
#include <bit>
#include <fstream>

#include "geom/io/strand_file.h"
#include "tests/groom/cached_coats.h"

namespace pelage {
namespace {

class GroomLeafSizesTest : public CachedCoatTest {
 protected:
  using Curves = std::map<uint64_t, std::vector<uint32_t>>;

  template <class Values>
  static void append_bits(const Values& values, std::vector<uint32_t>& bits) {
    for (const float value : values) bits.push_back(std::bit_cast<uint32_t>(value));
  }
  /// Every bit of every strand.
  static Curves curves(const Groom& groom, const PosedSkin& pose) {
    Curves result;
    for (const Strands& strands : all(groom, pose)) {
      for (size_t s = 0; s < strands.strand_count(); ++s) {
        std::vector<uint32_t>& curve = result[strands.id(s)];
        const size_t first = strands.first_point(s), count = strands.strand_points(s);
        for (int key = 0; key < strands.motion_keys(); ++key) {
          append_bits(strands.points(key).subspan(first * 4, count * 4), curve);
        }
        for (const StrandAttribute& attribute : strands.attributes()) {
          const bool per_point = attribute.frequency == AttributeClass::kPerPoint;
          const bool constant = attribute.frequency == AttributeClass::kConstant;
          const auto width = static_cast<size_t>(attribute.components);
          append_bits(std::span(attribute.values)
                          .subspan((per_point  ? first
                                    : constant ? 0
                                               : s) *
                                       width,
                                   (per_point ? count : 1) * width),
                      curve);
        }
      }
    }
    return result;
  }

  /// Grows the coat in leaves of many sizes: into a cache, from it, and where nothing can be stored.
  void expect_equal(GroomParams params, const PosedSkin& pose) {
    Curves first;
    for (const int leaf : {1, 37, 300, 500, 4000, 1000000}) {
      params.leaf_strands = leaf;
      std::filesystem::remove_all(cache());
      const auto cold = Groom::create("coat", params, rest_, textures_, job_);
      const auto warm = Groom::create("coat", params, rest_, textures_, job_);
      ASSERT_TRUE(cold->cache_report()->stored);
      ASSERT_TRUE(warm->cache_report()->fresh);
      std::filesystem::remove_all(cache());
      std::ofstream(cache()) << "a file, not a folder";
      const auto kept = Groom::create("coat", params, rest_, textures_, job_);
      ASSERT_FALSE(kept->cache_report()->stored);
      if (first.empty()) first = curves(*cold, pose);
      EXPECT_TRUE(first == curves(*cold, pose)) << leaf;
      EXPECT_TRUE(first == curves(*warm, pose)) << leaf;
      EXPECT_TRUE(first == curves(*kept, pose)) << leaf;
    }
    EXPECT_GT(first.size(), 500u);
  }
};

TEST_F(GroomLeafSizesTest, EveryOperator) {
  const LimitSurface pose = posed(0.7f, 0.2f);
  const LimitSurface both[] = {*rest_, pose};
  const PosedSkin moving{both, {}, 1.3f, {}, 0.8f};
  for (const char* freeze : {"clump", "color"})
    expect_equal(params_of({kEveryFrozenOperator, freeze, 900}), moving);
}

// Codes that hold some strands and not others, and colours and widths that are one profile here and not
// there.
TEST_F(GroomLeafSizesTest, StrandsOfManyKindsBesideEachOther) {
  const auto ramp = [](const char* along, const char* knots) {
    return std::string("{ramp: {along: ") + along + ", knots: " + knots + "}}";
  };
  const std::string step = "[[-1, 0.000004], [0, 0.000004], [0, 0.01], [1, 0.02]]";
  const std::string north = ramp("y", "[[-1, 0], [0.2, 0], [0.2, 1], [1, 1]]");
  const std::vector<std::string> stacks{
      "- length: {value: 0.5, variation: 0.9}\n- curl: {radius: 0.05}\n- width: {root: " +
          ramp("y", step.c_str()) + ", tip: 0.000002}\n",
      "- length: {value: 0.5}\n- clump: {spacing: 0.5, amount: " + north +
          "}\n- width: {root: {product: [0.02, " + north + "]}, tip: 0}\n- color: {value: {product: [" +
          ramp("x", "[[-1, [-1, 0, 2]], [1, [0.3, 0, 1000000000]]]") + ", " +
          ramp("strand", "[[0, 1], [1, 0]]") + "]}}\n",
      "- length: {value: 0.5}\n- color: {value: {product: [{attribute: random}, " +
          ramp("z", "[[-1, [1, 0.2, 0]], [0, [0, 0, 0]], [1, [0.1, 0.2, 0.9]]]") + "]}, variation: 0.7}\n"};
  for (const std::string& stack : stacks) {
    const bool colored = stack.find("color") != std::string::npos;
    expect_equal(params_of({stack, colored ? "color" : "width", 900}), at_rest());
  }
}

TEST_F(GroomLeafSizesTest, StrandsOfAFileThatHaveUnequallyManyPoints) {
  const auto path = folder_.path() / "strands.hair";
  StrandArrays arrays;
  arrays.first_point = {0};
  TestRandom random(5);
  for (uint64_t i = 0; i < 700; ++i) {
    const V3f out = random.direction();
    const auto count = 1 + static_cast<uint32_t>(random.unit() * 6.99f);
    const float thin = random.unit() < 0.1f ? 1e-7f : 3e-3f;
    for (uint32_t p = 0; p < count; ++p) {
      const V3f at = out * (1.2f + 0.1f * static_cast<float>(p)) + random.direction() * 0.02f;
      arrays.points.insert(arrays.points.end(), {at.x, at.y, at.z, thin * random.between(0.5f, 1)});
    }
    arrays.first_point.push_back(arrays.first_point.back() + count);
    arrays.ids.push_back(i);
  }
  write_strands(path, Strands(std::move(arrays)));
  for (const char* color :
       {"{ramp: {along: strand, knots: [[0, [1, 0, 0]], [1, [0, 1, 0.5]]]}}", "[0.2, 0.5, 0.3]"}) {
    GroomParams params = scene_text::read<GroomParams>("skin: ball\nstrands_file: " + path.string());
    params.operators = scene_text::read<OperatorList>(
        "- length: {scale: 0.9}\n- color: {value: " + std::string(color) + ", variation: 0.4}\n");
    params.cache.emplace();
    params.cache->directory.path = cache();
    params.cache->freeze.name = "color";
    expect_equal(params, at_rest());
  }
}

}  // namespace
}  // namespace pelage
