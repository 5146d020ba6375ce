// SPDX-License-Identifier: Apache-2.0
#include "why/why_json.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/why/explained_scene.h"
#include "why/why_text.h"

namespace pelage {
namespace {

using nlohmann::json;

float sum_of(const json& lists, const char* key, int c) {
  float sum = 0;
  for (const json& item : lists) sum += item[key][c].get<float>();
  return sum;
}

TEST(WhyJson, SaysTheSameAsTheExplanation) {
  ExplainedScene scene({});
  int strands = 0, skins = 0, empty = 0;
  for (int x = 0; x < 24; ++x) {
    const PixelWhy why = scene.explain(x, 8);
    const json parsed = json::parse(why_json(why));  // throws if it is not JSON
    EXPECT_EQ(parsed["pixel"], json({x, 8}));
    EXPECT_EQ(parsed["samples"], why.samples);
    EXPECT_EQ(parsed["text"], why_text(why));
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(sum_of(parsed["lights"], "radiance", c), why.radiance[c], 1e-5f * why.radiance[c] + 1e-7f);
    EXPECT_EQ(parsed["cost"]["camera_rays"], why.cost.rays.camera);
    EXPECT_EQ(parsed["material"].is_null(), !why.material);
    if (why.skin) {
      ++skins;
      EXPECT_EQ(parsed["skin"]["name"], why.skin->name);
      EXPECT_TRUE(parsed["strand"].is_null() && parsed["chunk"].is_null());
      EXPECT_EQ(parsed["material"]["model"], "lambert");
      const float face =
          std::max({std::abs(why.skin->rest.x), std::abs(why.skin->rest.y), std::abs(why.skin->rest.z)});
      EXPECT_LT(face, 0.501f) << "the cube at rest";
      EXPECT_EQ(parsed["skin"]["rest"][2], why.skin->rest.z);
    } else if (why.strand) {
      ++strands;
      const json& strand = parsed["strand"];
      EXPECT_EQ(strand["id"], why.strand->id);
      EXPECT_EQ(strand["coat"], "walker.coat");
      EXPECT_EQ(strand["rest"], json({why.strand->rest.x, why.strand->rest.y, why.strand->rest.z}));
      EXPECT_EQ(strand["steps"].size(), why.strand->steps.size());
      EXPECT_EQ(strand["outline"].size(), why.strand->outline.size());
      for (int c = 0; c < 3; ++c) {
        float tip = strand["steps"][0]["after"]["tip"]["position"][c];
        for (const json& step : strand["steps"])
          tip += step.contains("moved") ? step["moved"]["tip"][c].get<float>() : 0.0f;
        EXPECT_NEAR(tip, why.strand->places().position[2][c], 1e-5f);
      }
      EXPECT_EQ(parsed["chunk"]["growths"], 1);
      EXPECT_EQ(parsed["material"]["parameters"]["diffuse"], "0.7");
    } else {
      ++empty;
      EXPECT_TRUE(parsed["depth"].is_null());
    }
  }
  EXPECT_GT(strands, 0);
  EXPECT_GT(skins, 0);
  EXPECT_GT(empty, 0);
}

}  // namespace
}  // namespace pelage
