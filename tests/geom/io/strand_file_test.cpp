// SPDX-License-Identifier: Apache-2.0
#include "geom/io/strand_file.h"

#include <cmath>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/file.h"
#include "base/process_usage.h"
#include "base/temporary_folder.h"
#include "tests/geom/random_strands.h"
#include "tests/support/data.h"
#include "tests/support/effort.h"

namespace pelage {
namespace {

/// Bytes of a binary file, piece by piece.
struct Bytes {
  std::string text;
  template <class T>
  Bytes& operator<<(T value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  Bytes& zeros(size_t count) {
    text.append(count, '\0');
    return *this;
  }
};

Bytes hair_header(uint32_t strands, uint32_t points, uint32_t arrays, uint32_t segments,
                  float thickness = 0) {
  Bytes b;
  b.text = "HAIR";
  b << strands << points << arrays << segments << thickness << 0.0f << 0.0f << 0.0f << 0.0f;
  return b.zeros(88);
}

Bytes tfx_header(float version, uint32_t strands, uint32_t per_strand, uint32_t points,
                 uint32_t strand_uv = 0, uint32_t point_uv = 0, uint32_t thickness = 0, uint32_t color = 0) {
  Bytes b;
  b << version << strands << per_strand << points << strand_uv << point_uv << thickness << color;
  return b.zeros(128);
}

class StrandFiles : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& bytes) {
    std::ofstream(folder.path() / name, std::ios::binary) << bytes;
    return folder.path() / name;
  }
  std::string message_of(const std::filesystem::path& path) {
    try {
      read_strands(path);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      const std::string text = error.what();
      EXPECT_EQ(text.find('\n'), std::string::npos) << text;
      EXPECT_EQ(text.find(path.string() + ": "), 0u) << text;
      return text.substr(std::min(text.size(), path.string().size() + 2));
    }
    ADD_FAILURE() << "no error";
    return {};
  }
  std::string write_error(const std::string& name, const Strands& strands) {
    try {
      write_strands(folder.path() / name, strands);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kFailed);
      EXPECT_FALSE(std::filesystem::exists(folder.path() / name));
      const std::string where = (folder.path() / name).string() + ": ";
      return std::string(error.what()).substr(where.size());
    }
    ADD_FAILURE() << "no error";
    return {};
  }

  TemporaryFolder folder;
};

/// `strands` with attributes of every class.
Strands dressed(const Strands& strands, bool with_root_uv) {
  StrandArrays a = strands.arrays();
  uint64_t draw = 0;
  const auto fill = [&](const char* name, AttributeClass frequency, int components, size_t count) {
    StrandAttribute attribute{name, frequency, components, {}};
    for (size_t i = 0; i < count * static_cast<size_t>(components); ++i) {
      attribute.values.push_back(unit_float(hash64(draw++)));
    }
    a.attributes.push_back(std::move(attribute));
  };
  fill("color", AttributeClass::kPerPoint, 3, strands.point_count());
  fill(with_root_uv ? "opacity" : "transparency", AttributeClass::kPerPoint, 1, strands.point_count());
  for (size_t i = 0; with_root_uv && i < strands.strand_count(); ++i) {
    a.root_uv.emplace_back(unit_float(hash64(i, 1)), unit_float(hash64(i, 2)));
  }
  return Strands(std::move(a));
}

void expect_equal(const Strands& a, const Strands& b) {
  EXPECT_EQ(a.arrays().first_point, b.arrays().first_point);
  EXPECT_EQ(a.arrays().points, b.arrays().points);
  EXPECT_EQ(a.arrays().ids, b.arrays().ids);
  EXPECT_EQ(a.arrays().root_uv, b.arrays().root_uv);
  ASSERT_EQ(a.attributes().size(), b.attributes().size());
  for (const StrandAttribute& attribute : a.attributes()) {
    const StrandAttribute* other = b.find_attribute(attribute.name);
    ASSERT_NE(other, nullptr) << attribute.name;
    EXPECT_EQ(attribute.frequency, other->frequency);
    EXPECT_EQ(attribute.components, other->components);
    EXPECT_EQ(attribute.values, other->values);
  }
}

TEST_F(StrandFiles, HairComesBackBitForBit) {
  for (uint32_t max : {2u, 9u, 5000u}) {
    RandomStrandOptions options;
    options.strands = max > 100 ? 9 : 60;
    options.min_points = 2;
    options.max_points = max;
    const Strands strands = dressed(random_strands(max, options), false);
    write_strands(folder.path() / "a.hair", strands);
    const StrandFile back = read_strands(folder.path() / "a.hair");
    EXPECT_EQ(back.format, "hair");
    EXPECT_EQ(back.repairs.dropped, 0);
    EXPECT_EQ(back.repairs.repaired, 0);
    EXPECT_EQ(back.assumed_width, 0);
    expect_equal(strands, back.strands);
    write_strands(folder.path() / "b.HAIR", back.strands);
    EXPECT_EQ(read_file(folder.path() / "a.hair"), read_file(folder.path() / "b.HAIR"));
  }
}

TEST_F(StrandFiles, TfxComesBackBitForBit) {
  RandomStrandOptions options;
  options.min_points = options.max_points = 16;
  StrandArrays a = dressed(random_strands(3, options), true).arrays();
  for (size_t i = 0; i < a.points.size(); i += 4)
    a.points[i + 3] = a.points[i / 64 * 64 + 3];  // a width a strand
  a.attributes.push_back(
      {"uv", AttributeClass::kPerPoint, 2, std::vector<float>(a.points.size() / 2, 0.25f)});
  const Strands strands(std::move(a));
  write_strands(folder.path() / "a.tfx", strands);
  const StrandFile back = read_strands(folder.path() / "a.tfx");
  EXPECT_EQ(back.format, "tfx");
  EXPECT_EQ(back.repairs.repaired, 0);
  expect_equal(strands, back.strands);
  write_strands(folder.path() / "b.tfx", back.strands);
  EXPECT_EQ(read_file(folder.path() / "a.tfx"), read_file(folder.path() / "b.tfx"));
}

TEST_F(StrandFiles, ConstantsStandInTheHairHeader) {
  StrandArrays a = random_strands(4).arrays();
  a.attributes.push_back({"color", AttributeClass::kConstant, 3, {0.25f, 0.5f, 1}});
  a.attributes.push_back({"transparency", AttributeClass::kConstant, 1, {0.125f}});
  const Strands strands(std::move(a));
  write_strands(folder.path() / "a.hair", strands);
  expect_equal(strands, read_strands(folder.path() / "a.hair").strands);
}

TEST_F(StrandFiles, OpacityBecomesTransparencyInHair) {
  StrandArrays a = random_strands(5).arrays();
  a.attributes.push_back({"opacity", AttributeClass::kPerStrand, 1, std::vector<float>(a.ids.size(), 0.75f)});
  write_strands(folder.path() / "a.hair", Strands(std::move(a)));
  const Strands back = read_strands(folder.path() / "a.hair").strands;
  EXPECT_EQ(back.find_attribute("transparency")->values[7], 0.25f);
}

TEST_F(StrandFiles, WidthsAreDiameters) {
  Bytes b = hair_header(1, 2, 2 | 4, 1);
  b << 0.0f << 0.0f << 0.0f << 0.0f << 1.0f << 0.0f << 0.5f << 0.25f;
  const Strands strands = read_strands(write("a.hair", b.text)).strands;
  EXPECT_EQ(strands.radius(0), 0.25f);
  EXPECT_EQ(strands.radius(1), 0.125f);
}

TEST_F(StrandFiles, WidthsComeFromTheFileThenTheOptionsThenAGuess) {
  const auto hair = [&](float thickness) {
    Bytes b = hair_header(1, 2, 2, 1, thickness);
    b << 0.0f << 0.0f << 0.0f << 0.0f << 8.0f << 0.0f;
    return write("a.hair", b.text);
  };
  StrandReadOptions options;
  options.default_width = 0.5f;
  EXPECT_EQ(read_strands(hair(0.25f), options).strands.radius(0), 0.125f);
  EXPECT_EQ(read_strands(hair(0), options).strands.radius(0), 0.25f);
  EXPECT_EQ(read_strands(hair(0), options).assumed_width, 0);
  const StrandFile guessed = read_strands(hair(0));
  EXPECT_FLOAT_EQ(guessed.assumed_width, 0.008f);
  EXPECT_FLOAT_EQ(guessed.strands.radius(1), 0.004f);
  EXPECT_EQ(guessed.repairs.repaired, 0) << "a file may leave widths to others";
}

TEST_F(StrandFiles, DegenerateStrandsAreRepairedOrDroppedAndCounted) {
  const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
  struct Point {
    float x, y, z, thickness;
  };
  const std::vector<std::vector<Point>> file = {
      {{0, 0, 0, 1}, {1, 0, 0, 0}},                              // 0: whole; a tip may have no width
      {{0, 0, 0, 1}},                                            // 1: one point
      {{2, 2, 2, 1}, {2, 2, 2, 1}, {2, 2, 2, 1}},                // 2: no extent
      {{0, 0, 0, 1}, {nan, 0, 0, 1}, {1, 0, 0, 1}},              // 3: no number
      {{0, 0, 0, 1}, {0, infinity, 0, 1}},                       // 4: infinite
      {{0, 0, 0, 1}, {1e30f, 0, 0, 1}},                          // 5: absurd
      {{3, 0, 0, 1}, {3, 0, 0, 2}, {4, 0, 0, 3}, {4, 0, 0, 4}},  // 6: repeated points
      {{0, 0, 0, -1}, {1, 0, 0, 2}},                             // 7: negative width
      {{0, 0, 0, nan}, {1, 0, 0, infinity}},                     // 8: no usable width
      {{0, 0, 0, 0}, {1, 0, 0, 0}},                              // 9: no width
      {{5, 0, 0, 1}, {6, 0, 0, 1}},                              // 10: whole
  };
  uint32_t count = 0;
  for (const auto& strand : file) count += static_cast<uint32_t>(strand.size());
  Bytes b = hair_header(static_cast<uint32_t>(file.size()), count, 1 | 2 | 4 | 8, 0, 0.5f);
  for (const auto& strand : file) b << static_cast<uint16_t>(strand.size() - 1);
  for (const auto& strand : file) {
    for (const Point& p : strand) b << p.x << p.y << p.z;
  }
  for (const auto& strand : file) {
    for (const Point& p : strand) b << p.thickness;
  }
  for (uint32_t i = 0; i < count; ++i) b << (i == 1 ? nan : static_cast<float>(i));
  const StrandFile read = read_strands(write("a.hair", b.text));
  EXPECT_EQ(read.repairs.dropped, 5);
  EXPECT_EQ(read.repairs.repaired, 4);
  const Strands& s = read.strands;
  EXPECT_EQ(s.arrays().ids, (std::vector<uint64_t>{0, 6, 7, 8, 9, 10})) << "ids are places in the file";
  EXPECT_EQ(s.arrays().first_point, (std::vector<uint32_t>{0, 2, 4, 6, 8, 10, 12}));
  EXPECT_EQ(s.point(2), V3f(3, 0, 0));
  EXPECT_EQ(s.point(3), V3f(4, 0, 0));
  EXPECT_EQ(s.radius(3), 1.5f);
  EXPECT_EQ(s.radius(4), 0);
  EXPECT_EQ(s.radius(5), 1);
  EXPECT_EQ(s.radius(6), 0.25f) << "the file's default";
  EXPECT_EQ(s.radius(8), 0.25f);
  EXPECT_EQ(s.point(10), V3f(5, 0, 0));
  const std::vector<float>& values = s.find_attribute("transparency")->values;
  EXPECT_EQ(values[1], 0) << "what is no number becomes 0";
  EXPECT_EQ(values[2], 13);
  EXPECT_EQ(values[3], 15);
  EXPECT_EQ(values[11], static_cast<float>(count - 1));
}

TEST_F(StrandFiles, RepeatedPointsOfAnUnpinnedBSplineAreMeant) {
  Bytes b = hair_header(2, 8, 2, 3, 0.5f);
  for (float x : {0.0f, 0.0f, 0.0f, 1.0f, 7.0f, 7.0f, 7.0f, 7.0f}) b << x << 0.0f << 0.0f;
  StrandReadOptions options;
  options.basis = CurveBasis::kBSpline;
  const StrandFile read = read_strands(write("a.hair", b.text), options);
  EXPECT_EQ(read.strands.strand_count(), 1u);
  EXPECT_EQ(read.strands.strand_points(0), 4u);
  EXPECT_EQ(read.repairs.dropped, 1);
  EXPECT_EQ(read.repairs.repaired, 0);
}

TEST_F(StrandFiles, SayWhyTheyAreRefused) {
  EXPECT_EQ(message_of(folder.path() / "none.hair"), "there is no such file");
  EXPECT_EQ(message_of(folder.path() / "a.x"), "expected a strand file ending in .hair, .tfx, .usda or .abc");
  std::filesystem::create_directory(folder.path() / "d.hair");
  EXPECT_EQ(message_of(folder.path() / "d.hair"), "is not a regular file");
  for (const char* name : {"e.hair", "e.tfx"}) {
    EXPECT_EQ(message_of(write(name, "")), "is empty");
    EXPECT_EQ(message_of(write(name, "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 9\n")),
              "is a git-lfs pointer, not the file itself");
  }
  EXPECT_EQ(message_of(write("a.hair", "HAIR")),
            "claims 128 bytes of header at byte 0, but has only 4 bytes");
  EXPECT_EQ(message_of(write("a.hair", Bytes().zeros(200).text)),
            "is not a .hair file: it does not begin with HAIR");
  EXPECT_EQ(message_of(write("a.hair", hair_header(1, 2, 64 | 2, 1).zeros(24).text)),
            "claims arrays that the .hair format does not define");
  EXPECT_EQ(message_of(write("a.hair", hair_header(1, 2, 4, 1).zeros(24).text)), "holds no points");
  EXPECT_EQ(message_of(write("a.hair", hair_header(0, 0, 2, 1).text)), "holds no strands");
  EXPECT_EQ(message_of(write("a.hair", hair_header(1, 3, 2, 2).zeros(24).text)),
            "claims 3 points at byte 128, but has only 152 bytes");
  EXPECT_EQ(message_of(write("a.hair", hair_header(1, 2, 2, 4).zeros(24).text)),
            "its 1 strands need 5 points, but it claims 2");
  EXPECT_EQ(message_of(write("a.hair", hair_header(0xffffffff, 2, 2, 0xffffffff).zeros(24).text)),
            "its 4294967295 strands need 18446744069414584320 points, but it claims 2");
  EXPECT_EQ(message_of(write("a.hair", hair_header(0xffffffff, 2, 3, 1).zeros(24).text)),
            "claims 4294967295 segment counts at byte 128, but has only 152 bytes");
  EXPECT_EQ(message_of(write("a.hair", hair_header(1, 0xffffffff, 2 | 4, 1).zeros(24).text)),
            "claims 4294967295 points at byte 128, but has only 152 bytes");
  EXPECT_EQ(message_of(write("a.tfx", tfx_header(3, 1, 2, 160).zeros(32).text)),
            "is not a TressFX 4 file: its version is not 4");
  EXPECT_EQ(message_of(write("a.tfx", tfx_header(4, 1, 2, 0).zeros(32).text)), "holds no points");
  EXPECT_EQ(message_of(write("a.tfx", tfx_header(4, 0, 2, 160).zeros(32).text)), "holds no strands");
  EXPECT_EQ(message_of(write("a.tfx", tfx_header(4, 1, 1, 160).zeros(32).text)),
            "claims 1 points per strand, expected at least 2");
  EXPECT_EQ(message_of(write("a.tfx", tfx_header(4, 0xffffffff, 0xffffffff, 160).zeros(32).text)),
            "claims 4294967295 strands of 4294967295 points, more than it can hold");
  EXPECT_EQ(message_of(write("a.tfx", tfx_header(4, 1, 2, 80).zeros(32).text)),
            "its points would overlap its header");
  EXPECT_EQ(message_of(write("a.tfx", tfx_header(4, 1, 2, 0xfffffff0).zeros(32).text)),
            "claims 2 points at byte 4294967280, but has only 192 bytes");
  EXPECT_EQ(message_of(write("a.tfx", tfx_header(4, 1, 2, 160, 0, 0, 190).zeros(32).text)),
            "claims 1 thicknesses at byte 190, but has only 192 bytes");
}

TEST_F(StrandFiles, EveryTruncationIsRefused) {
  RandomStrandOptions options;
  options.strands = 5;
  options.min_points = options.max_points = 4;
  for (const char* name : {"a.hair", "a.tfx"}) {
    write_strands(folder.path() / name, dressed(random_strands(6, options), true));
    const std::string whole = read_file(folder.path() / name);
    for (size_t length = 0; length < whole.size(); length += 3) {
      message_of(write(std::string("cut-") + name, whole.substr(0, length)));
    }
  }
}

TEST_F(StrandFiles, WritersRefuseWhatTheFormatCannotHold) {
  EXPECT_EQ(write_error("a.hair", Strands()), "there are no strands to write");
  EXPECT_EQ(write_error("a.tfx", Strands()), "there are no strands to write");
  StrandArrays uneven;
  uneven.first_point = {0, 2, 5};
  uneven.ids = {0, 1};
  uneven.points.resize(20, 1.0f);
  EXPECT_EQ(
      write_error("a.tfx", Strands(uneven)),
      "the .tfx format needs the same number of points in every strand; strand 0 has 2, strand 1 has 3");
  StrandArrays longest;
  longest.first_point = {0, 2, 70002};
  longest.ids = {0, 1};
  longest.points.resize(70002 * 4, 1.0f);
  EXPECT_EQ(write_error("a.hair", Strands(longest)),
            "the .hair format holds at most 65536 points per strand, strand 1 has 70000");
  EXPECT_EQ(write_error("a.obj", random_strands(1)).substr(0, 33), "expected a strand file ending in ");
}

TEST_F(StrandFiles, ReadOptixFur) {
  PELAGE_REQUIRE_DATA();
  StrandReadOptions options;
  options.basis = CurveBasis::kBSpline;
  const StrandFile fur = read_strands(data_folder() / "hair/optix_fur.hair", options);
  EXPECT_EQ(fur.strands.strand_count(), 50000u);
  EXPECT_EQ(fur.strands.point_count(), 200000u);
  EXPECT_EQ(fur.strands.basis(), CurveBasis::kBSpline);
  EXPECT_EQ(fur.repairs.dropped, 0);
  EXPECT_EQ(fur.assumed_width, 0);
  for (size_t s = 0; s < 50000; s += 97) {
    EXPECT_NEAR(fur.strands.point(fur.strands.first_point(s) + 1).length(), 1.1f, 0.35f);
  }
  write_strands(folder.path() / "a.hair", fur.strands);
  const std::string theirs = read_file(data_folder() / "hair/optix_fur.hair");
  const std::string ours = read_file(folder.path() / "a.hair");
  EXPECT_EQ(ours.substr(0, 40), theirs.substr(0, 40));
  EXPECT_TRUE(ours.substr(128) == theirs.substr(128)) << "points and widths, bit for bit";
}

TEST_F(StrandFiles, ReadSintel) {
  PELAGE_REQUIRE_DATA();
  struct SintelFile {
    const char* name;
    size_t strands;
    uint32_t points;
  };
  for (const SintelFile& c : {SintelFile{"SintelHairOriginal.16points.tfx", 11400, 16},
                              SintelFile{"sintel_hair_emit.002.tfx", 228, 32}}) {
    const std::filesystem::path path = data_folder() / "tfx" / c.name;
    const StrandFile read = read_strands(path);
    EXPECT_EQ(read.strands.strand_count() + static_cast<size_t>(read.repairs.dropped), c.strands);
    EXPECT_EQ(read.strands.strand_points(0), c.points);
    EXPECT_GT(read.assumed_width, 0) << "the file states no widths";
    RecordProperty(std::string(c.name) + "_dropped", static_cast<int>(read.repairs.dropped));
    RecordProperty(std::string(c.name) + "_repaired", static_cast<int>(read.repairs.repaired));
    if (read.repairs.dropped || read.repairs.repaired) continue;
    write_strands(folder.path() / "a.tfx", read.strands);
    const std::string theirs = read_file(path), ours = read_file(folder.path() / "a.tfx");
    EXPECT_TRUE(ours.substr(160, theirs.size() - 160) == theirs.substr(160)) << "points, bit for bit";
  }
}

TEST_F(StrandFiles, OfManyStrandsNeedLittleMoreThanTheirOwnMemory) {
  if (kSanitized) GTEST_SKIP() << "sanitizers keep memory of their own";
  RandomStrandOptions options;
  options.strands = 400000;
  options.min_points = options.max_points = 8;
  std::filesystem::path path = folder.path() / "a.hair";
  write_strands(path, random_strands(8, options));
  // In a process of its own: the peak of this one may lie in the past.
  EXPECT_EXIT(
      {
        const int64_t before = peak_rss_bytes();
        const StrandFile read = read_strands(path);
        const int64_t cost = peak_rss_bytes() - before;
        std::fprintf(stderr, "%.2f times\n", double(cost) / double(read.strands.bytes()));
        std::exit(cost < 3 * static_cast<int64_t>(read.strands.bytes()) / 2 ? 0 : 1);
      },
      testing::ExitedWithCode(0), "times");
}

}  // namespace
}  // namespace pelage
