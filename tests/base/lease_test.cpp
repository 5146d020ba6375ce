// SPDX-License-Identifier: Apache-2.0
#include "base/lease.h"

#include <atomic>
#include <csignal>
#include <fstream>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/file.h"
#include "base/temporary_folder.h"

namespace pelage {
namespace {

using std::chrono::milliseconds;
constexpr LeaseTiming kFast{milliseconds(20), milliseconds(400)};
constexpr auto kLong = std::chrono::minutes(2);  // far beyond what a wait can take
const auto kGoOn = [] { return false; };

size_t files(const std::filesystem::path& folder) {
  return static_cast<size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

/// A process that takes a lease, and then renews it until it is killed.
class Holder {
 public:
  explicit Holder(const std::filesystem::path& path) {
    int ready[2];
    EXPECT_EQ(::pipe(ready), 0);
    process_ = ::fork();
    if (process_ == 0) {
      const auto lease = Lease::take(path, kGoOn, kLong, kFast);
      (void)!::write(ready[1], lease ? "y" : "n", 1);
      for (;;) ::pause();
    }
    char byte = 'n';
    EXPECT_EQ(::read(ready[0], &byte, 1), 1);
    EXPECT_EQ(byte, 'y');
    ::close(ready[0]);
    ::close(ready[1]);
  }
  ~Holder() { kill(); }
  void send(int signal) const { ::kill(process_, signal); }
  void kill() {
    if (process_ <= 0) return;
    send(SIGKILL);
    ::waitpid(process_, nullptr, 0);
    process_ = -1;
  }

 private:
  pid_t process_ = -1;
};

/// Makes the lease look like one of another machine, whose locks this machine does not see.
void write_foreign(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path) << text;
}

TEST(Lease, ALivingProcessKeepsItForLongerThanItsExpiry) {
  const TemporaryFolder folder;
  const auto path = folder.path() / ".a.lock";
  const Holder holder(path);
  EXPECT_EQ(Lease::take(path, kGoOn, 4 * kFast.expiry, kFast), nullptr);
}

TEST(Lease, ADeadProcessOfThisMachineLosesItAtOnce) {
  const TemporaryFolder folder;
  const auto path = folder.path() / ".a.lock";
  Holder holder(path);
  holder.kill();
  // Far less than the expiry, so the lock of the system shows that the process is dead.
  const LeaseTiming never{milliseconds(20), std::chrono::hours(24)};
  EXPECT_NE(Lease::take(path, kGoOn, kLong, never), nullptr);
}

TEST(Lease, ASilentMachineLosesItAfterTheExpiry) {
  const TemporaryFolder folder;
  const auto path = folder.path() / ".a.lock";
  write_foreign(path, "elsewhere 7 1234\n00000000000000000003\n");
  EXPECT_EQ(Lease::take(path, kGoOn, kFast.expiry / 4, kFast), nullptr);
  const auto lease = Lease::take(path, kGoOn, kLong, kFast);
  EXPECT_NE(lease, nullptr);
  EXPECT_EQ(files(folder.path()), 1u);
}

TEST(Lease, AnotherMachineThatRenewsKeepsIt) {
  const TemporaryFolder folder;
  const auto path = folder.path() / ".a.lock";
  std::atomic<bool> ending = false;
  std::thread machine([&] {
    for (int count = 0; !ending; ++count) {
      write_foreign(path, "elsewhere 7 1234\n" + std::to_string(count) + "\n");
      std::this_thread::sleep_for(kFast.renewal);
    }
  });
  while (!std::filesystem::exists(path)) std::this_thread::yield();
  EXPECT_EQ(Lease::take(path, kGoOn, 4 * kFast.expiry, kFast), nullptr);
  ending = true;
  machine.join();
  EXPECT_NE(Lease::take(path, kGoOn, kLong, kFast), nullptr);
}

TEST(Lease, ASuspendedHolderDoesNotTakeItBack) {
  const TemporaryFolder folder;
  const auto path = folder.path() / ".a.lock";
  // Another machine that wakes up finds that the file is not its own; a process here must not remove it
  // either.
  auto first = Lease::take(path, kGoOn, kLong, {std::chrono::hours(1), std::chrono::hours(1)});
  ASSERT_NE(first, nullptr);
  std::filesystem::rename(path, folder.path() / ".aside.lock");  // as one that waited would
  const auto second = Lease::take(path, kGoOn, kLong, kFast);
  ASSERT_NE(second, nullptr);
  first.reset();
  EXPECT_TRUE(std::filesystem::exists(path));
}

TEST(Lease, ManyWaitFromOneExpiredLease) {
  const TemporaryFolder folder;
  const auto path = folder.path() / ".a.lock";
  write_foreign(path, "elsewhere 7 1234\n00000000000000000003\n");
  std::atomic<int> taken = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&] {
      if (Lease::take(path, kGoOn, kLong, kFast)) ++taken;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(taken, 8);
  // A lease that was put back when its holder had just ended may remain; it stops nobody.
  EXPECT_NE(Lease::take(path, kGoOn, kLong, kFast), nullptr);
  EXPECT_EQ(files(folder.path()), 0u);
}

TEST(Lease, TwoProcessesComputeOneAfterTheOther) {
  const TemporaryFolder folder;
  const auto path = folder.path() / ".a.lock", log = folder.path() / "log";
  std::vector<pid_t> processes;
  for (int i = 0; i < 2; ++i) {
    processes.push_back(::fork());
    if (processes.back() == 0) {
      for (int round = 0; round < 20; ++round) {
        const auto lease = Lease::take(path, kGoOn, kLong, kFast);
        if (!lease) ::_exit(1);
        std::ofstream(log, std::ios::app) << "b";
        std::this_thread::sleep_for(milliseconds(2));
        std::ofstream(log, std::ios::app) << "e";
      }
      ::_exit(0);
    }
  }
  for (const pid_t process : processes) {
    int status = 0;
    ASSERT_EQ(::waitpid(process, &status, 0), process);
    EXPECT_EQ(WEXITSTATUS(status), 0);
  }
  const std::string text = read_file(log);
  ASSERT_EQ(text.size(), 80u);
  for (size_t i = 0; i < text.size(); ++i) ASSERT_EQ(text[i], i % 2 == 0 ? 'b' : 'e') << i;
}

TEST(Lease, GivesUpWhereNoFileCanBeMade) {
  EXPECT_EQ(Lease::take("/proc/none/.a.lock", kGoOn, kLong), nullptr);
}

TEST(Lease, GivesUpWhereItCannotBeRead) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "entry.lock");
  EXPECT_EQ(Lease::take(
                folder.path() / "entry.lock", [] { return false; }, std::chrono::hours(1)),
            nullptr);
}

TEST(Lease, GivesUpWhenCancelled) {
  const TemporaryFolder folder;
  write_foreign(folder.path() / ".a.lock", "elsewhere 7 1234\n3\n");
  EXPECT_EQ(Lease::take(
                folder.path() / ".a.lock", [] { return true; }, kLong),
            nullptr);
}

}  // namespace
}  // namespace pelage
