// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/right_checksums.h"

#include <gtest/gtest.h>

#include "base/stored_sections.h"
#include "tests/fuzz/corpus.h"
#include "tests/fuzz/fuzz_targets.h"

namespace pelage {
namespace {

std::vector<uint8_t> mended(const std::string& bytes) {
  return with_right_checksums({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
}

TEST(RightChecksums, ChangeNothingOfAFileInOrder) {
  std::vector<std::string> files = cache_corpus();
  files.push_back(chunks_corpus().front());
  for (const std::string& file : files)
    EXPECT_EQ(mended(file), std::vector<uint8_t>(file.begin(), file.end()));
}

TEST(RightChecksums, LetDamageThrough) {
  const std::string whole = chunks_corpus().front();
  int damaged = 0;
  for_each_damaged(whole, 100, [&](const std::string& bytes) {
    if (bytes.size() < 200) return;
    const std::vector<uint8_t> file = mended(bytes);
    // The kind is not mended: whether it is one is for the reader to say.
    if (bytes.substr(16, 16) != whole.substr(16, 16)) return;
    const StoredSections sections(fuzz_file(file, ".cache"));
    for (size_t i = 0; i < sections.section_count(); ++i) {
      std::vector<std::byte> content(sections.section_bytes(i));
      if (!content.empty()) sections.read(i, content);
    }
    ++damaged;
  });
  EXPECT_GT(damaged, 200);
}

TEST(RightChecksums, LeaveWhatIsTooShort) {
  for (size_t bytes = 0; bytes < 112; ++bytes) {
    const std::string text(bytes, 'x');
    EXPECT_EQ(mended(text), std::vector<uint8_t>(text.begin(), text.end()));
  }
}

}  // namespace
}  // namespace pelage
