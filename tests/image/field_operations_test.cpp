// SPDX-License-Identifier: Apache-2.0
#include "image/field_operations.h"

#include <gtest/gtest.h>

#include "base/hash.h"
#include "base/ledger.h"
#include "image/field_places.h"
#include "image/texture_library.h"
#include "scene/document.h"

namespace pelage::field_operations_test {
namespace {

Field read(const std::string& yaml) {
  Field field;
  Problems problems;
  ValueReader<Field>::read(*parse_document("f: " + yaml, "s.yaml").find("f"), {}, field, problems);
  for (const Problem& problem : problems.list()) ADD_FAILURE() << problem.message;
  return field;
}

std::string error_of(const std::string& yaml) {
  Field field;
  Problems problems;
  EXPECT_FALSE(
      ValueReader<Field>::read(*parse_document("f: " + yaml, "s.yaml").find("f"), {}, field, problems));
  if (problems.empty()) return "";
  return to_string(problems.list().front().position) + ": " + problems.list().front().message;
}

float at(const Field& field, const V3f& rest, const V3f& normal = V3f(0, 1, 0)) {
  FieldPoint point;
  point.rest = rest;
  point.normal = normal;
  return field.value(point);
}

const char* const kX = "{ramp: {along: x, knots: [[-4, -4], [4, 4]]}}";  // the value is x

TEST(FieldOperations, ComputeEveryChannel) {
  const std::string x = kX;
  struct Case {
    std::string field;
    float x, value;
  };
  for (const auto& [field, place, value] :
       std::vector<Case>{{"{product: [" + x + ", 2]}", 0.25f, 0.5f},
                         {"{add: [" + x + ", 2, -0.5]}", 0.25f, 1.75f},
                         {"{min: [" + x + ", 0.5]}", 0.25f, 0.25f},
                         {"{min: [" + x + ", 0.5]}", 2, 0.5f},
                         {"{max: [" + x + ", 0.5]}", 2, 2},
                         {"{mix: [1, 3], by: " + x + "}", 0.25f, 1.5f},
                         {"{invert: " + x + "}", 0.25f, 0.75f},
                         {"{clamp: " + x + "}", 2, 1},
                         {"{clamp: " + x + ", low: -1, high: 3}", -2, -1},
                         {"{threshold: " + x + "}", 0.49f, 0},
                         {"{threshold: " + x + "}", 0.5f, 1},
                         {"{threshold: " + x + ", at: 1, width: 2}", 1, 0.5f},
                         {"{threshold: " + x + ", at: 1, width: 2}", 0, 0},
                         {"{step: " + x + ", size: 0.5}", 1.25f, 1},
                         {"{step: " + x + ", size: 0.5}", -0.25f, -0.5f},
                         {"{remap: " + x + ", knots: [[0, 1], [1, 3], [2, 0]]}", 0.5f, 2},
                         {"{remap: " + x + ", knots: [[0, 1], [1, 3], [2, 0]]}", 3, 0}}) {
    EXPECT_NEAR(at(read(field), V3f(place, 0, 0)), value, 1e-6f) << field;
  }
  FieldPoint point;
  const Rgb mixed = read("{mix: [[1, 0, 0], [0, 1, 4]], by: 0.25}").color(point);
  EXPECT_NEAR(mixed.x, 0.75f, 1e-6f);
  EXPECT_NEAR(mixed.y, 0.25f, 1e-6f);
  EXPECT_NEAR(mixed.z, 1, 1e-6f);
  EXPECT_NEAR(read("{add: [[1, 2, 3], 1]}").color(point).z, 4, 1e-6f);
  const Rgb remapped = read("{remap: 0.25, knots: [[0, [1, 0, 0]], [1, [0, 0, 4]]]}").color(point);
  EXPECT_NEAR(remapped.x, 0.75f, 1e-6f);
  EXPECT_NEAR(remapped.z, 1, 1e-6f);
}

TEST(FieldOperations, RangesContainEveryValue) {
  const std::string x = kX, noise = "{noise: {frequency: 3, amplitude: 2, offset: 0.5}}";
  for (const std::string& text :
       {"{add: [" + x + ", " + noise + "]}", "{min: [" + x + ", " + noise + "]}",
        "{max: [" + x + ", " + noise + "]}", "{mix: [" + x + ", 3], by: " + noise + "}",
        "{mix: [" + x + ", " + noise + "], by: {clamp: " + x + "}}", "{invert: " + noise + "}",
        "{clamp: " + noise + ", low: 0.2}", "{threshold: " + noise + ", width: 0.2}",
        "{step: " + noise + ", size: 0.3}", "{remap: " + noise + ", knots: [[0, 3], [1, -2]]}",
        "{product: [" + x + ", " + noise + ", -1]}"}) {
    const Field field = read(text);
    const auto [low, high] = field.value_range();
    ASSERT_TRUE(std::isfinite(low) && std::isfinite(high)) << text;
    for (uint64_t i = 0; i < 500; ++i) {
      V3f place;
      for (int c = 0; c < 3; ++c) place[c] = 8 * unit_float(hash64(i, static_cast<uint64_t>(c))) - 4;
      EXPECT_GE(at(field, place), low - 1e-5f) << text;
      EXPECT_LE(at(field, place), high + 1e-5f) << text;
    }
  }
}

TEST(FieldOperations, BecomeConstantsWhenLoaded) {
  MemoryLedger ledger;
  TextureLibrary textures(ledger);
  const Field field =
      read("{mix: [{add: [1, 2]}, {product: [2, [1, 2, 3]]}], by: {clamp: 7}}").with_textures(textures);
  EXPECT_TRUE(field.inputs().empty());
  EXPECT_EQ(field.color({}), Rgb(2, 4, 6));
  EXPECT_EQ(read(kX).inputs().size(), 0u);
}

TEST(FieldOperations, PrintWhatTheyRead) {
  for (const char* text : {"{mix: [0.5, 2], by: {invert: 0.25}}", "{threshold: 1, at: 0.5, width: 0}",
                           "{add: [1, {min: [2, 3]}, {max: [4, 5]}]}", "{clamp: 3, low: 0, high: 1}",
                           "{step: 3, size: 0.25}", "{remap: 1, knots: [[0, 1], [1, 0.5]]}", "{height: y}",
                           "{slope: z}", "{distance: {point: [0, 1, 2], plane: x}}"})
    EXPECT_EQ(ValueReader<Field>::print(read(text)), text);
}

TEST(FieldPlaces, AreShapesInRestSpace) {
  const auto load = [](const std::string& text) {
    MemoryLedger ledger;
    TextureLibrary textures(ledger);
    return read(text).with_textures(textures);
  };
  const Field box = load("{box: [2, 4, 2], center: [1, 0, 0], soft: 1}");
  EXPECT_EQ(at(box, V3f(1.9f, -1.9f, 0.9f)), 1);
  EXPECT_NEAR(at(box, V3f(2.5f, 0, 0)), 0.5f, 1e-6f);
  EXPECT_EQ(at(box, V3f(3.1f, 0, 0)), 0);
  const Field sphere = load("{sphere: 2, center: [0, 1, 0], soft: 2}");
  EXPECT_EQ(at(sphere, V3f(0, 2.9f, 0)), 1);
  EXPECT_NEAR(at(sphere, V3f(0, 4, 0)), 0.5f, 1e-6f);
  EXPECT_EQ(at(sphere, V3f(6, 1, 0)), 0);
  EXPECT_EQ(at(load("{sphere: 2, center: [0, 0, 0]}"), V3f(2.01f, 0, 0)), 0) << "a hard edge";
  EXPECT_NEAR(at(load("{distance: {point: [1, 0, 0]}}"), V3f(1, 3, 4)), 5, 1e-6f);
  EXPECT_NEAR(at(load("{distance: {line: [[0, 0, 0], [2, 0, 0], [2, 2, 0]]}}"), V3f(3, 1, 0)), 1, 1e-6f);
  EXPECT_NEAR(at(load("{distance: {point: [0, 1, 0], plane: [0, 2, 0]}}"), V3f(5, -1, 3)), -2, 1e-6f);
  EXPECT_NEAR(at(load("{slope: [0, 1, 1]}"), V3f(0), V3f(0, 0, 1)), std::sqrt(0.5f), 1e-6f);
}

TEST(FieldForms, ReportMistakesAtTheirPlaces) {
  EXPECT_EQ(error_of("{multiply: [1, 2]}"),
            "s.yaml:1:5: unknown kind of field 'multiply'; did you mean 'product'?");
  EXPECT_EQ(error_of("{invrt: 1}"), "s.yaml:1:5: unknown kind of field 'invrt'; did you mean 'invert'?");
  EXPECT_EQ(error_of("{mix: [1], by: 0}"), "s.yaml:1:10: `mix` needs 2 fields, got 1");
  EXPECT_EQ(error_of("{add: [1, {noise: {frequncy: 1}}]}"),
            "s.yaml:1:23: unknown key 'frequncy' in noise of a field; did you mean 'frequency'?");
  EXPECT_EQ(error_of("{clamp: 1, low: 2}"), "s.yaml:1:4: `low` is above `high`: 2 > 1");
  EXPECT_EQ(error_of("{remap: 1, knots: [[1, 0], [0, 1]]}"),
            "s.yaml:1:31: knots must be in rising order, got 0 after 1");
  EXPECT_EQ(error_of("{distance: {point: [0, 0, 0], line: [[0, 0, 0], [1, 0, 0]]}}"),
            "s.yaml:1:15: a distance needs one of the keys `point`, `line`, `boundary` and `mesh`");
  EXPECT_EQ(error_of("{slope: w}"), "s.yaml:1:12: expected x, y, z or 3 numbers, got 'w'");
  EXPECT_EQ(error_of("{map: a.png, axis: x}"),
            "s.yaml:1:23: `axis` needs `projection: planar`, `cylinder` or `sphere`");
  EXPECT_EQ(error_of("{map: a.png, projection: plannar}"),
            "s.yaml:1:29: expected texture | planar | triplanar | cylinder | sphere | face, got 'plannar'; "
            "did you mean 'planar'?");
}

// Each kind of field that reads the skin says so where there is none, at its place.
TEST(FieldForms, NeedASkin) {
  MemoryLedger ledger;
  TextureLibrary textures(ledger);
  for (const char* text : {"{height: y}", "{vertex_color: }", "{group: ears}", "{curvature: 1}",
                           "{distance: {boundary: {height: y}}}", "{distance: {mesh: a.obj}}",
                           "{add: [1, {sphere: 1}]}", "{box: [1, 1, 1]}"}) {
    try {
      read(text).with_textures(textures);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("needs one skin"), std::string::npos) << error.what();
      EXPECT_EQ(error.problems().front().position.line, 1) << text;
    }
  }
}

}  // namespace
}  // namespace pelage::field_operations_test
