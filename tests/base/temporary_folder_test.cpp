// SPDX-License-Identifier: Apache-2.0
#include "base/temporary_folder.h"

#include <fstream>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "base/error.h"

namespace pelage {
namespace {

namespace fs = std::filesystem;

void touch(const fs::path& path) { std::ofstream(path) << "x"; }

TEST(TemporaryFolder, IsNewEmptyAndGoneAtTheEnd) {
  fs::path path;
  {
    const TemporaryFolder folder, another;
    path = folder.path();
    EXPECT_EQ(path.parent_path(), fs::temp_directory_path());
    EXPECT_TRUE(path.filename().string().starts_with("pelage-")) << path;
    EXPECT_TRUE(fs::is_directory(path));
    EXPECT_TRUE(fs::is_empty(path));
    EXPECT_NE(path, another.path());
    fs::create_directories(path / "deep" / "deeper");
    touch(path / "deep" / "file");
    touch(another.path() / "kept");
    fs::create_directory_symlink(another.path(), path / "link");
  }
  EXPECT_FALSE(fs::exists(path));
}

TEST(TemporaryFolder, LeavesWhatStoodBesideIt) {
  const TemporaryFolder outer;
  const fs::path parent = outer.path() / "made" / "for it";
  {
    const TemporaryFolder inner(parent);
    EXPECT_EQ(inner.path().parent_path(), parent);
    touch(parent / "mine");
    // A link is removed, not what it leads to.
    fs::create_directory_symlink(parent, inner.path() / "link");
  }
  EXPECT_TRUE(fs::exists(parent / "mine"));
  EXPECT_EQ(std::distance(fs::directory_iterator(parent), fs::directory_iterator()), 1);
}

TEST(TemporaryFolder, MayBeGoneBefore) {
  std::optional<TemporaryFolder> folder(std::in_place);
  fs::remove_all(folder->path());
  folder.reset();
}

TEST(TemporaryFolder, SaysWhereItCannotBe) {
  const TemporaryFolder outer;
  const fs::path file = outer.path() / "file";
  touch(file);
  for (const fs::path& parent : {file, file / "below", fs::path("/proc/none")}) {
    try {
      const TemporaryFolder folder(parent);
      ADD_FAILURE() << folder.path();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kFailed);
      EXPECT_TRUE(std::string(error.what()).starts_with(parent.string() + ": cannot write: "))
          << error.what();
    }
  }
}

}  // namespace
}  // namespace pelage
