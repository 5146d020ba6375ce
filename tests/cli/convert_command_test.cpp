// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/temporary_folder.h"
#include "cli/commands.h"
#include "geom/io/strand_file.h"

namespace pelage {
namespace {

/// Three strands, one of which has no extent.
Strands three_strands() {
  StrandArrays a;
  a.first_point = {0};
  for (int s = 0; s < 3; ++s) {
    for (int k = 0; k < 4; ++k) {
      const float y = s == 1 ? 0.0f : 0.25f * static_cast<float>(k);
      a.points.insert(a.points.end(), {static_cast<float>(s), y, 0, 0.01f});
    }
    a.first_point.push_back(static_cast<uint32_t>(4 * (s + 1)));
    a.ids.push_back(static_cast<uint64_t>(s));
  }
  return Strands(std::move(a));
}

class ConvertCommandTest : public testing::Test {
 protected:
  ConvertCommandTest() {
    options_.command = Command::kConvert;
    options_.input = (folder_.path() / "a.hair").string();
    write_strands(options_.input, three_strands());
  }

  TemporaryFolder folder_;
  Options options_;
};

TEST_F(ConvertCommandTest, KeepsStrandsAndSaysWhatItDropped) {
  options_.output = (folder_.path() / "b.tfx").string();
  testing::internal::CaptureStdout();
  EXPECT_EQ(run_convert(options_), 0);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), options_.output + ": 2 strands, 1 dropped\n");
  const StrandFile file = read_strands(options_.output);
  EXPECT_EQ(file.format, "tfx");
  ASSERT_EQ(file.strands.strand_count(), 2u);
  EXPECT_EQ(file.strands.point(4).x, 2);
  EXPECT_EQ(file.strands.point(7).y, 0.75f);
}

TEST_F(ConvertCommandTest, RefusesWhatIsNoStrandFile) {
  options_.output = (folder_.path() / "b.obj").string();
  try {
    run_convert(options_);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kArguments);
    EXPECT_NE(std::string(error.what()).find("written as .hair or .tfx"), std::string::npos);
  }
}

}  // namespace
}  // namespace pelage
