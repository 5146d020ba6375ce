// SPDX-License-Identifier: Apache-2.0
#include "why/pixel_why.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "base/temporary_folder.h"
#include "tests/support/effort.h"
#include "tests/why/explained_scene.h"
#include "why/why_picture.h"
#include "why/why_text.h"

namespace pelage {
namespace {

const std::vector<Override> kBase{{"grooms.coat.operators",
                                   "[{length: {value: 0.4}}, {comb: {direction: [0, -1, 0], lift: 0.3}}, "
                                   "{noise: {amplitude: 0.05}}, {push_out: {}}, {width: {root: 0.02, tip: "
                                   "0.005}}, {color: {value: [0.6, 0.3, 0.1], variation: 0.4}}]"},
                                  {"materials.fur.color", "{attribute: color}"},
                                  {"grooms.coat.strands", "1500"}};

std::vector<Override> with(const std::vector<Override>& more) {
  std::vector<Override> all = kBase;
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// Terms of light, and the steps of a strand, add up.
void expect_sums(const PixelWhy& why) {
  Rgb sum(0);
  for (const LightTerm& term : why.lights) sum += term.radiance;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], why.radiance[c], 1e-5f * why.radiance[c] + 1e-7f);
  uint32_t samples = 0;
  for (const SeenCount& seen : why.seen) samples += seen.samples;
  EXPECT_EQ(samples, why.samples);
  if (!why.strand) return;
  const std::vector<StepWhy>& steps = why.strand->steps;
  for (size_t place = 0; place < 3; ++place) {
    V3f end = steps.front().after.position[place];
    for (size_t i = 1; i < steps.size(); ++i)
      end += steps[i].after.position[place] - steps[i - 1].after.position[place];
    EXPECT_LT((end - why.strand->places().position[place]).length(), 1e-5f);
  }
}

struct Counts {
  int strands = 0, skins = 0, empty = 0;
};

constexpr int kEvery = kSanitized ? 2 : 1;

/// Explains one in kEvery pixels, and compares them with the layers of the picture.
Counts check_all(ExplainedScene& scene) {
  const Film& film = scene.picture.film;
  Counts counts;
  for (int y = 0; y < film.height(); ++y) {
    for (int x = 0; x < film.width(); ++x) {
      if ((x + y) % kEvery != 0) continue;
      SCOPED_TRACE(std::to_string(x) + " " + std::to_string(y));
      const PixelWhy why = scene.explain(x, y);
      const VisibleSurface& seen = film.surface(x, y);
      EXPECT_EQ(why.radiance, film.radiance(x, y)) << "the same samples";
      EXPECT_EQ(why.samples, film.samples(x, y));
      expect_sums(why);
      EXPECT_EQ(why.strand ? static_cast<uint32_t>(why.strand->id) : kNoStrand, seen.id);
      EXPECT_EQ(why.skin.has_value(), seen.id == kNoStrand && std::isfinite(seen.depth));
      EXPECT_EQ(why.material.has_value(), std::isfinite(seen.depth));
      EXPECT_FALSE(why_text(why).empty());
      if (why.strand) {
        ++counts.strands;
        EXPECT_EQ(why.strand->root_uv, seen.root_uv);
        EXPECT_EQ(why.material->name, "fur");
        EXPECT_TRUE(why.chunk && why.chunk->strands > 0);
      } else {
        (why.skin ? counts.skins : counts.empty) += 1;
      }
      if (testing::Test::HasFailure()) return counts;
    }
  }
  return counts;
}

TEST(PixelWhy, EveryPixelIsThatOfThePictureAndAddsUp) {
  for (const char* integrator : {"path", "gather"}) {
    ExplainedScene scene(with({{"render.integrator", integrator}, {"render.samples", "6"}}));
    const Counts counts = check_all(scene);
    EXPECT_GT(kEvery * counts.strands, 20) << integrator;
    EXPECT_GT(kEvery * counts.skins, 2);
    EXPECT_GT(kEvery * counts.empty, 20);
  }
}

TEST(PixelWhy, SplattedSamplesLensAndSemiTransparentFur) {
  ExplainedScene scene(with({{"render.integrator", "path"},
                             {"image.filter_samples", "splatted"},
                             {"camera.lens", "{f_stop: 2, focal_length: 5, focus_distance: 8}"},
                             {"materials.fur.opacity", "0.5"}}));
  EXPECT_GT(kEvery * check_all(scene).strands, 20);
}

/// Returns an explained strand in the middle of the picture.
PixelWhy some_strand(ExplainedScene& scene) {
  for (int y = scene.scene.image.height / 2; y < scene.scene.image.height; ++y) {
    for (int x = 0; x < scene.scene.image.width; ++x) {
      PixelWhy why = scene.explain(x, y);
      if (why.strand) return why;
    }
  }
  ADD_FAILURE() << "no strand";
  return {};
}

std::vector<std::string> step_names(const StrandWhy& strand) {
  std::vector<std::string> names;
  for (const StepWhy& step : strand.steps) names.push_back(step.name);
  return names;
}

const std::vector<std::string> kSteps{"follicle", "length", "comb",  "noise",
                                      "push_out", "width",  "color", "stored"};

TEST(PixelWhy, ExplainsTheGrowthOfAStrand) {
  ExplainedScene scene(kBase);
  const PixelWhy why = some_strand(scene);
  const StrandWhy& strand = *why.strand;
  EXPECT_EQ(strand.coat, "walker.coat");
  EXPECT_EQ(step_names(strand), kSteps);
  EXPECT_FALSE(strand.lod);
  EXPECT_TRUE(strand.root);
  const auto width = [&](size_t step, size_t place) { return strand.steps[step].after.width[place]; };
  EXPECT_EQ(width(4, 0), 0) << "before the operator width";
  EXPECT_NEAR(width(5, 0), 2 * 0.02f, 1e-6f) << "the character has the scale 2";
  EXPECT_NEAR(width(5, 2), 2 * 0.005f, 1e-6f);
  EXPECT_EQ(strand.steps[5].after.color, strand.steps[4].after.color);
  EXPECT_NE(strand.steps[6].after.color, strand.steps[5].after.color);
  EXPECT_NEAR(strand.steps[1].after.length, 2 * 0.4f, 1e-4f);
  // The character is twice as large as its skin at rest, and moved by (.., 1, 0).
  const V3f& root = strand.steps[0].after.position[0];
  EXPECT_NEAR(root.y, 2 * strand.rest.y + 1, 1e-5f);
  EXPECT_NEAR(root.z, 2 * strand.rest.z, 1e-5f);
  EXPECT_NE(why_text(why).find("rest position of the root: "), std::string::npos);
  // Only rounding is left for the last step.
  const StrandPlaces &last = strand.places(), &grown = strand.steps[6].after;
  for (size_t place = 0; place < 3; ++place) {
    EXPECT_LT((last.position[place] - grown.position[place]).length(), 2e-3f);
    EXPECT_NEAR(last.width[place], grown.width[place], 0.02f * grown.width[place]);
  }
  // The line in the picture passes the pixel.
  float nearest = 1e9f;
  for (const V2f& point : strand.outline)
    nearest = std::min(
        nearest, (point - V2f(static_cast<float>(why.x) + 0.5f, static_cast<float>(why.y) + 0.5f)).length());
  EXPECT_LT(nearest, 2.5f);
}

TEST(PixelWhy, AGroomWithACacheHasTheSameSteps) {
  ExplainedScene plain(kBase);
  const TemporaryFolder folder;
  ExplainedScene cached(
      with({{"grooms.coat.cache", "{directory: " + folder.path().string() + ", freeze: noise}"}}));
  const PixelWhy a = some_strand(plain), b = some_strand(cached);
  ASSERT_EQ(a.strand->id, b.strand->id);
  EXPECT_EQ(step_names(*b.strand), kSteps);
  for (size_t i = 0; i + 1 < kSteps.size(); ++i)
    EXPECT_EQ(a.strand->steps[i].after.position, b.strand->steps[i].after.position) << kSteps[i];
  expect_sums(b);
}

TEST(PixelWhy, ExplainsTheLevelOfDetail) {
  ExplainedScene scene(with({{"render.lod", "{enabled: true, quality: 0.2}"}}));
  const PixelWhy why = some_strand(scene);
  ASSERT_TRUE(why.strand->lod);
  const LodWhy& lod = *why.strand->lod;
  EXPECT_LT(lod.measures.share, 1);
  EXPECT_LT(lod.priority, lod.measures.share + Simplification::fade_half_width(lod.measures.share));
  EXPECT_GT(lod.width, 1) << "kept strands are wider";
  const auto& steps = why.strand->steps;
  EXPECT_NEAR(steps.back().after.width[0], lod.width * steps[steps.size() - 2].after.width[0],
              0.02f * steps.back().after.width[0]);
  EXPECT_NE(why_text(why).find("level of detail: kept"), std::string::npos);
}

TEST(PixelWhy, CountsGrowthsOfAChunk) {
  ExplainedScene scene({{"grooms.coat.operators", "[{length: {value: 0.4}}, {width: {root: 0.02}}]"},
                        {"grooms.coat.strands", "20000"},
                        {"grooms.coat.points", "16"},
                        {"grooms.coat.leaf_strands", "500"},
                        {"render.integrator", "path"}});  // `gather` traces the whole tile of a pixel
  const PixelWhy first = some_strand(scene);
  EXPECT_GT(first.cost.strands_grown, 0);
  EXPECT_LE(first.chunk->strands, 500u);
  for (int x = 0; x < scene.scene.image.width; ++x) {
    const PixelWhy why = scene.explain(x, 8);
    if (!why.chunk) continue;
    EXPECT_EQ(why.chunk->growths, 1u) << "all chunks fit the memory";
  }
  const PixelWhy again = scene.explain(first.x, first.y);
  EXPECT_EQ(again.radiance, first.radiance);
  EXPECT_EQ(again.cost.strands_grown, 0);
  EXPECT_GE(again.cost.rays.camera, again.samples);
}

TEST(PixelWhy, LeavesTheSettingsOfThePictureAlone) {
  ExplainedScene scene(
      with({{"render.adaptive", "{}"}, {"render.samples", "20"}, {"image.light_layers", "false"}}));
  const PixelWhy why = scene.explain(12, 8);
  EXPECT_TRUE(why.is_adaptive);
  EXPECT_EQ(why.samples, 20u) << "all that the picture may take";
  EXPECT_TRUE(scene.world.scene.render.adaptive);
  EXPECT_FALSE(scene.world.scene.image.light_layers || scene.world.scene.image.event_layers);
  expect_sums(why);
}

TEST(PixelWhy, APixelOutsideThePictureIsOneLine) {
  ExplainedScene scene(kBase);
  for (const auto& [x, y] : {std::pair(24, 0), std::pair(0, 16), std::pair(-1, 3), std::pair(3, -1)}) {
    try {
      scene.explain(x, y);
      FAIL() << x << " " << y;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kArguments);
      EXPECT_EQ(error.what(),
                "pixel " + std::to_string(x) + " " + std::to_string(y) + ": the picture has 24 x 16 pixels");
    }
  }
}

TEST(PixelWhy, ThePictureShowsTheStrand) {
  ExplainedScene scene(kBase);
  const PixelWhy why = some_strand(scene);
  const ExplainedFrame frame{scene.scene, *scene.assets, scene.world, scene.geometry, &scene.fur};
  const DisplayImage picture = why_picture(frame, why, scene.job);
  PixelWhy without = why;
  without.strand.reset();
  const DisplayImage plain = why_picture(frame, without, scene.job);
  EXPECT_GE(picture.width, 640);
  ASSERT_EQ(picture.pixels.size(), static_cast<size_t>(picture.width * picture.height * 3));
  ASSERT_EQ(plain.pixels.size(), picture.pixels.size());  // both are the whole picture
  // Where the strand is, and nowhere else, is its colour.
  const float scale = static_cast<float>(picture.width) / static_cast<float>(scene.scene.image.width);
  size_t drawn = 0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const size_t at = 3 * static_cast<size_t>(y * picture.width + x);
      if (std::equal(&picture.pixels[at], &picture.pixels[at] + 3, &plain.pixels[at])) continue;
      ++drawn;
      const V2f place((static_cast<float>(x) + 0.5f) / scale, (static_cast<float>(y) + 0.5f) / scale);
      float nearest = 1e9f;
      for (const V2f& point : why.strand->outline) nearest = std::min(nearest, (point - place).length());
      EXPECT_LT(nearest, 0.6f) << x << " " << y;
    }
  }
  EXPECT_GT(drawn, 100u);
}

}  // namespace
}  // namespace pelage
