// SPDX-License-Identifier: Apache-2.0
#include "view/scene_edit.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/world/small_scene.h"

namespace pelage {
namespace {

TEST(SceneEdit, GuidesOfTheShownFrameNeedNewGeometry) {
  const SmallScene files;
  const auto read = [&](int frame) {
    SceneEdit edit{load_scene(files.path("scene.yaml"),
                              {{"grooms.coat.dynamics", "{files: " + files.path("g.%d.hair") + "}"},
                               {"frames", std::to_string(frame)}}),
                   {}};
    edit.files = stamps_of(followed_files(edit.scene));
    return edit;
  };
  const SceneEdit second = read(2), fifth = read(5);
  EXPECT_TRUE(second.files.contains(files.path("g.1.hair")));
  EXPECT_TRUE(second.files.contains(files.path("g.3.hair")));
  EXPECT_FALSE(second.files.contains(files.path("g.4.hair")));
  EXPECT_EQ(read(2).redo_after(second), Redo::kNothing);
  files.write("g.3.hair", "a neighbour of the frame appears");
  EXPECT_EQ(read(2).redo_after(second), Redo::kGeometry);
  EXPECT_EQ(read(5).redo_after(fifth), Redo::kNothing);
}

}  // namespace
}  // namespace pelage
