// SPDX-License-Identifier: Apache-2.0
#include "rib/syntax/rib_writer.h"

#include <bit>
#include <limits>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "tests/rib/syntax/rib_tokens.h"

namespace pelage {
namespace {

std::string written(RibEncoding encoding, const std::function<void(RibWriter&)>& write) {
  RibText text;
  RibWriter rib(text, encoding);
  write(rib);
  rib.end_line();
  rib.flush();
  return text.text();
}

TEST(RibWriter, WritesPlainText) {
  const std::string text = written(RibEncoding::kAscii, [](RibWriter& rib) {
    rib.comment("#RenderMan RIB");
    rib.request("Projection").text("perspective").parameter("float fov").numbers({40.5f});
    rib.request("Format").integer(640).integer(-3).number(1);
    rib.request("Procedural").texts({"a \"b\"", "c\\d\n"});
  });
  EXPECT_EQ(text,
            "##RenderMan RIB\n"
            "Projection \"perspective\" \"float fov\" [40.5]\n"
            "Format 640 -3 1\n"
            "Procedural [\"a \\\"b\\\"\" \"c\\\\d\\n\"]\n");
}

TEST(RibWriter, EncodesTokensAsTheTableSays) {
  const auto bytes = [](std::initializer_list<int> values) {
    std::string text;
    for (const int value : values) text += static_cast<char>(value);
    return text;
  };
  EXPECT_EQ(written(RibEncoding::kBinary, [](RibWriter& rib) { rib.request("Sides").integer(2); }),
            bytes({0314, 0, 0225, 'S', 'i', 'd', 'e', 's', 0246, 0, 0200, 2}));
  EXPECT_EQ(written(RibEncoding::kBinary, [](RibWriter& rib) { rib.integer(-256).number(1.5f); }),
            bytes({0201, 0xff, 0x00, 0244, 0x3f, 0xc0, 0, 0}));
  EXPECT_EQ(written(RibEncoding::kBinary, [](RibWriter& rib) { rib.numbers({-2.0f}); }),
            bytes({0310, 1, 0xc0, 0, 0, 0}));
}

/// Requests with all kinds of arguments, the same for both encodings.
void write_random(RibWriter& rib, uint64_t seed) {
  for (uint64_t request = 0; request < 40; ++request) {
    rib.request("Request" + std::to_string(hash64(seed, request) % 7));
    for (uint64_t argument = 0; argument < 5; ++argument) {
      const uint64_t hash = hash64(seed, request, argument);
      std::vector<float> floats(hash % 400);
      for (size_t i = 0; i < floats.size(); ++i) {
        const auto bits = static_cast<uint32_t>(hash64(hash, i));
        floats[i] = std::bit_cast<float>((bits & 0x7f800000u) == 0x7f800000u ? bits & 0x807fffffu : bits);
      }
      std::vector<int32_t> integers(hash % 300);
      for (size_t i = 0; i < integers.size(); ++i)
        integers[i] = static_cast<int32_t>(hash64(hash, i, 1)) >> (hash64(hash, i, 2) % 32);
      switch (hash >> 61) {
        case 0:
          rib.numbers(floats);
          break;
        case 1:
          rib.integers(integers);
          break;
        case 2:
          rib.integer(static_cast<int32_t>(hash)).integer(std::numeric_limits<int32_t>::min());
          break;
        case 3:
          rib.number(floats.empty() ? -0.0f : floats[0]);
          break;
        case 4:
          rib.text(std::string(hash % 70000, 'x') + "\"\\");
          break;
        case 5:
          rib.texts({"", "a b"});
          break;
        default:
          rib.parameter("uniform float p" + std::to_string(hash % 400)).numbers(floats);
      }
    }
  }
}

TEST(RibWriter, BothEncodingsCarryTheSameValuesBitForBit) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const auto write = [&](RibWriter& rib) { write_random(rib, seed); };
    const std::string text = written(RibEncoding::kAscii, write),
                      binary = written(RibEncoding::kBinary, write);
    const auto a = rib_requests(text), b = rib_requests(binary);
    ASSERT_EQ(a.size(), 40u);
    ASSERT_EQ(b.size(), a.size());
    for (size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].name, b[i].name);
      ASSERT_EQ(a[i].arguments.size(), b[i].arguments.size());
      for (size_t k = 0; k < a[i].arguments.size(); ++k) {
        const RibArgument &one = a[i].arguments[k], &other = b[i].arguments[k];
        EXPECT_EQ(one.texts, other.texts);
        ASSERT_EQ(one.numbers.size(), other.numbers.size());
        for (size_t n = 0; n < one.numbers.size(); ++n)
          ASSERT_EQ(static_cast<float>(one.numbers[n]), static_cast<float>(other.numbers[n]));
      }
    }
  }
}

TEST(RibWriter, UsesPlainStringsWhenTheCodesAreUsedUp) {
  const std::string bytes = written(RibEncoding::kBinary, [](RibWriter& rib) {
    rib.request("Attribute");
    for (int i = 0; i < 600; ++i) rib.parameter("float p" + std::to_string(i % 300)).number(1);
  });
  const auto requests = rib_requests(bytes);
  ASSERT_EQ(requests.size(), 1u);
  for (size_t i = 0; i < 600; ++i)
    EXPECT_EQ(requests[0].arguments[2 * i].texts.at(0), "float p" + std::to_string(i % 300));
}

}  // namespace
}  // namespace pelage
