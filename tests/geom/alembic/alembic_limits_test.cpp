// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/file.h"
#include "base/temporary_folder.h"
#include "geom/alembic/alembic_curves_file.h"
#include "geom/alembic/alembic_validation.h"
#include "geom/io/alembic_strands.h"
#include "tests/geom/alembic/ogawa_bytes.h"
#include "tests/geom/random_strands.h"
#include "tests/support/allocation_meter.h"

namespace pelage::alembic_limits_test {
namespace {

using namespace ogawa_bytes;

class AlembicLimits : public testing::Test {
 protected:
  std::filesystem::path put(const std::string& bytes) {
    const std::filesystem::path path = folder_.path() / "a.abc";
    std::ofstream(path, std::ios::binary) << bytes;  // faster than a file that is safe from power cuts
    return path;
  }
  std::string refusal(const std::string& bytes, int64_t max_bytes = 1 << 20) {
    const std::filesystem::path path = put(bytes);
    try {
      read_alembic_curves(path, {max_bytes});
    } catch (const Error& error) {
      EXPECT_TRUE(error.kind() == ErrorKind::kInput || error.kind() == ErrorKind::kMemory);
      EXPECT_EQ(error.problems().size(), 1u);
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return error.what();
    }
    return "accepted";
  }

  TemporaryFolder folder_;
};

std::string from_hex(std::string_view hex) {
  std::string bytes;
  for (size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
  return bytes;
}

// A curve of one point and one of two, byte by byte. The reference library reads this file.
constexpr const char* kHandMade =
    // 0x0: complete, version 1, the first group
    "4f67617761ff0001"
    "5b02000000000000"
    // 0x10: P: 52 bytes: key, three points
    "3400000000000000"
    "00112233445566778899aabbccddeeff"
    "000000000000000000000000"
    "000000000000803f00000000"
    "000000400000000000000000"
    // 0x4c: the group of P: data, and no sizes
    "0200000000000000"
    "1000000000000080"
    "0000000000000080"
    // 0x64: nVertices: 24 bytes: key, 1 and 2
    "1800000000000000"
    "00112233445566778899aabbccddeeff"
    "0100000002000000"
    // 0x84: its group
    "0200000000000000"
    "6400000000000080"
    "0000000000000080"
    // 0x9c: curveBasisAndType: 20 bytes: key, linear
    "1400000000000000"
    "00112233445566778899aabbccddeeff"
    "01000000"
    // 0xb8: its group
    "0100000000000000"
    "9c00000000000080"
    // 0xc8: headers of the three: bits (kind, type, numbers, constant), samples, name
    "2d00000000000000"
    "a2380000"
    "01"
    "01"
    "50"
    "62180000"
    "01"
    "09"
    "6e5665727469636573"
    "11480000"
    "01"
    "11"
    "63757276654261736973416e6454797065"
    // 0xfd: .geom: the three, headers
    "0400000000000000"
    "4c00000000000000"
    "8400000000000000"
    "b800000000000000"
    "c800000000000080"
    // 0x125: its header: a compound
    "0a00000000000000"
    "00000000"
    "05"
    "2e67656f6d"
    // 0x137: the properties of the object
    "0200000000000000"
    "fd00000000000000"
    "2501000000000080"
    // 0x14f: headers of its children, of which there are none: only two hashes
    "2000000000000000"
    "0000000000000000000000000000000000000000000000000000000000000000"
    // 0x177: the object: properties, headers
    "0200000000000000"
    "3701000000000000"
    "4f01000000000080"
    // 0x18f: its header: name, shared metadata 1; two hashes
    "2600000000000000"
    "01000000"
    "68"
    "01"
    "0000000000000000000000000000000000000000000000000000000000000000"
    // 0x1bd: version of the layout
    "0400000000000000"
    "00000000"
    // 0x1c9: version of the library
    "0400000000000000"
    "cc290000"
    // 0x1d5: the top object: no properties, the object, its header
    "0300000000000000"
    "0000000000000000"
    "7701000000000000"
    "8f01000000000080"
    // 0x1f5: times: at most one sample; one per second, from 0
    "1800000000000000"
    "01000000"
    "000000000000f03f"
    "01000000"
    "0000000000000000"
    // 0x215: shared metadata: size, text
    "3e00000000000000"
    "3d"
    "736368656d613d41626347656f6d5f43757276655f76323b736368656d614f626a5469746c653d41626347656f6d5f43757276"
    "655f76323a2e67656f6d"
    // 0x25b: the first group: versions, top object, no metadata, times, shared metadata
    "0600000000000000"
    "bd01000000000080"
    "c901000000000080"
    "d501000000000000"
    "0000000000000080"
    "f501000000000080"
    "1502000000000080";

TEST_F(AlembicLimits, AFileMadeByHandIsRead) {
  const std::string file = from_hex(kHandMade);
  const CurvesFile read = read_alembic_curves(put(file));
  EXPECT_EQ(read.strands.first_point, (std::vector<uint32_t>{0, 0, 2}));  // one point makes no curve
  EXPECT_EQ(read.strands.points, (std::vector<float>{0, 1, 0, 0, 2, 0, 0, 0}));
  // Cut anywhere, it is refused with one line.
  for (size_t size = 0; size < file.size(); ++size)
    EXPECT_NE(refusal(file.substr(0, size)), "accepted") << size;
}

TEST_F(AlembicLimits, OtherFilesAreNamed) {
  EXPECT_NE(refusal("\x89HDF\r\n\x1a\n" + std::string(100, '\0')).find("older kind, HDF5"),
            std::string::npos);
  EXPECT_NE(refusal("version https://git-lfs.github.com/spec/v1\n").find("git-lfs"), std::string::npos);
  EXPECT_NE(refusal("#usda 1.0\n").find("is not an Alembic file"), std::string::npos);
  OgawaBytes b;
  std::string open = b.file({b.curves("c", {2}, linear_form())});
  open[5] = 0;
  EXPECT_NE(refusal(open).find("is not complete"), std::string::npos);
  EXPECT_NE(refusal(b.file(std::vector<Part>{})).find("a.abc: has no curves"), std::string::npos);
}

TEST_F(AlembicLimits, HostileFilesAreRefused) {
  OgawaBytes a;
  const auto curves_of = [](OgawaBytes& b, const std::vector<int32_t>& counts) {
    return b.object("c", "AbcGeom_Curve_v2",
                    {b.compound(".geom", {b.array("P", kFloat, 3, {raw<float>({0, 0, 0, 1, 1, 1})}),
                                          b.array("nVertices", kInt32, 1, {raw(counts)}),
                                          b.scalar("curveBasisAndType", kUint8, 4, {linear_form()})})});
  };
  EXPECT_NE(refusal(a.file({curves_of(a, {1'000'000'000})})).find("</c>: nVertices need more than the 2"),
            std::string::npos);
  OgawaBytes negative;
  EXPECT_NE(refusal(negative.file({curves_of(negative, {-1, 3})})).find("a curve has -1 points"),
            std::string::npos);
  OgawaBytes fewer;
  EXPECT_NE(refusal(fewer.file({curves_of(fewer, {1})})).find("add up to 1, but there are 2"),
            std::string::npos);
  // A block and a group that claim more than the file has.
  OgawaBytes big;
  const uint64_t block = big.size();
  big.data("1234");
  std::string bytes = big.file(big.group({block | kDataBit, block | kDataBit}));
  bytes.replace(block, 8, raw<uint64_t>({uint64_t(1) << 62}));
  EXPECT_NE(refusal(bytes).find("bytes of data (byte 16)"), std::string::npos) << refusal(bytes);
  OgawaBytes many;
  const uint64_t group = many.group({0, 0});
  many.set(group, uint64_t(1) << 60);
  EXPECT_NE(refusal(many.file(group)).find("claims a group of 1152921504606846976 children (byte 16)"),
            std::string::npos);
  // An object that is in itself, and one in two places.
  OgawaBytes cycle;
  const Part inner = cycle.object("a", "", {});
  const uint64_t top = cycle.object_group({}, {inner});
  cycle.set(top + 16, top);
  EXPECT_NE(refusal(cycle.file(top)).find("in two places"), std::string::npos) << refusal(cycle.file(top));
  OgawaBytes twice;
  const Part shared = curves_of(twice, {2});
  EXPECT_NE(refusal(twice.file({shared, shared})).find("in two places"), std::string::npos);
  OgawaBytes deep;
  Part nested = deep.object("a", "", {});
  for (int i = 0; i < 600; ++i) nested = deep.object("a", "", {}, {nested});
  EXPECT_NE(refusal(deep.file({nested})).find("deeper than 512"), std::string::npos);
  OgawaBytes index;
  const Part indexed =
      index.curves("c", {2}, linear_form(),
                   {index.compound("uv", {index.array(".vals", kFloat, 2, {raw<float>({0, 0})}),
                                          index.array(".indices", kUint32, 1, {raw<uint32_t>({1})})})});
  EXPECT_NE(refusal(index.file({indexed})).find("the index 1 is not one of 1 elements"), std::string::npos);
}

TEST_F(AlembicLimits, NamesAreShortAndOfOneLine) {
  const std::vector<std::pair<std::string, const char*>> bad{{std::string(70'000, 'n'), "70000 bytes"},
                                                             {"c\nerror: more", "control character"},
                                                             {"c\x1b[31m", "control character"},
                                                             {"", "a name is empty"}};
  for (const auto& [name, why] : bad) {
    OgawaBytes b;
    EXPECT_NE(refusal(b.file({b.curves(name, {2}, linear_form())})).find(why), std::string::npos) << why;
  }
  OgawaBytes b;
  const Part param = b.array("two\nlines", kFloat, 1, {raw<float>({1, 2, 3, 4, 5})}, "geoScope=vtx");
  EXPECT_NE(refusal(b.file({b.curves("c", {2}, linear_form(), {}, {param})})).find("control character"),
            std::string::npos);
  // Objects within each other that share the header of one long name.
  OgawaBytes shared;
  const Part leaf = shared.object(std::string(4000, 'n'), "", {});
  const uint64_t header = shared.data(leaf.header + std::string(32, 'h'));
  uint64_t word = leaf.word;
  for (int i = 0; i < 100; ++i) word = shared.group({0, word, header});
  EXPECT_NE(refusal(shared.file(word)).find("path of an object has more than 65536 bytes"),
            std::string::npos);
}

TEST_F(AlembicLimits, SharedHeadersAreRefused) {
  // 2000 objects whose properties are one compound of 2000: 4 million headers in a file of 100 kB.
  OgawaBytes b;
  const Part compound = b.compound("a", std::vector<Part>(2000, b.compound("p", {})));
  std::vector<Part> objects;
  const uint64_t none = b.data(std::string(32, 'h'));
  for (int i = 0; i < 2000; ++i) {
    Part one = b.object("o", "", {});
    one.word = b.group({compound.word, none});
    objects.push_back(one);
  }
  EXPECT_NE(refusal(b.file(objects)).find("share their headers"), std::string::npos);
  // As many with compounds of their own.
  OgawaBytes own;
  std::vector<Part> different;
  for (int i = 0; i < 200; ++i)
    different.push_back(own.object("o", "", std::vector<Part>(200, own.compound("p", {}))));
  EXPECT_NE(refusal(own.file(different)).find("has no curves"), std::string::npos);
}

TEST_F(AlembicLimits, ValidationReadsSharedNumbersAFewTimes) {
  OgawaBytes b;
  const Part points = b.array("P", kFloat, 3, {raw(std::vector<float>(30000, 1))}),
             counts = b.array("nVertices", kInt32, 1, {raw<int32_t>({10000})}),
             form = b.scalar("curveBasisAndType", kUint8, 4, {linear_form()});
  std::vector<Part> objects;
  for (int i = 0; i < 300; ++i)
    objects.push_back(b.object("c", "AbcGeom_Curve_v2", {b.compound(".geom", {points, counts, form})}));
  const ValidationReport found = validate_alembic(put(b.file(objects)));
  EXPECT_EQ(found.curves, 300u);
  EXPECT_LT(found.points, 3'000'000u);
  EXPECT_NE(found.remarks.back().find("are not checked"), std::string::npos);
}

TEST_F(AlembicLimits, TransformsHaveFewOperations) {
  OgawaBytes b;
  const std::vector<Part> xform{b.array(".ops", kUint8, 1, {std::string(300, '\x10')}),
                                b.array(".vals", kDouble, 1, {raw(std::vector<double>(900, 0))})};
  const Part object = b.object("x", "AbcGeom_Xform_v3", {b.compound(".xform", xform)});
  EXPECT_NE(refusal(b.file({object})).find("more than 255 operations"), std::string::npos);
}

TEST_F(AlembicLimits, MemoryIsCheckedBeforeItIsTaken) {
  OgawaBytes b;
  const std::vector<int32_t> counts(1000, 10);
  const std::string file = b.file({b.curves("c", counts, linear_form())});
  EXPECT_EQ(refusal(file), "accepted");
  EXPECT_NE(refusal(file, 50'000).find("that the memory limit leaves"), std::string::npos);
  // One value with many indices.
  OgawaBytes wide;
  const Part expanded = wide.curves(
      "c", {2}, linear_form(), {},
      {wide.compound("x", {wide.array(".vals", kFloat, 16, {raw(std::vector<float>(16, 1))}),
                           wide.array(".indices", kUint32, 1, {raw(std::vector<uint32_t>(20'000, 0))})})});
  EXPECT_NE(refusal(wide.file({expanded})).find("that the memory limit leaves"), std::string::npos);
}

TEST_F(AlembicLimits, TheLimitOfMemoryHoldsForAllThatIsTaken) {
  // Bases that keep their vertices and that are resampled, one curve and many, ids in order and not, and two
  // objects of different bases; each with wide parameters of vertices and curves.
  for (const int basis : {0, 1, 3, 4}) {
    for (const bool one : {false, true}) {
      OgawaBytes b;
      const std::vector<int32_t> counts = one ? std::vector<int32_t>{16'001} : std::vector<int32_t>(2000, 8);
      const size_t vertices = one ? 16'001 : 16'000;
      std::vector<int32_t> ids(counts.size());
      for (size_t i = 0; i < ids.size(); ++i) ids[i] = static_cast<int32_t>(basis == 3 ? i : ids.size() - i);
      const std::vector<Part> params{
          b.array("a", kFloat, 16, {raw(std::vector<float>(16 * vertices, 1))}, "geoScope=vtx"),
          b.array("b", kFloat, 3, {raw(std::vector<float>(3 * counts.size(), 1))}, "geoScope=uni"),
          b.compound("c",
                     {b.array(".vals", kFloat, 3, {raw<float>({1, 2, 3})}, "geoScope=vtx"),
                      b.array(".indices", kUint32, 1, {raw(std::vector<uint32_t>(vertices, 0))})},
                     "geoScope=vtx"),
          b.array("groom_id", kInt32, 1, {raw(ids)}, "geoScope=uni")};
      const std::vector<Part> widths{
          b.array("width", kFloat, 1, {raw(std::vector<float>(vertices, 1))}, "geoScope=vtx")};
      const std::string form = basis == 0 ? linear_form() : curve_form(0, 0, basis == 4 ? 2 : basis);
      std::vector<Part> objects{b.curves("c", counts, form, widths, params)};
      if (basis == 4) objects.push_back(b.curves("d", {500}, linear_form()));
      const std::filesystem::path path = put(b.file(objects));
      reset_peak();
      const size_t before = live_bytes();
      read_alembic_curves(path);
      const size_t peak = peak_bytes() - before;
      // 64 KiB: paths and headers, which are not counted.
      const auto refused = static_cast<int64_t>(peak - (1 << 16));
      EXPECT_THROW(read_alembic_curves(path, {refused}), Error) << basis << one;
      // The estimate is no more than twice the memory.
      EXPECT_NO_THROW(read_alembic_curves(path, {static_cast<int64_t>(2 * peak)})) << basis << one;
    }
  }
}

TEST_F(AlembicLimits, ValidationFindsWhatProgramsStumbleOver) {
  const auto findings = [&](const std::string& bytes) {
    const ValidationReport found = validate_alembic(put(bytes));
    std::string all;
    for (const std::string& line : found.problems) all += line + "\n";
    for (const std::string& line : found.remarks) all += line + "\n";
    return all;
  };
  OgawaBytes b;
  const std::vector<Part> geometry{
      b.array("P", kFloat, 3, {raw<float>({0, 0, 0, NAN, 1, 1, 1, 1, 1}), raw<float>({0, 0, 0})}),
      b.array("nVertices", kInt32, 1, {raw<int32_t>({2, 1}), raw<int32_t>({1})}),
      b.scalar("curveBasisAndType", kUint8, 4, {linear_form()}),
      b.array("width", kFloat, 1, {raw<float>({-1})}, "geoScope=con"),
      b.scalar(".selfBnds", kDouble, 6, {raw<double>({0, 0, 0, 1, 0.5, 1})})};
  const std::string found =
      findings(b.file({b.object("c", "AbcGeom_Curve_v2", {b.compound(".geom", geometry)})}));
  for (const char* part : {"a.abc: </c>: 1 strands have one point", "nVertices change at sample 1",
                           "1 coordinates of points are not finite", "1 widths are negative",
                           "smaller than the strands", "no texture coordinates", "no ids"})
    EXPECT_NE(found.find(part), std::string::npos) << part << "\n" << found;
  OgawaBytes wrong;
  const std::vector<Part> sizes{wrong.array("P", kFloat, 2, {raw<float>({0, 0, 1, 1})}),
                                wrong.array("nVertices", kInt32, 1, {raw<int32_t>({2})}),
                                wrong.scalar("curveBasisAndType", kUint8, 4, {linear_form()}),
                                wrong.array("width", kFloat, 1, {raw<float>({1, 1, 1})}, "geoScope=vtx")};
  const std::string odd =
      findings(wrong.file({wrong.object("c", "AbcGeom_Curve_v2", {wrong.compound(".geom", sizes)})}));
  EXPECT_NE(odd.find("a.abc: </c>: its points have 2 coordinates"), std::string::npos) << odd;
  EXPECT_NE(odd.find("a.abc: </c>: 'width' has 3 values; 2 vertices"), std::string::npos) << odd;
  OgawaBytes groom;
  const Part width = groom.array("groom_width", kFloat, 1, {raw<float>({1, 1})}, "geoScope=vtx");
  EXPECT_EQ(findings(groom.file({groom.curves("c", {2}, linear_form(), {}, {width})})).find("no widths"),
            std::string::npos);
  const std::filesystem::path good = folder_.path() / "good.abc";
  StrandArrays strands = random_strands(3).arrays();
  strands.root_uv.resize(strands.ids.size());
  write_alembic_strands(good, Strands(strands), {});
  EXPECT_EQ(findings(read_file(good)), "");
  const ValidationReport counted = validate_alembic(good);  // of which "good" has phantoms
  EXPECT_EQ(counted.points, strands.points.size() / 4);
}

}  // namespace
}  // namespace pelage::alembic_limits_test
