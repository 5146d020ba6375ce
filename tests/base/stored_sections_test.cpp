// SPDX-License-Identifier: Apache-2.0
#include "base/stored_sections.h"

#include <gtest/gtest.h>

#include "base/content_store.h"
#include "base/error.h"
#include "base/file.h"
#include "base/temporary_folder.h"

namespace pelage::stored_sections_test {
namespace {

constexpr ContentHash kKey{7, 8};

class StoredSectionsOf : public testing::Test {
 protected:
  StoredSectionsOf() : store_(folder_.path()) {
    ContentStore::Writer writer = store_.writer("test", kKey);
    for (const std::string& text : texts_) writer.add(std::span<const char>(text));
    writer.commit([](const std::string& line) { FAIL() << line; });
  }
  std::string read(const StoredSections& file, size_t i) {
    std::string text(file.section_bytes(i), '\0');
    file.read(i, std::as_writable_bytes(std::span(text)));
    return text;
  }
  void replace(const std::string& bytes) {
    AtomicFile file(store_.file("test", kKey));
    file.write(bytes);
    file.commit();
  }
  WarningSink sink() {
    return [this](const std::string&) { ++warnings_; };
  }

  const std::vector<std::string> texts_{"one", "", std::string(300'000, 'x'), "four"};
  TemporaryFolder folder_;
  ContentStore store_;
  int warnings_ = 0;
};

TEST_F(StoredSectionsOf, are_read_one_by_one) {
  const auto file = store_.open_sections("test", kKey, sink());
  ASSERT_TRUE(file);
  ASSERT_EQ(file->section_count(), texts_.size());
  for (size_t i = texts_.size(); i-- > 0;) EXPECT_EQ(read(*file, i), texts_[i]);
  EXPECT_EQ(file->kind(), "test");
  EXPECT_EQ(file->file_bytes(), std::filesystem::file_size(file->path()));
  EXPECT_FALSE(store_.open_sections("test", {1, 1}, sink()));
  EXPECT_EQ(warnings_, 0);
}

TEST_F(StoredSectionsOf, are_checked_when_they_are_read) {
  std::string bytes = read_file(store_.file("test", kKey));
  bytes[bytes.find("xxx") + 1000] = 'y';
  replace(bytes);
  const auto file = store_.open_sections("test", kKey, sink());
  ASSERT_TRUE(file);
  EXPECT_EQ(read(*file, 0), "one");
  EXPECT_EQ(read(*file, 3), "four");
  EXPECT_THROW(read(*file, 2), Error);
}

TEST_F(StoredSectionsOf, of_a_file_that_became_shorter_are_an_error) {
  const auto file = store_.open_sections("test", kKey, sink());
  ASSERT_TRUE(file);
  std::filesystem::resize_file(file->path(), 1000);
  EXPECT_EQ(read(*file, 0), "one");
  EXPECT_THROW(read(*file, 2), Error);
}

TEST_F(StoredSectionsOf, of_what_is_damaged_or_foreign_are_absent_with_one_warning) {
  const std::string whole = read_file(store_.file("test", kKey));
  for (const size_t size : {size_t(0), size_t(50), whole.size() - 1}) {
    replace(whole.substr(0, size));
    warnings_ = 0;
    EXPECT_FALSE(store_.open_sections("test", kKey, sink()));
    EXPECT_EQ(warnings_, 1);
  }
  for (const size_t at :
       {size_t(0), size_t(9), size_t(13), size_t(20), size_t(35), whole.size() - 100, whole.size() - 3}) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    replace(damaged);
    warnings_ = 0;
    EXPECT_FALSE(store_.open_sections("test", kKey, sink())) << at;
    EXPECT_EQ(warnings_, 1) << at;
  }
}

}  // namespace
}  // namespace pelage::stored_sections_test
