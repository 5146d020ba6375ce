// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "base/file.h"
#include "world/scene_schema.h"

namespace pelage {
namespace {

// docs/MANUAL.md must be what the program prints; tools/write_manual updates it.
TEST(ManualDocument, IsUpToDate) {
  const std::string document = read_file(PELAGE_SOURCE_DIR "/docs/MANUAL.md");
  std::string manual = manual_text(SceneDescription::schema(), {}, true);
  while (manual.ends_with('\n')) manual.pop_back();
  EXPECT_NE(document.find(manual), std::string::npos) << "run tools/write_manual";
}

}  // namespace
}  // namespace pelage
