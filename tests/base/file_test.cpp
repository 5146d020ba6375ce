// SPDX-License-Identifier: Apache-2.0
#include "base/file.h"

#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/temporary_folder.h"

namespace pelage::file_test {
namespace {

size_t entries(const std::filesystem::path& folder) {
  return static_cast<size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

template <class Function>
Error error_of(Function&& function) {
  try {
    function();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error";
  return Error(ErrorKind::kFailed, "none");
}

TEST(ReadFile, ReturnsEveryByte) {
  const TemporaryFolder folder;
  std::string bytes(100'000, '\0');
  for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 31);
  std::ofstream(folder.path() / "f", std::ios::binary) << bytes;
  EXPECT_EQ(read_file(folder.path() / "f"), bytes);
  std::ofstream(folder.path() / "empty") << "";
  EXPECT_EQ(read_file(folder.path() / "empty"), "");
}

TEST(ReadFile, RefusesWhatIsNoRegularFileWithItsPathAndTheReason) {
  const TemporaryFolder folder;
  const Error missing = error_of([&] { read_file(folder.path() / "missing.hair"); });
  EXPECT_EQ(missing.kind(), ErrorKind::kInput);
  EXPECT_EQ(missing.problems().front().position.file, (folder.path() / "missing.hair").string());
  EXPECT_NE(std::string(missing.what()).find("No such file"), std::string::npos) << missing.what();

  const Error is_folder = error_of([&] { read_file(folder.path()); });
  EXPECT_NE(std::string(is_folder.what()).find("folder"), std::string::npos) << is_folder.what();
}

TEST(ReadFile, FollowsLinksUnlessToldNotTo) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "target") << "text";
  std::filesystem::create_symlink("target", folder.path() / "link");
  EXPECT_EQ(read_file(folder.path() / "link"), "text");
  EXPECT_EQ(read_file(folder.path() / "target", 4, OpenFile::Links::kRefuse), "text");
  EXPECT_THROW(read_file(folder.path() / "link", 4, OpenFile::Links::kRefuse), Error);
}

TEST(FileProblem, SaysWhyAPathNamesNoFile) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "file") << "x";
  std::filesystem::create_symlink("circle", folder.path() / "circle");
  EXPECT_EQ(file_problem(folder.path() / "file"), "");
  EXPECT_EQ(file_problem(folder.path()), "is not a regular file");
  EXPECT_EQ(file_problem(folder.path() / "none"), "there is no such file");
  EXPECT_EQ(file_problem(folder.path() / "file" / "none"), "there is no such file");
  EXPECT_EQ(file_problem(folder.path() / "circle").find("cannot read: "), 0u);
}

TEST(ReadFile, DoesNotHangOnAPipeWithoutAWriter) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
  const Error error = error_of([&] { read_file(folder.path() / "pipe"); });
  EXPECT_NE(std::string(error.what()).find("regular"), std::string::npos) << error.what();
}

TEST(ReadFile, RefusesMoreThanTheLimitWithoutReadingIt) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "huge") << "x";
  std::filesystem::resize_file(folder.path() / "huge", uint64_t(1) << 36);  // sparse
  const Error error = error_of([&] { read_file(folder.path() / "huge"); });
  EXPECT_EQ(error.kind(), ErrorKind::kInput);
  EXPECT_NE(std::string(error.what()).find("68719476736"), std::string::npos) << error.what();
  std::ofstream(folder.path() / "five") << "12345";
  EXPECT_EQ(read_file(folder.path() / "five", 5), "12345");
  EXPECT_THROW(read_file(folder.path() / "five", 4), Error);
}

TEST(ReadTextFile, KnowsTextInOtherClothes) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "f";
  const auto contents = [&](const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
    return read_text_file(path);
  };
  const auto refusal = [&](const std::string& bytes) {
    return std::string(error_of([&] { contents(bytes); }).what());
  };
  for (const char* text : {"", "v", "v 0 0 0", "\xef\xbb"}) {
    EXPECT_EQ(contents(text), text);
    EXPECT_EQ(contents("\xef\xbb\xbf" + std::string(text)), text) << "without the byte-order mark";
  }
  const std::string utf16 = ": is text in UTF-16; save it as UTF-8";
  for (const std::string& bytes : {std::string("\xff\xfev\0", 4), std::string("\xfe\xff\0v", 4),
                                   std::string("v\0 \0", 4), std::string("\0v\0 ", 4)})
    EXPECT_EQ(refusal(bytes), path.string() + utf16);
  EXPECT_EQ(refusal("version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\n"),
            path.string() + ": is a git-lfs pointer, not the file itself");
}

TEST(AtomicFile, FollowsLinksAndLeavesWhatIsNoFileAlone) {
  const TemporaryFolder folder;
  const auto target = folder.path() / "target", link = folder.path() / "link", pipe = folder.path() / "pipe";
  std::ofstream(target) << "old";
  std::filesystem::create_symlink(target, link);
  AtomicFile file(link);
  file.write("new");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(read_file(target), "new");

  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(AtomicFile{pipe}, Error);
  EXPECT_THROW(AtomicFile{folder.path()}, Error);
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST(AtomicFile, FollowsALinkToAFileThatIsNotThereYet) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "disk");
  std::filesystem::create_symlink("disk/one", folder.path() / "two");
  std::filesystem::create_symlink(folder.path() / "two", folder.path() / "three");
  {
    AtomicFile file(folder.path() / "three");
    file.write("text");
    file.commit();
  }
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "two"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "three"));
  EXPECT_EQ(read_file(folder.path() / "disk" / "one"), "text");

  std::filesystem::create_symlink("circle", folder.path() / "circle");
  EXPECT_EQ(error_of([&] { AtomicFile(folder.path() / "circle"); }).kind(), ErrorKind::kFailed);
}

TEST(AtomicFile, ALinkIntoAFolderThatIsNotThereMakesNone) {
  const TemporaryFolder folder;
  const auto link = folder.path() / "link";
  std::filesystem::create_symlink("disk/one", link);
  try {
    AtomicFile file(link);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kFailed);
    EXPECT_NE(std::string(error.what()).find("disk/one, whose folder does not exist"), std::string::npos)
        << error.what();
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "disk"));
  // A folder that is named is made.
  write_file(folder.path() / "new" / "one", "1");
  EXPECT_EQ(read_file(folder.path() / "new" / "one"), "1");
}

TEST(AtomicFile, ReplacesALinkWhereItIsToldTo) {
  const TemporaryFolder folder;
  const auto target = folder.path() / "target", link = folder.path() / "link";
  std::ofstream(target) << "precious";
  std::filesystem::create_symlink(target, link);
  AtomicFile file(link, Links::kReplace);
  file.write("new");
  file.commit();
  EXPECT_FALSE(std::filesystem::is_symlink(link));
  EXPECT_EQ(read_file(link), "new");
  EXPECT_EQ(read_file(target), "precious");
}

TEST(AtomicFile, FollowsNoLinkOfAnotherUser) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can give a link away";
  const TemporaryFolder folder;
  const auto target = folder.path() / "target", link = folder.path() / "link";
  std::ofstream(target) << "precious";
  std::filesystem::create_symlink(target, link);
  ASSERT_EQ(::lchown(link.c_str(), 12345, 12345), 0);
  EXPECT_NE(std::string(error_of([&] { AtomicFile{link}; }).what()).find("of another user"),
            std::string::npos);
  write_file(link, "new", Links::kReplace);
  EXPECT_EQ(read_file(target), "precious");
}

TEST(MakeOwnFolder, RefusesALink) {
  const TemporaryFolder folder;
  make_own_folder(folder.path() / "a" / "b");
  make_own_folder(folder.path() / "a" / "b");
  EXPECT_TRUE(std::filesystem::is_directory(folder.path() / "a" / "b"));
  std::filesystem::create_symlink("a", folder.path() / "link");
  EXPECT_EQ(error_of([&] { make_own_folder(folder.path() / "link"); }).kind(), ErrorKind::kFailed);
  std::ofstream(folder.path() / "file") << "x";
  EXPECT_EQ(error_of([&] { make_own_folder(folder.path() / "file"); }).kind(), ErrorKind::kFailed);
}

TEST(AtomicFile, KeepsTheModeOfWhatItReplaces) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "out.exr", link = folder.path() / "link";
  std::filesystem::create_symlink(path, link);
  for (const mode_t mode : {0640, 0600, 0444}) {
    std::ofstream(path) << "old";
    ASSERT_EQ(::chmod(path.c_str(), mode), 0);
    AtomicFile file(link);
    file.write("new");
    file.commit();
    struct stat info {};
    ASSERT_EQ(::stat(path.c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 07777, mode);
    std::filesystem::remove(path);
  }
}

TEST(AtomicFile, NamesNearlyAsLongAsFileSystemsAllowAreWritten) {
  const TemporaryFolder folder;
  for (const std::string& name :
       {std::string(255, 'a'), std::string(251, 'a') + ".exr", "a." + std::string(253, 'b')}) {
    AtomicFile file(folder.path() / name);
    file.write("text");
    file.commit();
    EXPECT_EQ(read_file(folder.path() / name), "text");
  }
}

TEST(SameFile, BySpellingAndByLinkAndBeforeItIsThere) {
  const TemporaryFolder folder;
  const auto a = folder.path() / "a", b = folder.path() / "b", none = folder.path() / "none";
  std::ofstream(a) << "a";
  std::ofstream(b) << "b";
  EXPECT_TRUE(same_file(a, folder.path() / "." / "a"));
  EXPECT_FALSE(same_file(a, b));
  EXPECT_FALSE(same_file(a, none));
  std::filesystem::create_hard_link(a, folder.path() / "hard");
  EXPECT_TRUE(same_file(a, folder.path() / "hard"));
  std::filesystem::create_symlink("a", folder.path() / "soft");
  EXPECT_TRUE(same_file(folder.path() / "soft", a));
  std::filesystem::create_symlink("none", folder.path() / "to none");
  EXPECT_TRUE(same_file(folder.path() / "to none", none));
  EXPECT_TRUE(same_file(none, folder.path() / "x" / ".." / "none"));
  EXPECT_TRUE(same_file("not there", "./not there"));
  EXPECT_FALSE(same_file("not there", "not here"));
  std::filesystem::create_symlink("circle", folder.path() / "circle");
  EXPECT_FALSE(same_file(a, folder.path() / "circle"));
  EXPECT_FALSE(same_file(folder.path() / "circle", folder.path() / "circle"));
}

TEST(AtomicFile, AppearsWholeAtCommitAndReplacesWhatWasThere) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "new" / "folders" / "out.exr";
  {
    AtomicFile file(path);
    file.write("first");
    file.write(std::as_bytes(std::span(" half", 5)));
    EXPECT_FALSE(std::filesystem::exists(path));
    file.commit();
  }
  EXPECT_EQ(read_file(path), "first half");
  AtomicFile again(path);
  again.write("second");
  EXPECT_EQ(read_file(path), "first half");
  again.commit();
  EXPECT_EQ(read_file(path), "second");
  EXPECT_EQ(entries(path.parent_path()), 1u);
}

TEST(AtomicFile, ReplacesOnlyWhatWasExpected) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.txt";
  const auto replaced = [&] {
    AtomicFile file(path);
    file.write("new");
    return file.commit_over("old");
  };
  EXPECT_FALSE(replaced()) << "there is no file";
  EXPECT_FALSE(std::filesystem::exists(path));
  write_file(path, "old");
  EXPECT_TRUE(replaced());
  EXPECT_EQ(read_file(path), "new");
  write_file(path, "another");
  EXPECT_FALSE(replaced());
  EXPECT_EQ(read_file(path), "another");
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(AtomicFile, LeavesNothingWithoutCommit) {
  const TemporaryFolder folder;
  {
    AtomicFile file(folder.path() / "out.exr");
    file.write("half of it");
    EXPECT_EQ(entries(folder.path()), 1u);
  }
  EXPECT_EQ(entries(folder.path()), 0u);
}

TEST(AtomicFile, LibrariesMayWriteThroughThePathWhichKeepsTheEnding) {
  const TemporaryFolder folder;
  AtomicFile file(folder.path() / "out.exr");
  EXPECT_EQ(file.temporary_path().extension(), ".exr");
  EXPECT_EQ(file.temporary_path().parent_path(), folder.path());
  std::ofstream(file.temporary_path()) << "by a library";
  file.commit();
  EXPECT_EQ(read_file(folder.path() / "out.exr"), "by a library");
}

TEST(AtomicFile, HasTheRightsOfAnOrdinaryFile) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "ordinary") << "x";
  AtomicFile file(folder.path() / "ours");
  file.commit();
  EXPECT_EQ(std::filesystem::status(folder.path() / "ours").permissions(),
            std::filesystem::status(folder.path() / "ordinary").permissions());
}

TEST(AtomicFile, WhatCannotBeWrittenIsAFailureWithThePath) {
  const Error error = error_of([] { AtomicFile("/proc/none/x.exr"); });
  EXPECT_EQ(error.kind(), ErrorKind::kFailed);
  EXPECT_EQ(error.problems().front().position.file, "/proc/none/x.exr");

  const TemporaryFolder folder;
  AtomicFile over_a_folder(folder.path() / "taken");
  std::filesystem::create_directory(folder.path() /
                                    "taken");  // only now: a folder there before is refused at once
  std::ofstream(folder.path() / "taken" / "inside") << "x";
  EXPECT_EQ(error_of([&] { over_a_folder.commit(); }).kind(), ErrorKind::kFailed);
}

}  // namespace
}  // namespace pelage::file_test
