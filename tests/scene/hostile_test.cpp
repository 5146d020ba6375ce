// SPDX-License-Identifier: Apache-2.0
#include <functional>
#include <map>

#include <gtest/gtest.h>

#include "base/file.h"
#include "base/hash.h"
#include "scene/document.h"
#include "tests/scene/document_text.h"
#include "tests/support/allocation_meter.h"

// No text may crash the reader, hang it or make it allocate much. A hang is caught by the time limit of
// CTest.

namespace pelage {
namespace {

// Parses anything; every way of failing must be an Error whose lines are lines.
bool is_accepted(const std::string& text) {
  try {
    parse_document(text, "s.yaml");
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_FALSE(error.problems().empty());
    for (const Problem& problem : error.problems()) {
      EXPECT_EQ(problem.message.find_first_of("\n\r\x1b"), std::string::npos);
      EXPECT_EQ(problem.position.file, "s.yaml");
      EXPECT_GE(problem.position.line, 1);
    }
    return false;
  }
}

std::string rat() { return read_file(std::filesystem::path(PELAGE_SOURCE_DIR) / "examples" / "rat.yaml"); }

TEST(HostileYaml, TruncatedAtEveryByte) {
  const std::string scene = rat();
  ASSERT_TRUE(is_accepted(scene));
  size_t refused = 0;
  for (size_t length = 0; length < scene.size(); ++length)
    refused += is_accepted(scene.substr(0, length)) ? 0 : 1;
  EXPECT_GT(refused, scene.size() / 10);
}

TEST(HostileYaml, RandomBytesChanged) {
  const std::string scene = rat();
  for (uint64_t trial = 0; trial < 1500; ++trial) {
    std::string text = scene;
    const uint64_t changes = 1 + hash64(trial, 0) % 8;
    for (uint64_t i = 1; i <= changes; ++i) {
      const size_t place = hash64(trial, i, 1) % text.size();
      text[place] = static_cast<char>(trial % 2 ? hash64(trial, i, 2) & 0xff
                                                : text[place] ^ (1 << hash64(trial, i, 2) % 8));
    }
    is_accepted(text);
  }
}

TEST(HostileYaml, RandomPunctuation) {
  constexpr std::string_view kPieces[] = {"[",   "]",    "{", "}", ":",   ": ",  "- ",  "? ", ",",
                                          "\n",  "\n  ", " ", "a", "\"",  "'",   "&x ", "*x", "!t ",
                                          "|\n", ">\n",  "#", "%", "---", "...", "~",   "<<"};
  for (uint64_t trial = 0; trial < 20000; ++trial) {
    std::string text;
    for (uint64_t i = 0; i < 1 + trial % 24; ++i) text += kPieces[hash64(trial, i) % std::size(kPieces)];
    is_accepted(text);
  }
}

std::string repeated(const std::string& piece, size_t bytes) {
  std::string text;
  while (text.size() < bytes) text += piece;
  return text;
}

std::string numbered(size_t count, const std::function<std::string(std::string)>& line) {
  std::string text;
  for (size_t i = 0; i < count; ++i) text += line(std::to_string(i));
  return text;
}

TEST(HostileYaml, BombsAreRefusedForLittle) {
  constexpr size_t kBytes = 200'000;
  std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 12; ++i) {
    const std::string alias = "*a" + std::to_string(i - 1) + ", ";
    bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + repeated(alias, 9 * alias.size()) +
            "]\n";
  }
  const std::map<std::string, std::string> bombs{
      {"alias bomb", bomb},
      {"an alias of itself", "a: &a [*a, *a]\n"},
      {"a merge of itself", "a: &a\n  <<: *a\n"},
      {"lists", "a: " + repeated("[", kBytes)},
      {"blocks", repeated("{a: ", kBytes)},
      {"lists that hide their depth", repeated("[ #]\n", kBytes)},
      {"open and closed", "a: " + repeated("[[],", kBytes)},
      {"dashes", repeated("- ", kBytes)},
      {"question marks", repeated("? ", kBytes)},
      {"anchors", "a: " + repeated("&a ", kBytes)},
      {"many anchors", numbered(10000, [](const std::string& i) { return "a" + i + ": &a" + i + " 1\n"; })},
      {"tags", "a: " + repeated("!", kBytes)},
      {"directives", repeated("%TAG ! a\n", kBytes)},
      {"documents", repeated("---\n", kBytes)},
      {"the same key", repeated("a: 1\n", kBytes)},
      {"indentation",
       numbered(700, [](const std::string& i) { return std::string(std::stoul(i), ' ') + "a:\n"; })},
      {"a colon a key", repeated("a:", kBytes)},
      {"open quotes", numbered(10000, [](const std::string& i) { return "a" + i + ": 'x\n"; })},
      {"values", "a: [" + repeated("1,", 3 * kBytes) + "]"},
      {"keys", numbered(120'000, [](const std::string& i) { return "k" + i + ": 1\n"; })},
  };
  for (const auto& [name, text] : bombs) {
    SCOPED_TRACE(name);
    reset_peak();
    const size_t before = live_bytes();
    EXPECT_FALSE(is_accepted(text));
    EXPECT_LT(peak_bytes() - before, size_t(100) << 20);
    EXPECT_LT(live_bytes() - before, size_t(1) << 20) << "it leaks";
  }
}

TEST(HostileYaml, OddButHarmless) {
  constexpr size_t kBytes = 200'000;
  for (const std::string& text :
       {"a: " + repeated("x", kBytes), "a: '" + repeated("x", kBytes) + "'",
        "a: [" + repeated("\n", kBytes) + "]", "a: |\n" + repeated(" x\n", kBytes),
        "a: >\n" + repeated(" x\n\n", kBytes), "#" + repeated("#", kBytes),
        "a: [" + repeated(",", 50'000) + "]", "a: \"" + repeated("\\x41", kBytes) + "\""}) {
    reset_peak();
    const size_t before = live_bytes();
    EXPECT_TRUE(is_accepted(text)) << text.substr(0, 20);
    EXPECT_LT(peak_bytes() - before, size_t(100) << 20);
  }
}

}  // namespace
}  // namespace pelage
