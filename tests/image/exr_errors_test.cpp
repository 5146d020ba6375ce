// SPDX-License-Identifier: Apache-2.0
#include "image/exr_errors.h"

#include <new>
#include <stdexcept>

#include <gtest/gtest.h>

namespace pelage {
namespace {

/// "kind: text" of what becomes of an exception.
template <class Thrown>
std::string becomes(const Thrown& thrown, ErrorKind kind) {
  try {
    guarded_exr("a.exr", kind, [&] { throw thrown; });
  } catch (const Error& error) {
    return std::to_string(static_cast<int>(error.kind())) + ": " + error.what();
  }
  return "nothing";
}

std::string text(ErrorKind kind, const std::string& what) {
  return std::to_string(static_cast<int>(kind)) + ": " + what;
}

TEST(ExrErrors, SayInOneLineWhatTheLibrarySays) {
  const std::runtime_error thrown("Cannot read image file \"a.exr\". Bad\nblock.\n");
  EXPECT_EQ(becomes(thrown, ErrorKind::kInput), text(ErrorKind::kInput, "a.exr: damaged: Bad block"));
  EXPECT_EQ(becomes(thrown, ErrorKind::kFailed), text(ErrorKind::kFailed, "a.exr: cannot write: Bad block"));
  EXPECT_EQ(becomes(std::runtime_error("no path"), ErrorKind::kInput),
            text(ErrorKind::kInput, "a.exr: damaged: no path"));
}

TEST(ExrErrors, AreOfTheirKind) {
  EXPECT_EQ(becomes(std::bad_alloc(), ErrorKind::kFailed),
            text(ErrorKind::kMemory, "a.exr: does not fit in memory"));
  // Ours stay what they are.
  EXPECT_EQ(becomes(Error(ErrorKind::kStopped, "enough"), ErrorKind::kInput),
            text(ErrorKind::kStopped, "enough"));
}

TEST(ExrErrors, GiveBackWhatTheWorkGives) {
  EXPECT_EQ(guarded_exr("a.exr", ErrorKind::kInput, [] { return 7; }), 7);
}

}  // namespace
}  // namespace pelage
