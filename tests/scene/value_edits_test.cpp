// SPDX-License-Identifier: Apache-2.0
#include "scene/value_edits.h"

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <tuple>

#include <gtest/gtest.h>

#include "base/file.h"
#include "base/temporary_folder.h"

namespace pelage {
namespace {

const ValueEdit kIntensity{{"lights", "key", "intensity"}, {2.5}};
const ValueEdit kRadiance{{"lights", "key", "radiance"}, {1, 0.5, 0.25}};

std::string edited(const std::string& text, const std::vector<ValueEdit>& edits) {
  return with_values(text, "a.yaml", edits);
}

std::string error_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

struct Case {
  const char *before, *after;
};

TEST(ValueEdits, OnlyTheBytesOfTheValuesChange) {
  const Case cases[] = {
      {"lights: {key: {intensity: 3, radiance: [9, 9, 9]}}  # all\n",
       "lights: {key: {intensity: 2.5, radiance: [1, 0.5, 0.25]}}  # all\n"},
      {"# bright\nlights:\n  key:   # the sun\n    type: sphere\n    intensity:   3e1   # strong\n    "
       "radiance: 0.3\n",
       "# bright\nlights:\n  key:   # the sun\n    type: sphere\n    intensity:   2.5   # strong\n    "
       "radiance: [1, 0.5, 0.25]\n"},
      {"lights:\n  key:\n    intensity: 3\n    radiance:\n      - 7  # red\n      - 8\n      - 9\nz: 1\n",
       "lights:\n  key:\n    intensity: 2.5\n    radiance:\n      - 1  # red\n      - 0.5\n      - 0.25\nz: "
       "1\n"},
      {"\xef\xbb\xbflights: {\"k\\u00e4\": \"\xc3\xa4\", key: {\"intensity\": 3, radiance: [9,\n  9, # g\n  "
       "9]}}",
       "\xef\xbb\xbflights: {\"k\\u00e4\": \"\xc3\xa4\", key: {\"intensity\": 2.5, radiance: [1,\n  0.5, # "
       "g\n  0.25]}}"},
      {"a: \xc3\xa4\xc3\xb6\r\nlights:\r\n  key:\r\n    intensity: 3\r\n    radiance: 1\r\n",
       "a: \xc3\xa4\xc3\xb6\r\nlights:\r\n  key:\r\n    intensity: 2.5\r\n    radiance: [1, 0.5, 0.25]\r\n"},
  };
  for (const Case& one : cases) EXPECT_EQ(edited(one.before, {kIntensity, kRadiance}), one.after);
  for (const Case& one : cases) EXPECT_EQ(edited(one.before, {kRadiance, kIntensity}), one.after);
}

TEST(ValueEdits, AMissingKeyIsAddedToItsBlock) {
  const Case cases[] = {
      {"lights: {key: {type: sphere, position: [1, 2, 3] } }",
       "lights: {key: {type: sphere, intensity: 2.5, position: [1, 2, 3] } }"},
      {"lights: {key: {position: [1, 2, 3],}}", "lights: {key: {intensity: 2.5, position: [1, 2, 3],}}"},
      {"lights:\n  key:\n    type: sphere  # a sun\n    # its place\n    position: [1, 2, 3]\n  b: {}\n",
       "lights:\n  key:\n    type: sphere  # a sun\n    intensity: 2.5\n    # its place\n    position: [1, "
       "2, 3]\n  b: {}\n"},
      {"lights:\r\n  key:\r\n    type: sphere\r\n",
       "lights:\r\n  key:\r\n    type: sphere\r\n    intensity: 2.5\r\n"},
      {"lights:\n  key:\n    type: sphere", "lights:\n  key:\n    type: sphere\n    intensity: 2.5"},
      {"lights:\n  key:\n    # its place\n    position: [1, 2, 3]\n",
       "lights:\n  key:\n    # its place\n    position: [1, 2, 3]\n    intensity: 2.5\n"},
  };
  for (const Case& one : cases) EXPECT_EQ(edited(one.before, {kIntensity}), one.after);
}

TEST(ValueEdits, WhatCannotBeChangedAloneIsRefused) {
  const char* texts[] = {"lights: {key: {intensity: {keys: {1: 2}}}}",
                         "lights: {key: {intensity: \"3\"}}",
                         "lights: {key: {intensity: [3]}}",
                         "lights: {key: {intensity: }}",
                         "lights: {key: {intensity: |\n 3\n}}",
                         "lights: {key: 3}",
                         "lights: {other: {intensity: 3}}",
                         "lights: {key: {}}",
                         "lights: {key: {intensity: 3\n  4}}",
                         "pelage: 1\n",
                         "[1]",
                         "",
                         "lights: {key: {intensity: 3}"};
  for (const char* text : texts) {
    const std::string error = error_of([&] { edited(text, {kIntensity}); });
    if (std::string(text) == "lights: {key: {intensity: [3]}}") {
      EXPECT_EQ(error, "");  // a list of one number
    } else {
      EXPECT_EQ(error.rfind("a.yaml", 0), 0u) << text << ": " << error;
      EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    }
  }
}

TEST(ValueEdits, BlocksAreAddedAndRemoved) {
  const ValueEdit add{{"lights", "lamp"}, {}, "{type: sphere, radius: 0.5}"};
  const auto removed = [](const std::string& name) { return ValueEdit{{"lights", name}, {}, {}, true}; };
  const std::string lines =
      "lights:  # two\n  # warm\n  key:\n    radius: 1  # m\n\n    power: 3\n  # cold\n  sky: {power: "
      "2}\nrender: {}\n";
  EXPECT_EQ(with_values(lines, "scene", {add}),
            "lights:  # two\n  # warm\n  key:\n    radius: 1  # m\n\n    power: 3\n  # cold\n"
            "  sky: {power: 2}\n  lamp: {type: sphere, radius: 0.5}\nrender: {}\n");
  EXPECT_EQ(with_values(lines, "scene", {removed("key")}),
            "lights:  # two\n  # warm\n  # cold\n  sky: {power: 2}\nrender: {}\n");
  EXPECT_EQ(with_values(lines, "scene", {removed("sky")}),
            "lights:  # two\n  # warm\n  key:\n    radius: 1  # m\n\n    power: 3\n  # cold\nrender: {}\n");
  const std::string braces = "lights: {key: {text: 'a, }', b: [1, 2]}, sky: {power: 2}, rim: {power: 3}}\n";
  EXPECT_EQ(with_values(braces, "scene", {add}),
            "lights: {lamp: {type: sphere, radius: 0.5}, " + braces.substr(9));
  EXPECT_EQ(with_values(braces, "scene", {removed("key")}), "lights: {sky: {power: 2}, rim: {power: 3}}\n");
  EXPECT_EQ(with_values(braces, "scene", {removed("rim")}),
            "lights: {key: {text: 'a, }', b: [1, 2]}, sky: {power: 2}}\n");
  EXPECT_EQ(with_values(braces, "scene", {removed("rim"), removed("key")}), "lights: {sky: {power: 2}}\n");
  EXPECT_EQ(values_text({add, removed("key")}),
            "lights:\n  lamp: {type: sphere, radius: 0.5}\n  # removed: key\n");
  // The last line may have no end.
  EXPECT_EQ(with_values("lights:\n  key: {a: 1}\n  sky: {a: 2}", "scene", {removed("sky")}),
            "lights:\n  key: {a: 1}\n");

  // Blocks of the document begin with their first block, and end with the last one.
  EXPECT_EQ(with_values("render: {}", "scene", {add}),
            "render: {}\nlights:\n  lamp: {type: sphere, radius: 0.5}\n");
  EXPECT_EQ(with_values("lights:\n  # warm\n  key: {a: 1}\nrender: {}\n", "scene", {removed("key")}),
            "render: {}\n");
  EXPECT_EQ(with_values("render: {}\r\n", "scene", {add, removed("lamp")}), "render: {}\r\n");

  for (const auto& [text, edit, why] : std::vector<std::tuple<std::string, ValueEdit, std::string>>{
           {lines, {{"lights", "key"}, {}, "{a: 1}"}, "exists already"},
           {lines, removed("kye"), "has no `lights.kye`"},
           {"lights: {key: {a: 1}}", removed("key"), "is the last one here"},
           {"{render: {}}", add, "has no block `lights`"}})
    EXPECT_NE(error_of([&] { with_values(text, "scene", {edit}); }).find(why), std::string::npos) << why;
}

TEST(ValueEdits, CommentsStayWithTheirBlocks) {
  const ValueEdit add{{"lights", "lamp"}, {}, "{a: 1}"};
  const Case cases[] = {
      {"lights:\n  # my fill\n  fill:\n    a: 2\n\n# all\nrender: {}\n",
       "lights:\n  # my fill\n  fill:\n    a: 2\n  lamp: {a: 1}\n\n# all\nrender: {}\n"},
      {"lights:\r\n  # my fill\r\n  fill: {a: 2}  # warm\r\n",
       "lights:\r\n  # my fill\r\n  fill: {a: 2}  # warm\r\n  lamp: {a: 1}\r\n"},
      {"lights:\n  # my fill\n  fill: {a: 2}", "lights:\n  # my fill\n  fill: {a: 2}\n  lamp: {a: 1}"},
      {"lights:\n  fill: {\n    a: 2\n  }\n", "lights:\n  fill: {\n    a: 2\n  }\n  lamp: {a: 1}\n"},
      {"lights: {\n  # my fill\n  fill: {a: 2},\n}\n",
       "lights: {lamp: {a: 1},\n  # my fill\n  fill: {a: 2},\n}\n"},
      {"lights: { fill: {a: 2} }\n", "lights: { lamp: {a: 1}, fill: {a: 2} }\n"}};
  for (const Case& one : cases) EXPECT_EQ(edited(one.before, {add}), one.after);
}

TEST(ValueEdits, BracketsMayCloseInTheColumnOfTheKey) {
  const ValueEdit remove{{"lights", "rim"}, {}, {}, true};
  for (const char* head : {"lights:\n  key: {a: 1}\n", "lights:\n  # one\n  key: {a: 1}\n"})
    for (const char* tail : {"", "  # cold\n  sky: {a: 1}\n"})
      EXPECT_EQ(edited(std::string(head) + "  rim: {\n    a: [\n      1\n    ]\n  }\n" + tail, {remove}),
                std::string(head) + tail);
  // A bracket in a comment is taken for one of the text; the message is about the file as it is.
  const std::string odd = "lights: {key: {a: 1},\n  rim: {a: 1 # }\n  }, sky: {a: 1}}\n";
  EXPECT_EQ(error_of([&] { edited(odd, {remove}); }),
            "a.yaml: cannot be changed without changing other values; edit the file by hand");
}

TEST(ValueEdits, TheTextToPasteNamesEachBlockOnce) {
  EXPECT_EQ(values_text({kIntensity, kRadiance, {{"lights", "a b's", "intensity"}, {1e-6}}}),
            "lights:\n  key:\n    intensity: 2.5\n    radiance: [1, 0.5, 0.25]\n"
            "  'a b''s':\n    intensity: 1e-06\n");
}

TEST(ValueEdits, AFileIsWrittenWholeOrNotAtAll) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.yaml";
  const std::string text = "include: more.yaml\nlights: {key: {intensity: 3}, sky: {intensity: 1}}\n";
  write_file(path, text);
  write_file(folder.path() / "more.yaml", "lights: {key: {radiance: [1, 1, 1]}, rim: {intensity: 2}}\n");
  EXPECT_NE(error_of([&] {
              write_values(path, {}, {kIntensity, kRadiance});
            }).find("more.yaml:1:26: `lights.key.radiance`"),
            std::string::npos);
  EXPECT_NE(error_of([&] {
              write_values(path, {}, {{{"lights", "rim", "intensity"}, {1}}});
            }).find("more.yaml:1"),
            std::string::npos);
  EXPECT_NE(error_of([&] {
              write_values(path, {}, {{{"lights", "rim", "radiance"}, {1}}});
            }).find("`lights.rim`"),
            std::string::npos);
  for (const char* key : {"lights", "lights.key", "lights.key.intensity", "lights.key.intensity.keys"})
    EXPECT_NE(error_of([&] {
                write_values(path, {{key, "1"}}, {kIntensity});
              }).find("--set"),
              std::string::npos);
  EXPECT_EQ(read_file(path), text);

  const std::filesystem::path link = folder.path() / "link.yaml";
  std::filesystem::create_symlink("a.yaml", link);
  write_values(link, {{"lights.sky.intensity", "9"}, {"lights.keys", "1"}}, {kIntensity});
  EXPECT_EQ(read_file(path), "include: more.yaml\nlights: {key: {intensity: 2.5}, sky: {intensity: 1}}\n");
  EXPECT_TRUE(std::filesystem::is_symlink(link));
}

TEST(ValueEdits, ASaveAtTheSameTimeIsNotLost) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.yaml", saved = folder.path() / "saved.yaml";
  const std::string text = "lights: {key: {intensity: 3}}\n";
  int refused = 0;
  for (int i = 0; i < 30; ++i) {
    write_file(path, text);
    std::atomic<bool> begins{false};
    std::thread editor([&] {
      write_file(saved, text + "# saved\n");
      begins = true;
      std::this_thread::sleep_for(std::chrono::microseconds(100 * i));
      std::filesystem::rename(saved, path);
    });
    while (!begins) std::this_thread::yield();
    const std::string error = error_of([&] { write_values(path, {}, {kIntensity}); });
    editor.join();
    EXPECT_NE(read_file(path).find("# saved"), std::string::npos) << i << error;
    if (error.empty()) continue;
    EXPECT_NE(error.find("changed at the same time"), std::string::npos) << error;
    ++refused;
  }
  RecordProperty("refused", refused);
}

}  // namespace
}  // namespace pelage
