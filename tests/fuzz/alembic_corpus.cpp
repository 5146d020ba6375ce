// SPDX-License-Identifier: Apache-2.0
#include "base/file.h"
#include "base/temporary_folder.h"
#include "geom/io/alembic_strands.h"
#include "tests/fuzz/corpus.h"
#include "tests/geom/alembic/ogawa_bytes.h"
#include "tests/geom/random_strands.h"

namespace pelage {
namespace {

using namespace ogawa_bytes;

std::string strands_of_pelage() {
  RandomStrandOptions options;
  options.strands = 3;
  StrandArrays a = random_strands(5, options).arrays();
  a.root_uv.resize(3);
  a.attributes.push_back(
      {"color", AttributeClass::kPerPoint, 3, std::vector<float>(a.points.size() / 4 * 3)});
  const TemporaryFolder folder;
  write_alembic_strands(folder.path() / "a.abc", Strands(a), {});
  return read_file(folder.path() / "a.abc");
}

/// A mesh with everything, under a transform with every operation.
std::string mesh_with_everything() {
  OgawaBytes b;
  const std::vector<Part> geometry{
      b.array("P", kFloat, 3, {raw<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 2, 0})}),
      b.array(".faceIndices", kInt32, 1, {raw<int32_t>({0, 1, 2, 3, 3, 2, 4})}),
      b.array(".faceCounts", kInt32, 1, {raw<int32_t>({4, 3})}),
      b.array(".creaseIndices", kInt32, 1, {raw<int32_t>({0, 1, 2})}),
      b.array(".creaseLengths", kInt32, 1, {raw<int32_t>({3})}),
      b.array(".creaseSharpnesses", kFloat, 1, {raw<float>({2})}),
      b.array(".cornerIndices", kInt32, 1, {raw<int32_t>({4})}),
      b.array(".cornerSharpnesses", kFloat, 1, {raw<float>({3})}),
      b.array(".holes", kInt32, 1, {raw<int32_t>({1})}),
      b.compound("uv",
                 {b.array(".vals", kFloat, 2, {raw<float>({0, 0, 1, 0})}, "geoScope=fvr"),
                  b.array(".indices", kUint32, 1, {raw<uint32_t>({0, 1, 1, 0, 0, 1, 1})})},
                 "geoScope=fvr"),
      b.compound(".arbGeomParams", {b.array("Cd", kFloat, 3, {raw<float>({1, 0, 0})}, "geoScope=con")})};
  const Part set = b.object("s", "AbcGeom_FaceSet_v1",
                            {b.compound(".faceset", {b.array(".faces", kInt32, 1, {raw<int32_t>({1})})})});
  const Part mesh = b.object("m", "AbcGeom_SubD_v1", {b.compound(".geom", geometry)}, {set});
  const std::string ops{0x10, 0x20, 0x30, 0x40, 0x50, 0x60, 0x00};
  const std::vector<double> values{1, 2, 3, 0, 1, 0, 90, 1, 0,  0,  0,  0, 1, 0, 0,
                                   0, 0, 1, 0, 0, 0, 0,  1, 10, 20, 30, 1, 1, 1};
  const std::vector<Part> xform{b.scalar(".ops", kUint8, 7, {ops}),
                                b.scalar(".vals", kDouble, 29, {raw(values)}),
                                b.scalar(".inherits", Pod(0), 1, {"\1"})};
  return b.file({b.object("x", "AbcGeom_Xform_v3",
                          {b.compound(".xform", xform), b.scalar("visible", kInt8, 1, {"\xff"})}, {mesh})});
}

}  // namespace

std::vector<std::string> alembic_corpus() {
  std::vector<std::string> corpus{strands_of_pelage(), mesh_with_everything()};
  for (const std::string& form : {curve_form(0, 0, 1), curve_form(0, 1, 2), curve_form(0, 0, 3),
                                  curve_form(2, 0, 2), curve_form(0, 1, 4), curve_form(9, 9, 9)}) {
    OgawaBytes b;
    const std::vector<Part> geometry{b.array("width", kFloat, 1, {raw<float>({1})}, "geoScope=con"),
                                     b.array(".orders", kUint8, 1, {"\4\4"}),
                                     b.array(".knots", kFloat, 1, {raw<float>({0, 0, 0, 0, 1, 1, 1, 1})})};
    corpus.push_back(b.file({b.curves("c", {4, 7}, form, geometry)}));
  }
  OgawaBytes cycle;
  const uint64_t top = cycle.object_group({}, {cycle.object("a", "", {})});
  cycle.set(top + 16, top);
  corpus.push_back(cycle.file(top));
  OgawaBytes deep;
  Part nested = deep.object("a", "", {});
  for (int i = 0; i < 600; ++i) nested = deep.object("a", "", {}, {nested});
  corpus.push_back(deep.file({nested}));
  OgawaBytes many;  // curves that share their data
  const Part curves = many.curves("c", std::vector<int32_t>(500, 10), linear_form());
  std::vector<Part> objects;
  for (int i = 0; i < 200; ++i) {
    Part copy = curves;
    // Another group with the same two children: properties and headers.
    const std::string bytes = many.file(std::vector<Part>{});
    uint64_t words[2];
    std::memcpy(words, bytes.data() + curves.word + 8, sizeof words);
    copy.word = many.group({words[0], words[1]});
    objects.push_back(copy);
  }
  corpus.push_back(many.file(objects));
  OgawaBytes claims;
  const uint64_t group = claims.group({0, 0});
  claims.set(group, uint64_t(1) << 60);
  corpus.push_back(claims.file(group));
  return corpus;
}

}  // namespace pelage
