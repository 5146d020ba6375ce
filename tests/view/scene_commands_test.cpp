// SPDX-License-Identifier: Apache-2.0
#include "view/scene_commands.h"

#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "tests/world/small_scene.h"
#include "view/scene_edit.h"

namespace pelage {
namespace {

class SceneCommandsTest : public testing::Test {
 protected:
  std::string path() const { return scene_.path("scene.yaml"); }
  /// Runs a command while the picture shows the scene file as it is.
  CommandAnswer run(const char* name, const std::string& body, const std::vector<Override>& overrides = {}) {
    show(overrides);
    return SceneCommands(path(), overrides, state_).run(name, body);
  }
  void show(const std::vector<Override>& overrides = {}) {
    state_.update([&](ViewStatus& status) {
      status.edit = std::make_shared<const SceneEdit>(SceneEdit{load_scene(path(), overrides), {}});
    });
  }
  /// Expects that a command is refused with a message of one line, and changes nothing.
  void expect_refused(const char* name, const std::string& body, const std::string& why, int status = 400) {
    const std::string before = read_file(path());
    const auto camera = state_.control().camera();
    const CommandAnswer answer = run(name, body);
    EXPECT_EQ(answer.status, status) << body;
    const std::string error = nlohmann::json::parse(answer.json)["error"];
    EXPECT_NE(error.find(why), std::string::npos) << body << ": " << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    EXPECT_EQ(read_file(path()), before);
    EXPECT_EQ(state_.control().camera(), camera);
  }

  SmallScene scene_;
  ViewState state_;
};

TEST_F(SceneCommandsTest, LightsOfAMixAreTextAndCanBeWritten) {
  const std::string before = read_file(path());
  const std::string lights =
      R"("edit": 0, "lights": {"key": {"stops": -1}, "sky": {"stops": 1, "tint": [1, 0.5, 0]}}})";
  const CommandAnswer text = run("lights.json", R"({"action": "text", )" + lights);
  EXPECT_EQ(text.status, 200) << text.json;
  EXPECT_EQ(nlohmann::json::parse(text.json)["text"],
            "lights:\n  key:\n    intensity: 15\n  sky:\n    intensity: 2\n    radiance: [0.3, 0.15, 0]\n");
  EXPECT_EQ(read_file(path()), before);

  EXPECT_EQ(run("lights.json", R"({"action": "write", )" + lights).status, 200);
  std::string wanted = before;
  wanted.replace(wanted.find("intensity: 30"), 13, "intensity: 15");
  wanted.replace(wanted.find("radiance: 0.3"), 13, "radiance: [0.3, 0.15, 0], intensity: 2");
  EXPECT_EQ(read_file(path()), wanted);

  const CommandAnswer set =
      run("lights.json", R"({"action": "write", )" + lights, {{"lights.key.intensity", "9"}});
  EXPECT_EQ(set.status, 409);
  EXPECT_NE(set.json.find("--set lights.key.intensity=9"), std::string::npos) << set.json;
  EXPECT_EQ(read_file(path()), wanted);
}

TEST_F(SceneCommandsTest, AFrameOfTheSceneIsChosen) {
  state_.update([](ViewStatus& status) { status.frames = {1, 2, 3, 9}; });
  EXPECT_EQ(run("frame.json", R"({"frame": 9})").status, 200);
  EXPECT_EQ(state_.control().frame(), 9);
  for (const char* frame : {"4", "\"2\"", "[2]", "2.5", "1e99", "{}"})
    expect_refused("frame.json", R"({"frame": )" + std::string(frame) + "}",
                   "one of the scene's frames: 1-3,9");
  expect_refused("frame.json", R"({"farme": 2})", "did you mean 'frame'?");
  EXPECT_EQ(state_.control().frame(), 9);
  EXPECT_EQ(run("frame.json", R"({"frame": null})").status, 200);
  EXPECT_EQ(state_.control().frame(), std::nullopt);
}

TEST_F(SceneCommandsTest, NothingIsWrittenForClientsElsewhere) {
  const std::string before = read_file(path());
  const SceneCommands commands(path(), {}, state_, false);
  show();
  const std::string lights = R"("edit": 0, "lights": {"key": {"stops": -1}}})";
  EXPECT_EQ(commands.run("lights.json", R"({"action": "text", )" + lights).status, 200);
  EXPECT_EQ(commands.run("lights.json", R"({"action": "write", )" + lights).status, 400);
  EXPECT_EQ(read_file(path()), before);
}

TEST_F(SceneCommandsTest, LightsAreWrittenOnceForAPicture) {
  const std::string write = R"({"action": "write", "edit": 0, "lights": {"key": {"stops": 1}}})";
  EXPECT_EQ(run("lights.json", write).status, 200);
  const std::string once = read_file(path());
  EXPECT_NE(once.find("intensity: 60"), std::string::npos);
  // The picture still shows the lights as they were.
  const CommandAnswer again = SceneCommands(path(), {}, state_).run("lights.json", write);
  EXPECT_EQ(again.status, 400);
  EXPECT_NE(again.json.find("the scene has changed"), std::string::npos) << again.json;
  EXPECT_EQ(read_file(path()), once);
}

TEST_F(SceneCommandsTest, ALightThatIsTooBrightIsRefused) {
  scene_.write(
      "scene.yaml",
      std::string(read_file(path())).replace(read_file(path()).find("intensity: 30"), 13, "intensity: 3e38"));
  expect_refused("lights.json", R"({"action": "write", "edit": 0, "lights": {"key": {"stops": 1}}})",
                 "too bright");
}

TEST_F(SceneCommandsTest, AnAnimatedIntensityKeepsItsKeys) {
  std::string text = read_file(path());
  text.replace(text.find("intensity: 30"), 13, "intensity: {keys: {1: 30, 5: 60}}");
  scene_.write("scene.yaml", text);
  const CommandAnswer answer =
      run("lights.json",
          R"({"action": "text", "edit": 0, "lights": {"key": {"stops": 2, "tint": [1, 1, 0.5]}}})");
  EXPECT_EQ(nlohmann::json::parse(answer.json)["text"], "lights:\n  key:\n    radiance: [4, 4, 2]\n");
}

TEST_F(SceneCommandsTest, ACameraIsMovedWrittenAndReset) {
  EXPECT_EQ(run("camera.json", R"({"action": "move", "position": [0, 1, 9.5], "look_at": [0, 1, 0]})").status,
            200);
  EXPECT_EQ(state_.control().camera(), (CameraMove{V3f(0, 1, 9.5f), V3f(0, 1, 0)}));
  const CommandAnswer text = run("camera.json", R"({"action": "text"})");
  EXPECT_EQ(nlohmann::json::parse(text.json)["text"],
            "camera:\n  position: [0, 1, 9.5]\n  look_at: [0, 1, 0]\n");
  std::string wanted = read_file(path());
  wanted.replace(wanted.find("[3, 2, 8], look_at: [1, 0, 0]"), 29, "[0, 1, 9.5], look_at: [0, 1, 0]");
  EXPECT_EQ(run("camera.json", R"({"action": "write"})").status, 200);
  EXPECT_EQ(read_file(path()), wanted);
  EXPECT_FALSE(state_.control().camera());
  expect_refused("camera.json", R"({"action": "write"})", "nothing to write");

  run("camera.json", R"({"action": "move", "position": [0, 1, 9.5], "look_at": [0, 1, 0]})");
  EXPECT_EQ(run("camera.json", R"({"action": "reset"})").status, 200);
  EXPECT_FALSE(state_.control().camera());
}

TEST_F(SceneCommandsTest, ARegionIsSetAndCleared) {
  EXPECT_EQ(run("region.json", R"({"region": [1, 2, 30, 40]})").status, 200);
  EXPECT_EQ(state_.control().region()->y1, 40);
  EXPECT_EQ(run("region.json", R"({"region": null})").status, 200);
  EXPECT_FALSE(state_.control().region());
}

TEST_F(SceneCommandsTest, WrongParametersAreRefused) {
  for (const char* name : {"camera.json", "lights.json", "region.json"}) {
    for (const char* body : {"", "{", "nul", "\xff\xfe", "{\"a\":1e999}"})
      expect_refused(name, body, "not JSON");
    for (const char* body : {"null", "[]", "1", "\"x\""}) expect_refused(name, body, "expected an object");
    expect_refused(name, std::string(5000, '[') + std::string(5000, ']'), "expected an object");
  }
  expect_refused("none.json", "{}", "no such command", 404);
  expect_refused("camera.json", R"({"acton": "move"})", "did you mean 'action'?");
  expect_refused("camera.json", R"({"action": "moove"})", "did you mean 'move'?");
  expect_refused("camera.json", R"({"action": 3})", "expected one of");
  expect_refused("camera.json", R"({"action": "move", "position": [0, 1, 2]})",
                 "look_at: expected 3 numbers");
  for (const char* point : {"[1, 2]", "[1, 2, 3, 4]", "[1, 2, null]", "[1, 2, \"3\"]", "[1, 2, 1e300]", "{}",
                            "7", "[[1], 2, 3]", "[true, 2, 3]"})
    expect_refused("camera.json",
                   std::string(R"({"action": "move", "look_at": [0, 0, 0], "position": )") + point + "}",
                   "position: expected 3 numbers");
  for (const char* point : {"[0, 0, 0]", "[0, 5, 0]", "[0, -1e-7, 0]"})
    expect_refused("camera.json",
                   std::string(R"({"action": "move", "look_at": [0, 0, 0], "position": )") + point + "}",
                   "up vector");
  expect_refused("lights.json", R"({"action": "text", "edit": 0})", "lights: expected an object");
  expect_refused("lights.json", R"({"action": "text", "edit": 0, "lights": {}})", "nothing is changed");
  expect_refused("lights.json", R"({"action": "text", "edit": 7, "lights": {}})", "has changed");
  expect_refused("lights.json", R"({"action": "text", "edit": 0, "lights": {"kee": {"stops": 1}}})",
                 "did you mean 'key'?");
  expect_refused("lights.json", R"({"action": "text", "edit": 0, "lights": {"key": {"stop": 1}}})",
                 "did you mean 'stops'?");
  expect_refused("lights.json", R"({"action": "text", "edit": 0, "lights": {"key": {"stops": 1e9}}})",
                 "stops: expected");
  expect_refused("lights.json", R"({"action": "text", "edit": 0, "lights": {"key": {"tint": [1, -1, 1]}}})",
                 "tint: expected");
  for (const char* box :
       {"[0, 0, 1]", "[0, 0, 1e9, 1]", "[4, 0, 4, 5]", "[0, 5, 4, 4]", "[-1, 0, 4, 4]", "true"})
    expect_refused("region.json", std::string(R"({"region": )") + box + "}", "region: expected");
}

}  // namespace
}  // namespace pelage
