// SPDX-License-Identifier: Apache-2.0
#include "scene/yaml_text.h"

#include <gtest/gtest.h>

#include "scene/document_hash.h"
#include "tests/world/furry_scene.h"

namespace pelage {
namespace {

TEST(YamlText, ReadsBackAsTheSameDocument) {
  const Value document = parse_document(R"(a: {b: [1, -2.5e-3, 'it''s', "x: y", ''], c: null, '1': "2"}
d: [[], {}, ["-", ".", true], "true", "a # b"]
)",
                                        "test");
  const Value again = parse_document(yaml_text(document), "again");
  EXPECT_EQ(document_hash(document), document_hash(again));
  EXPECT_EQ(yaml_text(again), yaml_text(document));
}

TEST(YamlText, PathsBecomeAbsolute) {
  const FurryScene scene;
  Value document = load_document(scene.scene(), {});
  make_paths_absolute(document, SceneDescription::schema());
  EXPECT_EQ(document.find("skins")->find("cube")->find("mesh")->text(), scene.path("cube.obj"));
  EXPECT_EQ(document.find("skins")->find("cube")->find("poses")->find("files")->text(),
            scene.path("cube.%04d.obj"));
  EXPECT_EQ(document.find("skins")->find("still")->find("scheme")->text(), "none");
}

}  // namespace
}  // namespace pelage
