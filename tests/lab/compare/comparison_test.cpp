// SPDX-License-Identifier: Apache-2.0
#include "lab/compare/comparison.h"

#include <gtest/gtest.h>

#include "lab/compare/contact_sheet.h"
#include "lab/compare/light_side.h"
#include "lab/compare/single_fibre.h"
#include "lab/report/canvas.h"

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
  const auto frame = [](const char* model, const char* light, int width) {
    ComparedFrame f;
    f.model = model;
    f.light = light;
    f.cpu_s = 123.4;
    f.picture = {"", width, 8, 3, std::vector<unsigned char>(static_cast<size_t>(24 * width))};
    return f;
  };
  // Where a label begins and ends.
  const auto extent = [](const Label& label) {
    const double width = text_width(label.text, label.size);
    const double left = label.x - (label.anchor == TextAnchor::kStart    ? 0
                                   : label.anchor == TextAnchor::kMiddle ? width / 2
                                                                         : width);
    return std::pair(left, left + width);
  };
  for (const int width : {8, 64, 160, 400}) {
    const Picture sheet =
        contact_sheet({frame("lambert-cylinder", "front", width), frame("lambert-cylinder", "side", width)});
    ASSERT_EQ(sheet.labels.size(), 5u);
    for (size_t i = 0; i < sheet.labels.size(); ++i) {
      const auto [left, right] = extent(sheet.labels[i]);
      EXPECT_GE(left, 0) << width;
      EXPECT_LE(right, sheet.width) << width;
      for (size_t j = 0; j < i; ++j) {
        if (std::abs(sheet.labels[i].y - sheet.labels[j].y) > sheet.labels[j].size) continue;
        const auto [other_left, other_right] = extent(sheet.labels[j]);
        EXPECT_TRUE(right < other_left || other_right < left)
            << width << ": " << sheet.labels[i].text << ", " << sheet.labels[j].text;
      }
    }
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
  EXPECT_EQ(all.labels.size(), 2u + 3u + 6u);
}

}  // namespace
}  // namespace pelage
