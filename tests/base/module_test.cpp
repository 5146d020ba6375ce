// SPDX-License-Identifier: Apache-2.0
#include "base/module.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/temporary_folder.h"

namespace pelage {
namespace {

std::filesystem::path fixture_path() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path().parent_path() / "lib" /
         "libpelage_module_fixture.so";
}

int call_answer(const Module& module, int x) {
  return reinterpret_cast<int (*)(int)>(module.symbol("pelage_module_fixture_answer"))(x);
}

/// Sets PELAGE_MODULE_PATH for the time of one test.
class ModulePath {
 public:
  explicit ModulePath(const std::string& value) { ::setenv("PELAGE_MODULE_PATH", value.c_str(), 1); }
  ~ModulePath() { ::unsetenv("PELAGE_MODULE_PATH"); }
};

TEST(Module, IsFoundBesideTheExecutable) {
  const Module module("pelage_module_fixture");
  EXPECT_EQ(call_answer(module, 21), 42);
}

TEST(Module, IsFoundInAnyFolderOfTheModulePath) {
  const TemporaryFolder folder;
  std::filesystem::copy_file(fixture_path(), folder.path() / "libmoved_fixture.so");
  EXPECT_THROW(Module("moved_fixture"), Error);
  const ModulePath path("/nowhere::" + folder.path().string());
  const Module module("moved_fixture");
  EXPECT_EQ(call_answer(module, -3), -6);
}

TEST(Module, MissingOneNamesEveryPlaceThatWasTried) {
  const ModulePath path("/nowhere/at/all");
  try {
    const Module module("no_such_module");
    FAIL() << "loaded";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kFailed);
    const std::string text = error.what();
    EXPECT_NE(text.find("no_such_module"), std::string::npos) << text;
    EXPECT_NE(text.find("/nowhere/at/all/libno_such_module.so"), std::string::npos) << text;
    EXPECT_NE(text.find((fixture_path().parent_path() / "libno_such_module.so").string()), std::string::npos)
        << text;
  }
}

TEST(Module, DamagedOneIsAnError) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "libdamaged_fixture.so") << "not an object file";
  const ModulePath path(folder.path().string());
  EXPECT_THROW(Module("damaged_fixture"), Error);
}

TEST(Module, MissingFunctionIsAnErrorThatNamesIt) {
  const Module module("pelage_module_fixture");
  try {
    module.symbol("no_such_function");
    FAIL() << "found";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("no_such_function"), std::string::npos);
  }
}

}  // namespace
}  // namespace pelage
