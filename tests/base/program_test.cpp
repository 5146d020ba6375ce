// SPDX-License-Identifier: Apache-2.0
#include "base/program.h"

#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/temporary_folder.h"

namespace pelage {
namespace {

namespace fs = std::filesystem;

TEST(ProgramTest, FindsProgramsInFoldersAndOnThePath) {
  const TemporaryFolder folder;
  const fs::path here = folder.path() / "a folder", program = here / "tool";
  fs::create_directories(here / "sub");
  std::ofstream(program) << "#!/bin/sh\n";
  EXPECT_FALSE(find_program("tool", {here})) << "it cannot be run";
  fs::permissions(program, fs::perms::owner_all);
  EXPECT_EQ(find_program("tool", {here / "none", here}), program);
  EXPECT_EQ(find_program(program.string()), program);
  EXPECT_EQ(find_program("a folder/tool", {folder.path()}), program);
  EXPECT_FALSE(find_program("sub", {here})) << "a folder";
  EXPECT_FALSE(find_program("tool"));

  const std::string before = std::getenv("PATH");
  ::setenv("PATH", ("/none:" + here.string()).c_str(), 1);
  EXPECT_EQ(find_program("tool"), program) << "a blank in PATH";
  EXPECT_FALSE(find_program("sub/tool")) << "a name with a slash is not looked for on PATH";
  ::unsetenv("PATH");
  EXPECT_FALSE(find_program("tool"));
  ::setenv("PATH", before.c_str(), 1);
}

TEST(ProgramTest, KnowsTheRunningProgram) {
  const fs::path own = current_program();
  EXPECT_TRUE(fs::exists(own));
  EXPECT_EQ(find_sibling_program(own.filename().string()), own);
  EXPECT_FALSE(find_sibling_program("no_such_program"));
}

TEST(ProgramTest, BecomesAnother) {
  const pid_t child = ::fork();
  if (child == 0) {
    try {
      become_program({"/bin/sh", "-c", "exit 7"});
    } catch (...) {
      ::_exit(99);
    }
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 7);
  EXPECT_THROW(become_program({"/no/such/program"}), Error);
}

TEST(ProgramTest, QuotesWordsForAShell) {
  EXPECT_EQ(shell_line({"a", "", "b c", "it's", "$x", "k.v=1"}), "a '' 'b c' 'it'\\''s' '$x' k.v=1");
}

}  // namespace
}  // namespace pelage
