// SPDX-License-Identifier: Apache-2.0
#include "base/content_store.h"

#include <atomic>
#include <csignal>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/mapped_file.h"
#include "base/temporary_folder.h"

namespace pelage {
namespace {

constexpr ContentHash kKey{0x1234, 0x5678};

struct Warnings {
  std::vector<std::string> lines;
  WarningSink sink() {
    return [this](const std::string& line) { lines.push_back(line); };
  }
};

std::string text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool store_texts(const ContentStore& store, const std::vector<std::string>& texts, Warnings& warnings,
                 const ContentHash& key = kKey) {
  std::vector<std::span<const std::byte>> sections;
  for (const std::string& t : texts) sections.push_back(std::as_bytes(std::span(t.data(), t.size())));
  return store.store("test", key, sections, warnings.sink());
}

size_t entries(const std::filesystem::path& folder) {
  return static_cast<size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(ContentStore, GivesBackWhatWasStored) {
  const TemporaryFolder folder;
  const ContentStore store(folder.path() / "not" / "there yet");
  Warnings warnings;
  EXPECT_FALSE(store.open("test", kKey, warnings.sink()));
  const std::vector<std::string> texts{"one", "", std::string(100'000, 'x'), "four"};
  ASSERT_TRUE(store_texts(store, texts, warnings));
  const auto stored = store.open("test", kKey, warnings.sink());
  ASSERT_TRUE(stored);
  ASSERT_EQ(stored->section_count(), texts.size());
  for (size_t i = 0; i < texts.size(); ++i) {
    EXPECT_EQ(text(stored->section(i)), texts[i]);
    EXPECT_EQ(reinterpret_cast<uintptr_t>(stored->section(i).data()) % 64, 0u);
  }
  EXPECT_FALSE(store.open("test", {1, 2}, warnings.sink()));
  EXPECT_FALSE(store.open("other", kKey, warnings.sink()));
  EXPECT_TRUE(is_stored_file(store.file("test", kKey)));
  EXPECT_TRUE(warnings.lines.empty());
}

TEST(ContentStore, BelievesNoFileWithAChangedByte) {
  const TemporaryFolder folder;
  const ContentStore store(folder.path());
  Warnings warnings;
  const std::vector<std::string> texts{"offsets of strands", "widths", ""};
  ASSERT_TRUE(store_texts(store, texts, warnings));
  const std::filesystem::path path = store.file("test", kKey);
  const std::string whole = read_file(path);
  for (size_t i = 0; i < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << (i % 8)));
    std::ofstream(path, std::ios::binary) << damaged;
    warnings.lines.clear();
    EXPECT_FALSE(store.open("test", kKey, warnings.sink())) << i;
    EXPECT_EQ(warnings.lines.size(), 1u) << i;
  }
}

TEST(ContentStore, RemovesWhatNothingHasUsed) {
  const TemporaryFolder folder;
  const ContentStore store(folder.path());
  Warnings warnings;
  const auto aged = [&](uint64_t key, int hours) {
    const std::string bytes = "text";
    const std::span<const std::byte> section = std::as_bytes(std::span(bytes.data(), bytes.size()));
    EXPECT_TRUE(store.store("test", {key, 0}, {&section, 1}, warnings.sink()));
    const auto path = store.file("test", {key, 0});
    std::filesystem::last_write_time(
        path, std::filesystem::file_time_type::clock::now() - std::chrono::hours(hours));
    return path;
  };
  const auto young = aged(1, 1), kept = aged(2, 100), used = aged(3, 100), old = aged(4, 100),
             older = aged(5, 200);
  const auto foreign = folder.path() / "holiday.cache";
  std::filesystem::copy_file(older, foreign);
  std::filesystem::last_write_time(foreign, std::filesystem::last_write_time(older));
  // Opening is using; and who has a file open keeps what it says.
  ASSERT_TRUE(store.open("test", {3, 0}, warnings.sink()));
  const StoredFile open(old);
  const ContentStore::Removed removed = store.prune(std::chrono::hours(50), {{kept}});
  EXPECT_EQ(removed.files, 2u);
  EXPECT_GT(removed.bytes, 0u);
  for (const auto& path : {young, kept, used, foreign}) EXPECT_TRUE(std::filesystem::exists(path)) << path;
  for (const auto& path : {old, older}) EXPECT_FALSE(std::filesystem::exists(path)) << path;
  EXPECT_EQ(text(open.section(0)), "text");
  EXPECT_EQ(ContentStore::remove_unused(foreign, std::chrono::seconds(0)).files, 0u);
  EXPECT_EQ(ContentStore(folder.path() / "none").prune(std::chrono::seconds(0)).files, 0u);
}

TEST(ContentStore, TakesCutForeignAndEmptyFilesForAbsent) {
  const TemporaryFolder folder;
  const ContentStore store(folder.path());
  Warnings warnings;
  ASSERT_TRUE(store_texts(store, {"something", "more"}, warnings));
  const std::filesystem::path path = store.file("test", kKey);
  const std::string whole = read_file(path);
  std::vector<std::string> wrong{"", "a text", whole + "x", std::string(whole.size(), '\0'), whole + whole};
  for (size_t length = 1; length < whole.size(); length += 7) wrong.push_back(whole.substr(0, length));
  for (const std::string& bytes : wrong) {
    std::ofstream(path, std::ios::binary) << bytes;
    warnings.lines.clear();
    EXPECT_FALSE(store.open("test", kKey, warnings.sink()));
    ASSERT_EQ(warnings.lines.size(), 1u);
    EXPECT_NE(warnings.lines[0].find(path.string()), std::string::npos) << warnings.lines[0];
  }
  // The right bytes under another name.
  std::ofstream(path, std::ios::binary) << whole;
  std::filesystem::copy_file(path, store.file("test", {7, 7}));
  warnings.lines.clear();
  EXPECT_FALSE(store.open("test", {7, 7}, warnings.sink()));
  EXPECT_EQ(warnings.lines.size(), 1u);
  // A folder where the entry should be.
  std::filesystem::create_directory(store.file("test", {8, 8}));
  warnings.lines.clear();
  EXPECT_FALSE(store.open("test", {8, 8}, warnings.sink()));
  EXPECT_EQ(warnings.lines.size(), 1u);
}

TEST(ContentStore, GoesOnWithoutAFolderThatTakesFiles) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "a file") << "x";
  const ContentStore store(folder.path() / "a file" / "cache");
  Warnings warnings;
  EXPECT_FALSE(store.lock("test", kKey).held());
  EXPECT_FALSE(store_texts(store, {"something", "more"}, warnings));
  EXPECT_EQ(warnings.lines.size(), 1u);
  EXPECT_FALSE(store.open("test", kKey, warnings.sink()));
  EXPECT_EQ(warnings.lines.size(), 1u);
}

// A child process that may write no file longer than 4 KiB, as on a disk that is full.
TEST(ContentStore, AFullDiskLeavesNothing) {
  const TemporaryFolder folder;
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{4096, 4096};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    Warnings warnings;
    const ContentStore store(folder.path());
    const bool stored = store_texts(store, {std::string(3000, 'a'), std::string(3000, 'b')}, warnings);
    ::_exit(!stored && warnings.lines.size() == 1 ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_EQ(entries(folder.path()), 0u);
}

TEST(ContentStore, AKillInTheMiddleLeavesNoEntryAndGivesTheLockBack) {
  const TemporaryFolder folder;
  const ContentStore store(folder.path());
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const ContentStore::Lock lock = store.lock("test", kKey);
    ContentStore::Writer writer = store.writer("test", kKey);
    writer.add(std::as_bytes(std::span("half of it", 10)));
    (void)!::write(ready[1], "x", 1);
    for (;;) ::pause();
  }
  char byte = 0;
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  EXPECT_FALSE(store
                   .lock(
                       "test", kKey, [] { return false; }, std::chrono::milliseconds(30))
                   .held());
  // A cancelled thread stops waiting.
  EXPECT_FALSE(store.lock("test", kKey, [] { return true; }).held());
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  ::close(ready[0]);
  ::close(ready[1]);

  Warnings warnings;
  EXPECT_FALSE(store.open("test", kKey, warnings.sink()));
  EXPECT_TRUE(warnings.lines.empty());
  EXPECT_GE(entries(folder.path()), 1u) << "the temporary file of the dead";
  store.sweep(std::chrono::hours(1));
  EXPECT_GE(entries(folder.path()), 1u) << "might be of a living one";
  {
    const ContentStore::Lock lock = store.lock("test", kKey);
    EXPECT_TRUE(lock.held());
  }
  store.sweep(std::chrono::seconds(-1));
  EXPECT_EQ(entries(folder.path()), 0u);
}

TEST(ContentStore, OneComputesWhileTheOthersWait) {
  const TemporaryFolder folder;
  const ContentStore store(folder.path());
  std::atomic<int> computed{0}, inside{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&] {
      Warnings warnings;
      const ContentStore::Lock lock = store.lock("test", kKey);
      EXPECT_TRUE(lock.held());
      EXPECT_EQ(++inside, 1);
      if (!store.open("test", kKey, warnings.sink())) {
        ++computed;
        EXPECT_TRUE(store_texts(store, {"the one"}, warnings));
      }
      --inside;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(computed, 1);
  EXPECT_EQ(entries(folder.path()), 1u) << "no lock is left";
}

TEST(ContentStore, NeitherReadsNorWritesThroughALink) {
  const TemporaryFolder folder;
  const auto precious = folder.path() / "precious", elsewhere = folder.path() / "elsewhere";
  const ContentStore store(folder.path() / "cache"), other(elsewhere);
  Warnings warnings;
  ASSERT_TRUE(store_texts(other, {"of another store"}, warnings));
  std::filesystem::create_directory(store.folder());
  // Of this very kind and key, so that a reader that follows would believe it.
  std::filesystem::create_symlink(other.file("test", kKey), store.file("test", kKey));
  EXPECT_FALSE(store.open("test", kKey, warnings.sink()));
  EXPECT_FALSE(store.open_sections("test", kKey, warnings.sink()));
  ASSERT_EQ(warnings.lines.size(), 2u);
  EXPECT_NE(warnings.lines[0].find("symbolic link"), std::string::npos) << warnings.lines[0];

  std::ofstream(precious) << "precious";
  std::filesystem::remove(store.file("test", kKey));
  std::filesystem::create_symlink(precious, store.file("test", kKey));
  EXPECT_TRUE(store_texts(store, {"new"}, warnings));
  EXPECT_EQ(read_file(precious), "precious");
  const auto stored = store.open("test", kKey, warnings.sink());
  ASSERT_TRUE(stored);
  EXPECT_EQ(text(stored->section(0)), "new");

  // The age that counts is that of the link; nothing behind it goes.
  std::filesystem::remove(store.file("test", kKey));
  std::filesystem::create_symlink(precious, store.file("test", kKey));
  store.prune(std::chrono::seconds(-1));
  EXPECT_EQ(read_file(precious), "precious");
}

TEST(ContentStore, TheFolderMayBeALink) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "disk");
  std::filesystem::create_symlink("disk", folder.path() / "cache");
  const ContentStore store(folder.path() / "cache");
  Warnings warnings;
  EXPECT_TRUE(store_texts(store, {"text"}, warnings));
  EXPECT_TRUE(store.open("test", kKey, warnings.sink()));
  EXPECT_TRUE(warnings.lines.empty());
}

TEST(ContentStore, BelievesOtherUsersOnlyInFoldersThatAreSharedByName) {
  const TemporaryFolder folder;
  const ContentStore store(folder.path() / "farm" / "cache");
  Warnings warnings;
  ASSERT_TRUE(store_texts(store, {"by another"}, warnings));
  if (::chown(store.file("test", kKey).c_str(), 12345, 12345) != 0)
    GTEST_SKIP() << "only root can make a file of another user";
  EXPECT_FALSE(store.open("test", kKey, warnings.sink()));
  EXPECT_FALSE(store.open_sections("test", kKey, warnings.sink()));
  ASSERT_EQ(warnings.lines.size(), 2u);
  EXPECT_NE(warnings.lines[0].find("PELAGE_SHARED_CACHES"), std::string::npos) << warnings.lines[0];

  const auto opens_with = [&](const std::string& shared) {
    ::setenv("PELAGE_SHARED_CACHES", shared.c_str(), 1);
    const bool opens = store.open("test", kKey, warnings.sink()).has_value();
    ::unsetenv("PELAGE_SHARED_CACHES");
    return opens;
  };
  EXPECT_TRUE(opens_with(store.folder()));
  EXPECT_TRUE(opens_with("/nowhere:" + (folder.path() / "farm" / ".").string()));
  EXPECT_FALSE(opens_with(""));
  EXPECT_FALSE(opens_with(":"));
  EXPECT_FALSE(opens_with(folder.path() / "far"));

  // Its own, in place of the other's.
  EXPECT_TRUE(store_texts(store, {"mine"}, warnings));
  EXPECT_TRUE(store.open("test", kKey, warnings.sink()));
}

TEST(FileHash, IsThatOfAllBytes) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "f";
  for (const size_t bytes : {size_t(0), size_t(9), (size_t(256) << 10), size_t(1'000'003)}) {
    std::string all(bytes, 'x');
    for (size_t i = 0; i < bytes; ++i) all[i] = static_cast<char>(mix64(i));
    std::ofstream(path) << all;
    EXPECT_EQ(file_hash(path), content_hash(std::as_bytes(std::span(all)))) << bytes;
  }
  EXPECT_THROW(file_hash(folder.path()), Error);
  EXPECT_THROW(file_hash(folder.path() / "none"), Error);
}

TEST(MappedFile, HoldsEveryByteAndRefusesWhatIsNoFile) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "f";
  std::ofstream(path) << "all of it";
  MappedFile file(path);
  EXPECT_EQ(text(file.bytes()), "all of it");
  const MappedFile moved = std::move(file);
  EXPECT_EQ(text(moved.bytes()), "all of it");
  std::ofstream(folder.path() / "empty") << "";
  EXPECT_TRUE(MappedFile(folder.path() / "empty").bytes().empty());
  EXPECT_THROW(MappedFile(folder.path()), Error);
  EXPECT_THROW(MappedFile(folder.path() / "none"), Error);
}

}  // namespace
}  // namespace pelage
