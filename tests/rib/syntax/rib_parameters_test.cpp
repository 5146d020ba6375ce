// SPDX-License-Identifier: Apache-2.0
#include "rib/syntax/rib_parameters.h"

#include <gtest/gtest.h>

#include "tests/rib/syntax/rib_bytes_of.h"

namespace pelage {
namespace {

using namespace rib_test;

RibStatement request(const std::string& text) {
  const Files files;
  RibReader reader(files.write(text));
  RibStatement one;
  reader.next(one);
  one.file = "a.rib";
  return one;
}

TEST(RibParameters, ParsesDeclarations) {
  const auto width = parse_declaration("varying float");
  ASSERT_TRUE(width);
  EXPECT_EQ(width->frequency, RibClass::kVarying);
  EXPECT_EQ(width->components, 1);
  EXPECT_EQ(parse_declaration("uniform float[2]")->components, 2);
  EXPECT_EQ(parse_declaration("facevarying float [2]")->components, 2);
  EXPECT_EQ(parse_declaration("color")->components, 3);
  EXPECT_EQ(parse_declaration("color")->frequency, RibClass::kUniform);
  EXPECT_EQ(parse_declaration("constant matrix")->components, 16);
  for (const char* bad :
       {"", "varying", "varying flaot", "float[0]", "float[x]", "float[99999]", "a b c", "float]"})
    EXPECT_FALSE(parse_declaration(bad)) << bad;
}

TEST(RibParameters, InlineDeclarationsAndTheTable) {
  RibDeclarations declarations;
  RibStatement one =
      request("Curves \"P\" [1 2 3] \"uniform integer id\" [5] \"wetness\" [1] \"varying float width\" 1");
  std::vector<std::string> undeclared;
  auto parameters = declarations.parameters(one, 0, undeclared);
  ASSERT_EQ(parameters.size(), 3u);
  EXPECT_EQ(parameters[0].value->floats, (std::vector<float>{1, 2, 3})) << "integers became floats";
  EXPECT_EQ(find_parameter(parameters, "id")->value->integers, (std::vector<int64_t>{5}));
  EXPECT_EQ(find_parameter(parameters, "width")->declaration.frequency, RibClass::kVarying);
  EXPECT_EQ(undeclared, (std::vector<std::string>{"wetness"}));
  declarations.declare("wetness", "vertex float", one);
  undeclared.clear();
  parameters = declarations.parameters(one, 0, undeclared);
  EXPECT_EQ(find_parameter(parameters, "wetness")->declaration.frequency, RibClass::kVertex);
  EXPECT_EQ(find_parameter(parameters, "none"), nullptr);
}

TEST(RibParameters, WrongTypesAreErrors) {
  const RibDeclarations declarations;
  const auto failure = [&](const std::string& text) {
    RibStatement one = request(text);
    std::vector<std::string> undeclared;
    return error_of([&] { declarations.parameters(one, 0, undeclared); });
  };
  EXPECT_EQ(failure("A \"P\" [\"x\"]"),
            "a.rib:1:7: A: parameter 'P' needs numbers, got an array of 1 strings");
  EXPECT_EQ(failure("A \"name\" 5"), "a.rib:1:10: A: parameter 'name' needs strings, got an integer");
  EXPECT_EQ(failure("A \"id\" [1.5]"),
            "a.rib:1:8: A: parameter 'id' needs integers, got an array of 1 numbers");
  EXPECT_EQ(failure("A \"P\""), "a.rib:1:3: A: parameter 'P' has no value");
  EXPECT_EQ(failure("A 5 6"), "a.rib:1:3: A: expected the name of a parameter, got an integer");
}

TEST(RibParameters, ExportersHaveTypesOfTheirOwn) {
  const RibDeclarations declarations;
  RibStatement one = request(
      "A \"varying flaot width\" 1 \"struct ManifoldStruct m\" [\"a:b\"] \"int n\" [4.0] \"facevertex float "
      "s\" [1 2] "
      "\"reference color c\" [\"node:out\"] \"reference float[2] d\" [\"node:out\"]");
  std::vector<std::string> undeclared;
  const auto all = declarations.parameters(one, 0, undeclared);
  EXPECT_EQ(undeclared, (std::vector<std::string>{"varying flaot width", "struct ManifoldStruct m"}));
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(all[0].value->integers, (std::vector<int64_t>{4}));
  EXPECT_EQ(all[1].declaration.frequency, RibClass::kFaceVarying);
  EXPECT_EQ(all[2].declaration.type, "reference color");
  EXPECT_EQ(all[3].value->strings, (std::vector<std::string>{"node:out"}));
}

TEST(RibParameters, BlanksAroundTheCountOfAnArray) {
  for (const char* text :
       {"varying float[2]", "varying float [2]", "varying float[ 2 ]", " varying\tfloat [ 2]\n"}) {
    const auto declaration = parse_declaration(text);
    ASSERT_TRUE(declaration) << text;
    EXPECT_EQ(declaration->components, 2) << text;
    EXPECT_EQ(declaration->frequency, RibClass::kVarying) << text;
  }
  for (const char* text : {"float[2", "float 2]", "float[2] [2]", "float[]", "float[2 3]", "[2]"})
    EXPECT_FALSE(parse_declaration(text)) << text;
  const RibDeclarations declarations;
  for (const char* token : {"uniform float[ 2 ] st", "uniform float[2]st", "uniform float [2]\tst"}) {
    RibStatement one = statements_of("A \"" + std::string(token) + "\" [1 2]")[0];
    std::vector<std::string> undeclared;
    const auto found = declarations.parameters(one, 0, undeclared);
    ASSERT_EQ(found.size(), 1u) << token;
    EXPECT_EQ(found[0].name, "st");
    EXPECT_EQ(found[0].declaration.components, 2);
  }
}

}  // namespace
}  // namespace pelage
