// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "base/file.h"
#include "tests/world/small_scene.h"
#include "view/live_renderer.h"
#include "view/scene_commands.h"
#include "view/scene_follower.h"

namespace pelage {
namespace {

using Numbers = std::vector<double>;

/// A view whose commands write the file that it follows.
class WrittenLightsTest : public testing::Test {
 protected:
  std::string path() const { return scene_.path("scene.yaml"); }
  void run(const char* name, const std::string& body) {
    const CommandAnswer answer = SceneCommands(path(), {}, state_).run(name, body);
    EXPECT_EQ(answer.status, 200) << body << answer.json;
  }
  void change(const std::string& values) {
    run("rig.json", R"({"action": "change", "light": "key", "values": )" + values + "}");
  }
  /// Waits until the light `key` is at a place.
  bool shows(const Numbers& position) const {
    for (int i = 0; i < 2000; ++i) {
      const ViewStatus status = state_.status();
      for (const ViewLight& shown : status.lights) {
        const auto found = shown.values.find("position");
        if (status.done() && shown.item.name == "key" && found != shown.values.end() &&
            found->second == position)
          return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  /// Waits until the view has the intensity that the light `key` has in the scene file.
  bool is_read() const {
    const float wanted = intensity(load_scene(path(), {}));
    for (int i = 0; i < 2000; ++i) {
      const ViewStatus status = state_.status();
      if (status.done() && status.edit && intensity(status.edit->scene) == wanted) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  static float intensity(const SceneDescription& scene) {
    for (const auto& light : scene.lights.items) {
      if (light.name == "key")
        return std::visit([](const auto& params) { return params.intensity.at(1); }, light.value);
    }
    return -1;
  }

  SmallScene scene_{true};
  ViewState state_;
};

TEST_F(WrittenLightsTest, AMixKeepsTheMoveOfALight) {
  LiveRenderer renderer(state_, 2);
  const SceneFollower follower(path(), {}, renderer, state_);
  ASSERT_TRUE(shows({5, 8, 5}));
  change(R"({"position": [1, 8, 5]})");
  ASSERT_TRUE(shows({1, 8, 5}));
  run("lights.json", R"({"action": "write", "edit": )" + std::to_string(state_.status().edits) +
                         R"(, "lights": {"key": {"stops": 1}}})");
  ASSERT_NE(read_file(path()).find("intensity: 60"), std::string::npos);
  ASSERT_TRUE(is_read());
  ASSERT_TRUE(state_.control().lights().contains("key"));
  EXPECT_EQ(state_.control().lights().at("key").values.at("position"), Numbers({1, 8, 5}));
  EXPECT_TRUE(shows({1, 8, 5}));

  // A change by an editor ends it.
  const std::string text = read_file(path());
  scene_.write("scene.yaml", std::string(text).replace(text.find("intensity: 60"), 13, "intensity: 50"));
  ASSERT_TRUE(is_read());
  EXPECT_TRUE(state_.control().lights().empty());
}

TEST_F(WrittenLightsTest, AMoveRightAfterTheLightWasWrittenIsKept) {
  LiveRenderer renderer(state_, 2);
  const SceneFollower follower(path(), {}, renderer, state_);
  ASSERT_TRUE(shows({5, 8, 5}));
  change(R"({"position": [1, 8, 5]})");
  ASSERT_TRUE(shows({1, 8, 5}));
  run("rig.json", R"({"action": "write"})");
  change(R"({"position": [2, 8, 5]})");
  EXPECT_TRUE(shows({2, 8, 5}));
  EXPECT_NE(read_file(path()).find("position: [1, 8, 5]"), std::string::npos);
  EXPECT_TRUE(state_.control().lights().contains("key"));
}

TEST_F(WrittenLightsTest, ANewerChangeOfAnAddedLightStays) {
  const LightChanges added{{"lamp", {"sphere", false, {{"radius", {1}}}}}};
  ViewControl& control = state_.control();
  control.change_lights([&](LightChanges& changes) {
    changes = added;
    changes["lamp"].values["radius"] = {2};
  });
  control.end_lights(added);
  EXPECT_EQ(control.lights(), (LightChanges{{"lamp", {"", false, {{"radius", {2}}}}}}));
  control.end_lights(control.lights());
  EXPECT_TRUE(control.lights().empty());
}

}  // namespace
}  // namespace pelage
