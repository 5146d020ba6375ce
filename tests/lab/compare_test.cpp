// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "lab/compare/comparison.h"
#include "lab/compare/contact_sheet.h"
#include "lab/compare/light_side.h"
#include "lab/compare/single_fibre.h"

namespace pelage {
namespace {

TEST(Compare, NoModelIsComparedWithItself) {
  const auto frame = [](const char* model, double luminance) {
    ComparedFrame f;
    f.model = model;
    f.light = "front";
    f.cpu_s = 1;
    f.luminance = luminance;
    f.picture = {"", 8, 8, 3, std::vector<unsigned char>(192)};
    return f;
  };
  const auto abstract = [&](std::vector<ComparedFrame> frames) {
    Comparison comparison;
    comparison.frames = std::move(frames);
    return comparison_report(comparison, SceneDescription()).abstract;
  };
  EXPECT_EQ(abstract({frame("chiang", 1)}), "1 picture of 1 model.");
  EXPECT_EQ(abstract({frame("chiang", 1), frame("yan", 0.5)}),
            "2 pictures of 2 models. In light from the front the fur of yan is the darkest, 0.50 times as "
            "bright as that of chiang; that of chiang is the brightest.");
  EXPECT_EQ(abstract({frame("marschner", 2), frame("chiang", 1)}),
            "2 pictures of 2 models. In light from the front the fur of chiang is the darkest; that of "
            "marschner is the brightest, 2.00 times as bright as that of chiang.");
  EXPECT_EQ(abstract({frame("yan", 1), frame("yan-fast", 2)}), "2 pictures of 2 models.");
}

TEST(ContactSheet, TitlesOfSmallPicturesDoNotOverlap) {
  // Small pictures in two columns: what is drawn for the right one must not depend on the left one's titles.
  const auto frame = [](const char* model, const char* light, int width) {
    ComparedFrame f;
    f.model = model;
    f.light = light;
    f.cpu_s = 123.4;
    f.picture = {"", width, 8, 3, std::vector<unsigned char>(static_cast<size_t>(24 * width))};
    return f;
  };
  for (const int width : {8, 64, 160, 400}) {
    const Picture both =
        contact_sheet({frame("lambert-cylinder", "front", width), frame("lambert-cylinder", "side", width)});
    const Picture one = contact_sheet({frame("lambert-cylinder", "front", width)});
    ASSERT_EQ(both.height, one.height);
    ASSERT_LE(one.width, both.width);
    // The first column, up to the gap behind it, is the same whether or not there is another.
    for (int y = 0; y < one.height; ++y) {
      const auto row = [&](const Picture& p) { return p.pixels.begin() + std::ptrdiff_t{3} * y * p.width; };
      ASSERT_TRUE(std::equal(row(one), row(one) + 3 * (one.width - 6), row(both))) << width << ", row " << y;
    }
    // Name and figures stand apart: a gap of ground between them.
    int longest_gap = 0, gap = 0;
    for (int x = 8; x < one.width; ++x) {
      bool ground = true;
      for (int y = 36; y < 58; ++y)
        ground &= one.pixels[static_cast<size_t>(3 * (y * one.width + x))] == one.pixels[0];
      gap = ground ? gap + 1 : 0;
      longest_gap = std::max(longest_gap, gap);
    }
    EXPECT_GE(longest_gap, 7) << width;
  }
}

TEST(LightSide, StandsWhereItSays) {
  CameraParams camera;
  camera.position = Keyed<V3f>(V3f(0, 0, 10));
  camera.look_at = Keyed<V3f>(V3f(0, 0, 0));
  for (const LightSide& side : kLightSides) {
    const auto lights = lights_from(side, camera, 1);
    const auto& lamp = std::get<SphereLightParams>(lights.items.at(0).value);
    const V3f at = lamp.position.at(1);
    EXPECT_NEAR(at.length(), 10, 1e-4);
    EXPECT_LT(at.x, 0);  // to the left of the camera
    EXPECT_GT(at.y, 0);
    EXPECT_EQ(at.z < 0, std::string(side.name) == "back");
  }
}

TEST(SingleFibre, PhysicalModelsAreCloserToTracedLightThanOpaqueOnes) {
  const Workers workers(2);
  MemoryLedger ledger;
  NoProgress progress;
  const Job job{workers, ledger, progress};
  const SingleFibre chiang = compare_single_fibre("chiang", ChiangParams{}, job),
                    opaque = compare_single_fibre("lambert-cylinder", LambertCylinderParams{}, job);
  EXPECT_LT(chiang.azimuth_distance(), 0.05);
  EXPECT_GT(opaque.azimuth_distance(), 0.5);
  EXPECT_NEAR(chiang.white_across, 1, 1e-3);
  EXPECT_NEAR(chiang.white_slanted, 1, 1e-3);
  const Picture sheet = single_fibre_sheet({chiang, opaque});
  EXPECT_EQ(sheet.pixels.size(), 3u * static_cast<size_t>(sheet.width) * static_cast<size_t>(sheet.height));
}

TEST(ContactSheet, HasARowPerModelAndAColumnPerLight) {
  ComparedFrame frame;
  frame.picture = {"", 8, 4, 3, std::vector<unsigned char>(8 * 4 * 3, 200)};
  std::vector<ComparedFrame> frames;
  for (const char* model : {"a", "b", "c"}) {
    for (const char* light : {"front", "back"}) {
      frame.model = model;
      frame.light = light;
      frames.push_back(frame);
    }
  }
  const Picture all = contact_sheet(frames);
  frames.pop_back();
  const Picture fewer = contact_sheet(frames);
  EXPECT_EQ(all.width, fewer.width);
  EXPECT_EQ(all.height, fewer.height);
  EXPECT_NE(all.pixels, fewer.pixels);
  const Picture half = halved(all);
  EXPECT_EQ(half.width, all.width / 2);
}

}  // namespace
}  // namespace pelage
