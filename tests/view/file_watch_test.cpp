// SPDX-License-Identifier: Apache-2.0
#include "view/file_watch.h"

#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include "base/file.h"
#include "base/temporary_folder.h"

namespace pelage {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLong{20000}, kNone{0};

class FileWatchTest : public testing::Test {
 protected:
  FileWatchTest() {
    write("a.yaml");
    watch_.watch({path("a.yaml")});
  }
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
  void write(const std::string& name) const { std::ofstream(path(name)) << "text"; }
  TemporaryFolder folder_;
  FileWatch watch_;
};

TEST_F(FileWatchTest, SeesEveryWayToSave) {
  for (int round = 0; round < 3; ++round) {  // a watch of the file itself would end with the first rename
    write("a.yaml");
    EXPECT_TRUE(watch_.wait(kLong)) << "written in place";
    write("a.yaml.new");
    std::filesystem::rename(path("a.yaml.new"), path("a.yaml"));
    EXPECT_TRUE(watch_.wait(kLong)) << "replaced by renaming";
    std::filesystem::rename(path("a.yaml"), path("a.yaml~"));
    EXPECT_TRUE(watch_.wait(kLong)) << "moved to a backup";
    write("a.yaml");
    EXPECT_TRUE(watch_.wait(kLong)) << "created again";
    std::filesystem::remove(path("a.yaml"));
    EXPECT_TRUE(watch_.wait(kLong)) << "removed";
    write("a.yaml");
    EXPECT_TRUE(watch_.wait(kLong));
    EXPECT_FALSE(watch_.wait(kNone)) << "nothing more happened";
  }
}

TEST_F(FileWatchTest, OtherFilesDoNotCount) {
  write("b.yaml");
  EXPECT_FALSE(watch_.wait(kNone));
  watch_.watch({path("b.yaml"), path("none/c.yaml")});
  write("a.yaml");
  EXPECT_FALSE(watch_.wait(kNone));
  write("b.yaml");
  EXPECT_TRUE(watch_.wait(kLong));
}

TEST_F(FileWatchTest, FollowsLinks) {
  const TemporaryFolder elsewhere;
  std::ofstream(elsewhere.path() / "target.yaml") << "text";
  std::filesystem::create_symlink(elsewhere.path() / "target.yaml", path("link.yaml"));
  watch_.watch({path("link.yaml")});
  std::ofstream(elsewhere.path() / "target.yaml") << "more";
  EXPECT_TRUE(watch_.wait(kLong));
}

TEST_F(FileWatchTest, AnotherThreadCanEndTheWait) {
  std::thread other([this] { watch_.wake(); });
  EXPECT_FALSE(watch_.wait(kLong));
  other.join();
}

}  // namespace
}  // namespace pelage
