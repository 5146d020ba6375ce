// SPDX-License-Identifier: Apache-2.0
#include "render/light/light_params.h"

#include <gtest/gtest.h>

#include "image/texture_library.h"
#include "render/light/environment_map.h"
#include "render/material/material.h"
#include "tests/render/random.h"
#include "tests/support/data.h"

namespace pelage::light_params_test {
namespace {

Value number(float v) { return Value::scalar({"scene.yaml", 3, 5}, std::to_string(v)); }
Value text(std::string v) { return Value::scalar({"scene.yaml", 3, 5}, std::move(v)); }
Value list(std::vector<float> numbers) {
  std::vector<Value> items;
  for (float v : numbers) items.push_back(number(v));
  return Value::list({"scene.yaml", 3, 5}, std::move(items));
}
Value block(std::vector<std::pair<std::string, Value>> keys) {
  std::vector<Value::Entry> entries;
  for (auto& [key, value] : keys) {
    Value::Entry entry;
    entry.key = key;
    entry.key_position = {"scene.yaml", 3, 1};
    entry.value = std::move(value);
    entries.push_back(std::move(entry));
  }
  return Value::map({"scene.yaml", 2, 1}, std::move(entries));
}

std::unique_ptr<Light> light_of(const Value& value, double frame = 1) {
  Problems problems;
  LightParams params;
  ValueReader<LightParams>::read(value, {}, params, problems);
  problems.throw_if_any();
  static MemoryLedger ledger;
  TextureLibrary textures(ledger);
  return make_light("key", params, frame, textures, ledger);
}

TEST(LightParams, RectanglesFaceWhatTheyLookAt) {
  const auto light = light_of(block({{"type", text("rectangle")},
                                     {"position", list({0, 4, 0})},
                                     {"look_at", list({0, 0, 0})},
                                     {"size", list({2, 1})},
                                     {"radiance", list({3, 2, 1})},
                                     {"intensity", number(2)}}));
  EXPECT_EQ(light->name(), "key");
  EXPECT_FALSE(light->visible());
  // Straight down, with `up` along the line of sight: some orientation, but not none.
  const auto hit = light->intersect(V3f(0.1f, 0, 0.1f), V3f(0, 1, 0));
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->distance, 4);
  EXPECT_EQ(hit->radiance, Rgb(6, 4, 2));
  EXPECT_FALSE(light->intersect(V3f(0, 8, 0), V3f(0, -1, 0)));
}

TEST(LightParams, WidthIsAcrossUp) {
  const auto light = light_of(block({{"type", text("rectangle")},
                                     {"position", list({0, 0, 5})},
                                     {"look_at", list({0, 0, 0})},
                                     {"size", list({4, 1})}}));
  EXPECT_TRUE(light->intersect(V3f(1.9f, 0, 0), V3f(0, 0, 1)));
  EXPECT_TRUE(light->intersect(V3f(0, 0.4f, 0), V3f(0, 0, 1)));
  EXPECT_FALSE(light->intersect(V3f(0, 0.6f, 0), V3f(0, 0, 1)));
}

TEST(LightParams, LightsMoveWithTheFrame) {
  const Value keys = block({{"keys", block({{"1", list({0, 0, 0})}, {"11", list({10, 0, 0})}})}});
  const Value sphere = block({{"type", text("sphere")}, {"position", keys}, {"radius", number(0.5f)}});
  EXPECT_TRUE(light_of(sphere, 6)->intersect(V3f(5, 3, 0), V3f(0, -1, 0)));
  EXPECT_FALSE(light_of(sphere, 1)->intersect(V3f(5, 3, 0), V3f(0, -1, 0)));
}

TEST(LightParams, EnvironmentsWithoutFileAreConstant) {
  const auto light = light_of(block({{"type", text("environment")}, {"radiance", number(0.25f)}}));
  EXPECT_TRUE(light->visible());
  EXPECT_EQ(light->intersect(V3f(0), V3f(0, 1, 0))->radiance, Rgb(0.25f));
}

TEST(LightParams, RealStudiosAreSampledAtFullResolution) {
  PELAGE_REQUIRE_DATA();
  for (const char* name : {"studio_small_03_1k.hdr", "venice_sunset_1k.hdr"}) {
    const std::string path = (data_folder() / "env" / name).string();
    const auto light =
        light_of(block({{"type", text("environment")}, {"file", text(path)}, {"intensity", number(2)}}));
    MemoryLedger ledger;
    TextureLibrary textures(ledger);
    const auto texture = textures.load({path, {}});
    const EnvironmentMap map(texture, Rgb(2));
    double sum = 0;
    for (int y = 0; y < texture->height(); ++y) {
      for (int x = 0; x < texture->width(); ++x) {
        const float pdf = map.pdf({x, y});
        sum += pdf * map.texel_solid_angle(y);
        ASSERT_EQ(pdf > 0, luminance(map.radiance({x, y})) > 0);
      }
    }
    EXPECT_NEAR(sum, 1, 1e-5) << name;
    EXPECT_GT(map.power(), 0.1) << name;
    TestRandom random(6);
    int astray = 0;
    for (int i = 0; i < 20000; ++i) {
      const std::optional<LightSample> s = light->sample(V3f(0), random.unit2());
      ASSERT_TRUE(s);
      ASSERT_NEAR(luminance(s->radiance) / s->pdf / map.power(), 1, 1e-4) << name;
      astray += light->pdf(V3f(0), s->direction) != s->pdf;
    }
    EXPECT_LE(astray, 20) << name;
  }
}

TEST(LightParams, MistakesAreErrors) {
  const auto message = [](const Value& value) -> std::string {
    try {
      light_of(value);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message(block({{"type", text("rectangle")}, {"look_at", list({0, 0, 0})}}))
                .find("lights.key: position and look_at are the same point"),
            std::string::npos);
  EXPECT_NE(message(block({{"type", text("sphere")}, {"radius", number(0)}})), "");
  EXPECT_NE(message(block({{"type", text("sphere")}, {"intensity", number(-1)}})), "");
  EXPECT_NE(message(block({{"type", text("spere")}})).find("sphere"), std::string::npos);
  EXPECT_NE(
      message(block({{"type", text("environment")}, {"file", text("/nowhere/sky.hdr")}})).find("sky.hdr"),
      std::string::npos);
}

TEST(Params, EveryKeyOfLightsAndMaterialsIsExplained) {
  std::vector<const SchemaInfo*> tables = ValueReader<LightParams>::blocks();
  for (const SchemaInfo* table : ValueReader<MaterialParams>::blocks()) tables.push_back(table);
  EXPECT_GE(tables.size(), 5u);
  for (const SchemaInfo* table : tables) {
    EXPECT_FALSE(table->help().empty()) << table->name();
    EXPECT_FALSE(table->keys().empty()) << table->name();
    for (const KeyInfo& key : table->keys())
      EXPECT_FALSE(key.options.help.empty()) << table->name() << "." << key.name;
  }
}

TEST(Params, MaterialsRefuseWhatTheModelCannotDo) {
  const auto accepted = [](const char* key, Value value) {
    Problems problems;
    MaterialParams params;
    return ValueReader<MaterialParams>::read(block({{"model", text("cone-shell")}, {key, std::move(value)}}),
                                             {}, params, problems);
  };
  EXPECT_TRUE(accepted("primary_width", number(90)));
  EXPECT_FALSE(accepted("primary_width", number(0.5f)));
  EXPECT_FALSE(accepted("secondary_width", number(91)));
  EXPECT_FALSE(accepted("balance", number(1.5f)));
  EXPECT_FALSE(accepted("diffuse", number(-0.1f)));
  EXPECT_TRUE(accepted("variant", text("literal")));
  EXPECT_FALSE(accepted("variant", text("literally")));
}

}  // namespace
}  // namespace pelage::light_params_test
