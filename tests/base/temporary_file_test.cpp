// SPDX-License-Identifier: Apache-2.0
#include "base/temporary_file.h"

#include <csignal>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/file.h"
#include "base/temporary_folder.h"

namespace pelage::temporary_file_test {
namespace {

size_t entries(const std::filesystem::path& folder) {
  return static_cast<size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

/// A process of its own that has begun to write a file; killed in the end.
class Writer {
 public:
  explicit Writer(const std::filesystem::path& target) {
    int ready[2];
    EXPECT_EQ(::pipe(ready), 0);
    process_ = ::fork();
    if (process_ == 0) {
      AtomicFile file(target);
      file.write("half of it");
      (void)!::write(ready[1], "x", 1);
      for (;;) ::pause();
    }
    char byte = 0;
    EXPECT_EQ(::read(ready[0], &byte, 1), 1);
    ::close(ready[0]);
    ::close(ready[1]);
  }
  ~Writer() { kill(); }
  void kill() {
    if (process_ <= 0) return;
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
    process_ = 0;
  }

 private:
  pid_t process_;
};

TEST(TemporaryFile, ThoseOfKilledProcessesAloneAreSwept) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / ".pelage-notes") << "of a user";
  std::ofstream(folder.path() / "out.exr") << "a picture";
  {
    Writer dead(folder.path() / "out.exr"), alive(folder.path() / "out.exr");
    const AtomicFile own(folder.path() / "out.exr");
    EXPECT_EQ(entries(folder.path()), 5u);
    sweep_temporaries(folder.path());
    EXPECT_EQ(entries(folder.path()), 5u) << "all three still write";
    dead.kill();
    sweep_temporaries(folder.path());
    EXPECT_EQ(entries(folder.path()), 4u);
  }
  sweep_temporaries(folder.path());
  EXPECT_EQ(entries(folder.path()), 2u);
  EXPECT_EQ(read_file(folder.path() / "out.exr"), "a picture");
}

TEST(TemporaryFile, ThoseOfOtherMachinesUsersAndHoldersOfTheLockAreLeftAlone) {
  const TemporaryFolder folder;
  std::string name;
  {
    Writer writer(folder.path() / "out.exr");
    name = std::filesystem::directory_iterator(folder.path())->path().filename().string();
  }
  ASSERT_EQ(name.rfind(kTemporaryPrefix, 0), 0u);
  const auto own = folder.path() / name;

  const std::string foreign = std::string(kTemporaryPrefix) + "other" + name.substr(kTemporaryPrefix.size());
  std::ofstream(folder.path() / foreign) << "x";
  sweep_temporaries(folder.path());
  EXPECT_TRUE(std::filesystem::exists(folder.path() / foreign)) << foreign;
  EXPECT_FALSE(std::filesystem::exists(own));

  // The writer may be where its process cannot be seen.
  std::ofstream(own) << "x";
  const int held = ::open(own.c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(::flock(held, LOCK_EX), 0);
  sweep_temporaries(folder.path());
  EXPECT_TRUE(std::filesystem::exists(own));
  ::close(held);
  sweep_temporaries(folder.path());
  EXPECT_FALSE(std::filesystem::exists(own));

  std::ofstream(own) << "x";
  if (::chown(own.c_str(), 12345, 12345) == 0) {
    sweep_temporaries(folder.path());
    EXPECT_TRUE(std::filesystem::exists(own));
  }
  // A link is no file that was being written.
  std::filesystem::remove(own);
  std::ofstream(folder.path() / "precious") << "x";
  std::filesystem::create_symlink("precious", own);
  sweep_temporaries(folder.path());
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "precious"));
}

}  // namespace
}  // namespace pelage::temporary_file_test
