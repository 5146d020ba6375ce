// SPDX-License-Identifier: Apache-2.0
#include "geom/io/strand_reader.h"

#include <cmath>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "base/temporary_folder.h"
#include "tests/support/quiet_job.h"

namespace pelage {
namespace {

class StrandReaderTest : public testing::Test {
 protected:
  /// Strands of one or of many lengths; some `damaged` ones are without extent or not finite, or repeat
  /// points.
  static Strands strands(size_t count, bool equal, bool damaged) {
    StrandArrays a;
    a.first_point.push_back(0);
    StrandAttribute color{"color", AttributeClass::kPerPoint, 3, {}};
    for (size_t s = 0; s < count; ++s) {
      const uint64_t h = hash64(s, 5);
      const uint32_t points = equal ? 6 : 3 + static_cast<uint32_t>(h % 9);
      for (uint32_t p = 0; p < points; ++p) {
        float y = 0.1f * static_cast<float>(p);
        if (damaged && h % 7 == 0) y = 0;                                                  // dropped
        if (damaged && h % 7 == 1 && p == 2) y = 0.1f;                                     // a point twice
        if (damaged && h % 7 == 2 && p == 1) y = std::numeric_limits<float>::quiet_NaN();  // dropped
        a.points.insert(a.points.end(), {static_cast<float>(s), y, unit_float(h), 0.01f + unit_float(h)});
        color.values.insert(color.values.end(), {unit_float(h + p), 0.5f, y == y ? y : 0});
      }
      a.first_point.push_back(static_cast<uint32_t>(a.points.size() / 4));
      a.ids.push_back(s);
    }
    a.attributes.push_back(std::move(color));
    return Strands(std::move(a));
  }

  static void expect_same(const Strands& whole, size_t w, const Strands& some, size_t s) {
    ASSERT_EQ(whole.id(w), some.id(s));
    ASSERT_EQ(whole.strand_points(w), some.strand_points(s));
    for (uint32_t p = 0; p < whole.strand_points(w); ++p) {
      const size_t a = whole.first_point(w) + p, b = some.first_point(s) + p;
      EXPECT_EQ(whole.point(a), some.point(b));
      EXPECT_EQ(whole.radius(a), some.radius(b));
      for (size_t k = 0; k < whole.attributes().size(); ++k) {
        const StrandAttribute &of_whole = whole.attributes()[k], &of_some = some.attributes()[k];
        ASSERT_EQ(of_whole.name, of_some.name);
        const auto n = static_cast<size_t>(of_whole.components);
        for (size_t c = 0; c < n; ++c) EXPECT_EQ(of_whole.values[a * n + c], of_some.values[b * n + c]);
      }
    }
  }

  TemporaryFolder folder_;
};

TEST_F(StrandReaderTest, AnyStrandsAreThoseOfTheWholeFile) {
  for (const char* name : {"a.hair", "a.tfx"}) {
    for (const bool damaged : {false, true}) {
      for (const bool equal : {true, false}) {
        const auto file = folder_.path() / name;
        const bool tfx = file.extension() == ".tfx";
        if (tfx && !equal) continue;
        write_strands(file, strands(20000, equal, damaged));
        for (const bool guess : {false, true}) {
          StrandReadOptions options;
          if (!guess) options.default_width = 0.3f;
          const StrandFile whole = read_strands(file, options);
          StrandReader reader(file, options);
          EXPECT_EQ(reader.strands_in_file(), 20000u);
          size_t seen = 0;
          reader.scan(QuietJob(1), [&](size_t first, const Strands& some) {
            EXPECT_EQ(first, seen);
            for (size_t s = 0; s < some.strand_count(); s += 97)
              expect_same(whole.strands, first + s, some, s);
            seen += some.strand_count();
          });
          EXPECT_EQ(seen, whole.strands.strand_count());
          EXPECT_EQ(reader.strand_count(), seen);
          EXPECT_EQ(reader.repairs().dropped, whole.repairs.dropped);
          EXPECT_EQ(reader.repairs().repaired, whole.repairs.repaired);
          EXPECT_EQ(reader.repairs().dropped > 0, damaged);

          std::vector<uint32_t> wanted;
          for (uint32_t s = 0; s < seen; s += 1 + static_cast<uint32_t>(hash64(s) % 3 * 40))
            wanted.push_back(s);
          const Strands some = reader.read(wanted);
          ASSERT_EQ(some.strand_count(), wanted.size());
          for (size_t s = 0; s < wanted.size(); ++s) {
            expect_same(whole.strands, wanted[s], some, s);
            EXPECT_EQ(reader.points(wanted[s]), some.strand_points(s));
          }
        }
      }
    }
  }
}

TEST_F(StrandReaderTest, HoldsNothingOfStrandsThatAreAllAlike) {
  const auto file = folder_.path() / "a.hair";
  write_strands(file, strands(20000, true, false));
  StrandReader reader(file, {});
  reader.scan(QuietJob(1), [](size_t, const Strands&) {});
  EXPECT_EQ(reader.bytes(), 0u);
}

TEST_F(StrandReaderTest, SaysThatTheFileWasChangedInPlace) {
  const auto file = folder_.path() / "a.hair";
  write_strands(file, strands(100, true, false));
  StrandReader reader(file, {});
  reader.scan(QuietJob(1), [](size_t, const Strands&) {});
  const std::vector<uint32_t> wanted{5, 6, 40};
  EXPECT_EQ(reader.read(wanted).strand_count(), 3u);
  const float none[6 * 3] = {};
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekp(128 + 6 * 6 * 12);
  stream.write(reinterpret_cast<const char*>(none), sizeof none);  // strand 6 has no extent any more
  stream.close();
  try {
    reader.read(wanted);
    ADD_FAILURE() << "read";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kFailed);
    EXPECT_NE(std::string(error.what()).find("changed while"), std::string::npos);
  }
}

}  // namespace
}  // namespace pelage
