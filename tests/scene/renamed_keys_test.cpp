// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <gtest/gtest.h>

#include "base/temporary_folder.h"
#include "base/value_readers.h"
#include "scene/document.h"
#include "tests/scene/document_text.h"

namespace pelage {
namespace {

struct Detail {
  float fraction = 1;
  static const Schema<Detail>& schema() {
    static const Schema<Detail> table = [] {
      Schema<Detail> s("detail", "How much is kept.");
      s.key("fraction", &Detail::fraction, {.help = "Fraction kept", .old_names = {"share", "part"}});
      return s;
    }();
    return table;
  }
};

struct Coat {
  std::optional<Detail> detail;
  std::vector<Detail> levels;
  static const Schema<Coat>& schema() {
    static const Schema<Coat> table = [] {
      Schema<Coat> s("coat", "Hair.");
      s.key("detail", &Coat::detail, {.old_names = {"lod"}});
      s.key("levels", &Coat::levels, {});
      return s;
    }();
    return table;
  }
};

struct Root {
  Named<Coat> coats;
  static const Schema<Root>& schema() {
    static const Schema<Root> table = [] {
      Schema<Root> s("root", "All.");
      s.key("coats", &Root::coats, {});
      return s;
    }();
    return table;
  }
};

class RenamedKeysTest : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  void load(const std::string& text, const std::vector<Override>& overrides = {}) {
    write_text(path("s.yaml"), text);
    RenamedKeys renamed{Root::schema()};
    Problems problems;
    const std::optional<Value> document = load_document(path("s.yaml"), overrides, problems, &renamed);
    document_ = document ? flat(*document) : "";
    warnings_ = lines(renamed.warnings);
    problems_ = lines(problems.list());
  }

  Lines lines(const std::vector<Problem>& problems) const {
    Lines result;
    for (const Problem& problem : problems) {
      std::string where = to_string(problem.position);
      if (where.starts_with(folder_.path().string()))
        where = where.substr(folder_.path().string().size() + 1);
      result.push_back(where + ": " + problem.message);
    }
    return result;
  }

  TemporaryFolder folder_;
  std::string document_;
  Lines warnings_, problems_;
};

TEST_F(RenamedKeysTest, OldNamesKeepWorking) {
  load("coats:\n  fox:\n    lod: {share: 0.5}\n    levels: [{part: 0.1}, {fraction: 0.2}]\n");
  EXPECT_EQ(document_,
            "{coats: {fox: {detail: {fraction: 0.5}, levels: [{fraction: 0.1}, {fraction: 0.2}]}}}");
  EXPECT_EQ(problems_, Lines{});
  EXPECT_EQ(warnings_, (Lines{"s.yaml:3:5: 'lod' is now called 'detail'",
                              "s.yaml:3:11: 'share' is now called 'fraction'",
                              "s.yaml:4:15: 'part' is now called 'fraction'"}));
}

TEST_F(RenamedKeysTest, NewNamesGiveNoWarning) {
  load("coats: {fox: {detail: {fraction: 0.5}}}\n");
  EXPECT_EQ(warnings_, Lines{});
  EXPECT_EQ(problems_, Lines{});
}

TEST_F(RenamedKeysTest, NamesOfTheUserAreNoKeys) {
  load("coats: {share: {detail: {fraction: 0.5}}, lod: {}}\n");
  EXPECT_EQ(document_, "{coats: {share: {detail: {fraction: 0.5}}, lod: {}}}");
  EXPECT_EQ(warnings_, Lines{});
}

TEST_F(RenamedKeysTest, BothNamesInOneFileAreAnError) {
  load("coats:\n  fox:\n    detail:\n      share: 0.5\n      fraction: 0.4\n");
  EXPECT_EQ(problems_, Lines{"s.yaml:4:7: 'share' is the old name of 'fraction'; give only one of them"});
  load("coats:\n  fox:\n    detail:\n      share: 0.5\n      part: 0.4\n");
  EXPECT_EQ(problems_, Lines{"s.yaml:5:7: 'part' is the old name of 'fraction'; give only one of them"});
}

TEST_F(RenamedKeysTest, TheIncludingFileWinsUnderEitherName) {
  write_text(path("old.yaml"), "coats: {fox: {detail: {share: 0.5}}}\n");
  write_text(path("new.yaml"), "coats: {fox: {detail: {fraction: 0.5}}}\n");
  load("include: old.yaml\ncoats: {fox: {detail: {fraction: 0.25}}}\n");
  EXPECT_EQ(document_, "{coats: {fox: {detail: {fraction: 0.25}}}}");
  load("include: new.yaml\ncoats: {fox: {lod: {share: 0.25}}}\n");
  EXPECT_EQ(document_, "{coats: {fox: {detail: {fraction: 0.25}}}}");
  EXPECT_EQ(problems_, Lines{});
}

TEST_F(RenamedKeysTest, AFileThatIsIncludedTwiceIsWarnedAboutOnce) {
  write_text(path("old.yaml"), "coats: {fox: {detail: {share: 0.5}}}\n");
  load("include: [old.yaml, old.yaml]\n");
  EXPECT_EQ(warnings_, Lines{"old.yaml:1:24: 'share' is now called 'fraction'"});
}

TEST_F(RenamedKeysTest, OverridesWinUnderEitherName) {
  for (const char* in_file : {"share", "fraction"}) {
    for (const char* in_override : {"share", "part", "fraction"}) {
      load("coats: {fox: {detail: {" + std::string(in_file) + ": 0.5}}}\n",
           {{"coats.fox.detail." + std::string(in_override), "0.25"}});
      EXPECT_EQ(document_, "{coats: {fox: {detail: {fraction: 0.25}}}}") << in_file << " " << in_override;
      EXPECT_EQ(problems_, Lines{});
    }
  }
  load("coats: {fox: {detail: {fraction: 0.5}}}\n", {{"coats.fox.detail.share", "0.25"}});
  EXPECT_EQ(warnings_, Lines{"--set coats.fox.detail.share: 'share' is now called 'fraction'"});
}

TEST_F(RenamedKeysTest, OverridesReplaceBlocksUnderEitherName) {
  for (const char* name : {"lod", "detail"}) {
    const std::string key = "coats.fox." + std::string(name);
    load("coats: {fox: {detail: {fraction: 0.5, other: 1}}}\n", {{key, "{share: 0.25}"}});
    EXPECT_EQ(document_, "{coats: {fox: {detail: {fraction: 0.25}}}}");
    load("coats: {fox: {detail: {fraction: 0.5, other: 1}}}\n", {{key + ".share", "0.25"}});
    EXPECT_EQ(document_, "{coats: {fox: {detail: {fraction: 0.25, other: 1}}}}");
    load("coats: {fox: {}}\n", {{key + ".share", "0.5"}, {key + ".share", "0.25"}});
    EXPECT_EQ(document_, "{coats: {fox: {detail: {fraction: 0.25}}}}");
    EXPECT_EQ(problems_, Lines{});
    EXPECT_NE(std::find(warnings_.begin(), warnings_.end(),
                        "--set " + key + ".share: 'share' is now called 'fraction'"),
              warnings_.end());
  }
  load("coats: {fox: {levels: [{fraction: 0.1}]}}\n",
       {{"coats.fox.levels.0.part", "0.2"}, {"coats.wolf.lod.part", "0.3"}});
  EXPECT_EQ(document_, "{coats: {fox: {levels: [{fraction: 0.2}]}, wolf: {detail: {fraction: 0.3}}}}");
  EXPECT_EQ(problems_, Lines{});
}

TEST_F(RenamedKeysTest, BothNamesInOneOverrideAreAnError) {
  load("coats: {fox: {}}\n", {{"coats.fox.lod", "{share: 0.5, fraction: 0.4}"}});
  EXPECT_EQ(problems_,
            Lines{"--set coats.fox.lod: 'share' is the old name of 'fraction'; give only one of them"});
}

TEST_F(RenamedKeysTest, MalformedBlocksAreLeftToTheirReaders) {
  load("coats: {fox: [1], wolf: {lod: 5, levels: {share: 1}}, bear: }\n");
  EXPECT_EQ(document_, "{coats: {fox: [1], wolf: {detail: 5, levels: {share: 1}}, bear: null}}");
  load("coats: 5\n");
  EXPECT_EQ(document_, "{coats: 5}");
}

TEST_F(RenamedKeysTest, AReaderWithoutTheLoaderNamesTheNewKey) {
  Detail detail;
  Problems problems;
  EXPECT_FALSE(Detail::schema().read(parse_document("share: 1\n", "t"), detail, problems));
  EXPECT_EQ(lines(problems.list()), Lines{"t:1:1: 'share' is now called 'fraction'"});
}

}  // namespace
}  // namespace pelage
