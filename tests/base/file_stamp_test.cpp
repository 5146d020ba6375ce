// SPDX-License-Identifier: Apache-2.0
#include "base/file_stamp.h"

#include <fstream>

#include <gtest/gtest.h>

#include "base/temporary_folder.h"

namespace pelage {
namespace {

TEST(FileStamp, TellsVersionsApart) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.txt", link = folder.path() / "link";
  EXPECT_EQ(file_stamp(file), FileStamp());
  std::ofstream(file) << "one";
  const FileStamp first = file_stamp(file);
  EXPECT_NE(first, FileStamp());
  EXPECT_EQ(file_stamp(file), first);
  std::filesystem::create_symlink(file, link);
  EXPECT_EQ(file_stamp(link), first) << "of the file behind the link";
  std::ofstream(file, std::ios::app) << " more";
  EXPECT_NE(file_stamp(file), first);

  const FileStamp second = file_stamp(file);
  std::ofstream(folder.path() / "b.txt") << "two more";  // as long as the other
  std::filesystem::rename(folder.path() / "b.txt", file);
  EXPECT_NE(file_stamp(file), second) << "another file of the same name";
}

}  // namespace
}  // namespace pelage
