// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "base/temporary_folder.h"
#include "scene/document.h"
#include "tests/scene/document_text.h"

namespace pelage {
namespace {

class Include : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  void write(const std::string& name, const std::string& text) { write_text(path(name), text); }
  std::string loaded(const std::string& name) const { return flat(load_document(path(name))); }
  // With the folder's name cut out.
  Lines problems(const std::string& name) const {
    Lines lines = error_lines([&] { load_document(path(name)); });
    const std::string folder = folder_.path().string() + "/";
    for (std::string& line : lines) {
      for (size_t at = line.find(folder); at != std::string::npos; at = line.find(folder))
        line.erase(at, folder.size());
    }
    return lines;
  }

  TemporaryFolder folder_;
};

TEST_F(Include, TheIncludingFileWins) {
  write("base.yaml", "a: 1\nb: {c: 2, d: [1, 2]}\n");
  write("scene.yaml", "include: base.yaml\nb: {d: [3], e: 4}\nf: 5\n");
  EXPECT_EQ(loaded("scene.yaml"), "{a: 1, b: {c: 2, d: [3], e: 4}, f: 5}");
}

TEST_F(Include, OfSeveralFilesTheLaterWins) {
  write("one.yaml", "a: 1\nb: 1\n");
  write("two.yaml", "b: 2\nc: 2\n");
  write("scene.yaml", "c: 3\ninclude: [one.yaml, two.yaml]\n");
  EXPECT_EQ(loaded("scene.yaml"), "{a: 1, b: 2, c: 3}");
}

TEST_F(Include, PathsAreRelativeToTheFileThatNamesThem) {
  std::filesystem::create_directories(folder_.path() / "sub");
  write("scene.yaml", "include: sub/base.yaml\n");
  write("sub/base.yaml", "include: deep.yaml\na: 1\n");
  write("sub/deep.yaml", "b: 2\n");
  const Value document = load_document(path("scene.yaml"));
  EXPECT_EQ(flat(document), "{b: 2, a: 1}");
  EXPECT_EQ(to_string(document.find("b")->position()), path("sub/deep.yaml") + ":1:4");
}

TEST_F(Include, AFileMayBeIncludedTwiceButNotByItself) {
  write("leaf.yaml", "a: 1\n");
  write("left.yaml", "include: leaf.yaml\n");
  write("right.yaml", "include: leaf.yaml\n");
  write("scene.yaml", "include: [left.yaml, right.yaml]\n");
  EXPECT_EQ(loaded("scene.yaml"), "{a: 1}");
  write("left.yaml", "include: ./scene.yaml\n");
  EXPECT_EQ(problems("scene.yaml"), Lines{"left.yaml:1:10: the file includes itself: scene.yaml"});
}

TEST_F(Include, MistakesOfAllFilesAreReportedTogether) {
  write("one.yaml", "a: 1\na: 2\n");
  write("two.yaml", "b: &x 1\n");
  write("scene.yaml", "include:\n  - one.yaml\n  - nowhere.yaml\n  - [two.yaml]\n  - two.yaml\nc: 1\nc: 2\n");
  EXPECT_EQ(problems("scene.yaml"),
            (Lines{
                "scene.yaml:7:1: duplicate key 'c', first on line 6",
                "one.yaml:2:1: duplicate key 'a', first on line 1",
                "scene.yaml:3:5: nowhere.yaml: cannot read: No such file or directory",
                "scene.yaml:4:5: expected the name of a file to include, got a list of 1",
                "two.yaml:1:4: anchors are not supported ('&x'); share values with 'include:'",
            }));
}

TEST_F(Include, TheNumberOfFilesIsLimited) {
  write("leaf.yaml", "a: 1\n");
  std::string text = "include:\n";
  for (int i = 0; i < 200; ++i) text += "  - leaf.yaml\n";
  write("scene.yaml", text);
  EXPECT_EQ(problems("scene.yaml"), Lines{"scene.yaml:65:5: more than 64 files are included"});
}

TEST_F(Include, BreadthTimesDepthIsLimited) {
  // 40 levels that include the next one twice would be 2^40 files.
  for (int i = 0; i < 40; ++i) {
    const std::string next = "f" + std::to_string(i + 1) + ".yaml";
    write("f" + std::to_string(i) + ".yaml", "include: [" + next + ", " + next + "]\n");
  }
  write("f40.yaml", "a: 1\n");
  ASSERT_EQ(problems("f0.yaml").size(), 1u);
  EXPECT_NE(problems("f0.yaml")[0].find("more than 64 files are included"), std::string::npos);
}

TEST_F(Include, AMissingSceneIsNamed) {
  EXPECT_EQ(problems("none.yaml"), Lines{"none.yaml: cannot read: No such file or directory"});
  EXPECT_EQ(problems("."), Lines{".: cannot read: it is a folder"});
}

TEST_F(Include, ALargeFileIsRefused) {
  write("large.yaml", "a: 1\n#" + std::string(size_t(3) << 20, 'x'));
  ASSERT_EQ(problems("large.yaml").size(), 1u);
  EXPECT_NE(problems("large.yaml")[0].find("the limit is 2097152 bytes"), std::string::npos);
}

TEST_F(Include, DocumentsWithHolesAreNotHandedOn) {
  write("broken.yaml", "a: [1\n");
  write("scene.yaml", "include: broken.yaml\nb: 1\n");
  Problems found;
  EXPECT_FALSE(load_document(path("scene.yaml"), {}, found));
  EXPECT_EQ(found.list().size(), 1u);
  write("doubled.yaml", "a: 1\na: 2\n");
  Problems more;
  const std::optional<Value> document = load_document(path("doubled.yaml"), {}, more);
  ASSERT_TRUE(document);
  EXPECT_EQ(flat(*document), "{a: 1}");
  EXPECT_EQ(more.list().size(), 1u);
}

}  // namespace
}  // namespace pelage
