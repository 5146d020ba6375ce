// SPDX-License-Identifier: Apache-2.0
#include "rib/syntax/rib_sink.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include "base/hash.h"

namespace pelage {
namespace {

std::string unpacked(const std::string& packed) {
  z_stream z{};
  EXPECT_EQ(inflateInit2(&z, 15 + 16), Z_OK);
  std::string text(1 << 20, '\0');
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  z.avail_in = static_cast<uInt>(packed.size());
  z.next_out = reinterpret_cast<Bytef*>(text.data());
  z.avail_out = static_cast<uInt>(text.size());
  EXPECT_EQ(inflate(&z, Z_FINISH), Z_STREAM_END);
  text.resize(text.size() - z.avail_out);
  inflateEnd(&z);
  return text;
}

TEST(GzipSink, UnpacksToWhatWasWritten) {
  std::string text;
  for (uint64_t i = 0; i < 100000; ++i) text += static_cast<char>(hash64(i) % 5);
  for (const size_t length : {size_t(0), size_t(1), size_t(5000), text.size()}) {
    RibText packed;
    {
      GzipSink sink(packed);
      for (size_t at = 0; at < length; at += 777)
        sink.write(std::string_view(text).substr(at, std::min<size_t>(777, length - at)));
      sink.finish();
    }
    EXPECT_EQ(unpacked(packed.text()), text.substr(0, length));
    if (length > 4000) {
      EXPECT_LT(packed.text().size(), length / 2);
    }
  }
}

}  // namespace
}  // namespace pelage
