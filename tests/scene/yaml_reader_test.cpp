// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "scene/document.h"
#include "tests/scene/document_text.h"

namespace pelage {
namespace {

std::string parsed(const std::string& text) { return flat(parse_document(text, "s.yaml")); }
Lines problems(const std::string& text) {
  return error_lines([&] { parse_document(text, "s.yaml"); });
}

const Value& at(const Value& root, const std::vector<std::string>& path) {
  const Value* value = &root;
  for (const std::string& name : path) {
    value = value->is_list() ? &value->items().at(static_cast<size_t>(std::stoi(name))) : value->find(name);
    if (!value) throw std::runtime_error("no " + name);
  }
  return *value;
}

TEST(Yaml, ReadsWhatScenesAreMadeOf) {
  EXPECT_EQ(parsed("a: 1\nb: [1, 2.5, x y]\nc: {d: \"5\", e: 'it''s'}\n"),
            "{a: 1, b: [1, 2.5, x y], c: {d: \"5\", e: \"it's\"}}");
  EXPECT_EQ(parsed("a:\n  - b: 1\n    c: 2\n  - 3\n"), "{a: [{b: 1, c: 2}, 3]}");
  EXPECT_EQ(parsed("a:\nb: ~\nc: null\nd: \"null\"\n"), "{a: null, b: null, c: null, d: \"null\"}");
  EXPECT_EQ(parsed("# only a comment\n"), "{}");
  EXPECT_EQ(parsed(""), "{}");
  EXPECT_EQ(parsed("---\na: 1\n...\n"), "{a: 1}");
  EXPECT_EQ(parsed("\xef\xbb\xbf"
                   "a: 1\r\nb: 2\r\n"),
            "{a: 1, b: 2}");
}

TEST(Yaml, PositionsCountCharacters) {
  const Value root = parse_document(
      "fur: {\xc3\xa4\xc3\xb6: 1, b: [7, \xf0\x9f\x90\x80, 8]}\nlist:\n  - x\n  - {y: z}\n", "s");
  const auto where = [&](const std::vector<std::string>& path) {
    return to_string(at(root, path).position());
  };
  EXPECT_EQ(where({}), "s:1:1");
  EXPECT_EQ(where({"fur"}), "s:1:6");
  EXPECT_EQ(where({"fur", "\xc3\xa4\xc3\xb6"}), "s:1:11");
  EXPECT_EQ(where({"fur", "b", "0"}), "s:1:18");
  EXPECT_EQ(where({"fur", "b", "2"}), "s:1:24");
  EXPECT_EQ(where({"list", "0"}), "s:3:5");
  EXPECT_EQ(where({"list", "1", "y"}), "s:4:9");
  EXPECT_EQ(to_string(at(root, {"fur"}).entries()[1].key_position), "s:1:14");
}

TEST(Yaml, ANullIsReportedAtItsKey) {
  const Value root = parse_document("a:\n  # nothing here\n\nb: null\nc: [1,\n  , 2]\nd:\n  -\n  - 1\n", "s");
  EXPECT_EQ(to_string(at(root, {"a"}).position()), "s:1:1");
  EXPECT_EQ(to_string(at(root, {"b"}).position()), "s:4:1");
  EXPECT_EQ(to_string(at(root, {"d", "0"}).position()), "s:8:3");
}

TEST(Yaml, WhatIsRefusedIsReportedTogether) {
  EXPECT_EQ(problems("a: 1\n"
                     "b: &x 3\n"
                     "c: *x\n"
                     "d: !!str 5\n"
                     "<<: {e: 1}\n"
                     "a: 2\n"
                     "? [k]\n"
                     ": 5\n"
                     "f: !mine {g: 1, g: 2}\n"),
            (Lines{
                "s.yaml:2:4: anchors are not supported ('&x'); share values with 'include:'",
                "s.yaml:3:4: aliases are not supported; share values with 'include:'",
                "s.yaml:4:4: tags are not supported ('tag:yaml.org,2002:str')",
                "s.yaml:5:1: merge keys are not supported; share values with 'include:'",
                "s.yaml:6:1: duplicate key 'a', first on line 1",
                "s.yaml:7:3: expected a key, got a list of 1",
                "s.yaml:9:4: tags are not supported ('!mine')",
                "s.yaml:9:17: duplicate key 'g', first on line 9",
            }));
}

TEST(Yaml, SyntaxMistakes) {
  EXPECT_EQ(problems("a: 1\nb: 2: 3\n"),
            Lines{"s.yaml:2:5: malformed YAML: unexpected ':'; check the indentation and quotes"});
  EXPECT_EQ(problems("a: [1, 2\nb: 3\n"), Lines{"s.yaml:2:2: malformed YAML: expected ',' or ']'"});
  EXPECT_EQ(problems("a: {b: 1\n"), Lines{"s.yaml:2:1: malformed YAML: expected ',' or '}'"});
  EXPECT_EQ(problems("a:\n\tb: 1\n"),
            Lines{"s.yaml:2:3: malformed YAML: tab in the indentation; use spaces"});
  EXPECT_EQ(problems("a: ]\n"), Lines{"s.yaml:1:4: malformed YAML: closing bracket without an opening one"});
  EXPECT_EQ(
      problems("a: @b\n"),
      Lines{"s.yaml:1:4: malformed YAML: a value cannot begin with this character; put the text in quotes"});
  EXPECT_EQ(problems("a: *nothing\n"),
            Lines{"s.yaml:1:4: aliases are not supported; share values with 'include:'"});
  EXPECT_EQ(problems("- a\n- b\n"),
            Lines{"s.yaml:1:1: expected a scene, which is a block of keys, got a list of 2"});
  EXPECT_EQ(problems("a: 1\n---\nb: 2\n"), Lines{"s.yaml:2:1: text after the end of the document"});
  EXPECT_EQ(problems("a: \xff\n"), Lines{"s.yaml:1:4: the text is not UTF-8"});
  EXPECT_EQ(problems("a: \xed\xa0\x80\n"), Lines{"s.yaml:1:4: the text is not UTF-8"});
  EXPECT_EQ(problems(std::string("a: 1\nb: \0\n", 10)),
            Lines{"s.yaml:2:4: a scene must not contain control characters"});
}

// yaml-cpp accepts the end of the file as a closing quote.
TEST(Yaml, QuotesMustEnd) {
  EXPECT_EQ(problems("a: \"b\nc: 3\n"), Lines{"s.yaml:1:4: unterminated quoted text"});
  EXPECT_EQ(problems("a: 'b'' c\n"), Lines{"s.yaml:1:4: unterminated quoted text"});
  EXPECT_EQ(problems("a: \"b\\\" c\n"), Lines{"s.yaml:1:4: unterminated quoted text"});
  EXPECT_EQ(parsed("a: \"b\\\" c\"\n"), "{a: \"b\" c\"}");
  EXPECT_EQ(parsed("a: 'b'' c'\n"), "{a: \"b' c\"}");
}

TEST(Yaml, DepthIsLimited) {
  const auto nested = [](int depth) {
    return "a: " + std::string(static_cast<size_t>(depth), '[') +
           std::string(static_cast<size_t>(depth), ']') + "\n";
  };
  EXPECT_EQ(problems(nested(63)), Lines{});
  EXPECT_EQ(problems(nested(64)), Lines{"s.yaml:1:67: values are nested more than 64 deep"});
  EXPECT_EQ(problems(nested(1000)), Lines{"s.yaml:1:260: too many open brackets"});
}

}  // namespace
}  // namespace pelage
