// SPDX-License-Identifier: Apache-2.0
#include "view/scene_commands.h"

#include <algorithm>
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

TEST_F(SceneCommandsTest, LightsAreMovedAddedAndRemoved) {
  state_.update([](ViewStatus& status) {
    status.lights = {{"key", "sphere", {}, false}, {"sky", "environment", {}, false}};
  });
  const auto rig = [&](const std::string& body) { return run("rig.json", body); };
  EXPECT_EQ(rig(R"({"action": "change", "light": "key", "values": {"position": [1, 2, 3]}})").status, 200);
  EXPECT_EQ(rig(R"({"action": "change", "light": "key", "values": {"radius": [0.5]}})").status, 200);
  const CommandAnswer added =
      rig(R"({"action": "add", "type": "sphere", "values": {"position": [4, 5, 6]}})");
  EXPECT_EQ(nlohmann::json::parse(added.json)["light"], "sphere");
  EXPECT_EQ(state_.control().lights().size(), 2u);

  const std::string before = read_file(path());
  const std::string text = nlohmann::json::parse(rig(R"({"action": "text"})").json)["text"];
  EXPECT_EQ(text,
            "lights:\n  key:\n    position: [1, 2, 3]\n    radius: 0.5\n"
            "  sphere: {type: sphere, position: [4, 5, 6]}\n");
  EXPECT_EQ(read_file(path()), before);
  const CommandAnswer written = rig(R"({"action": "write"})");
  EXPECT_EQ(written.status, 200) << written.json;
  EXPECT_TRUE(state_.control().lights().empty());
  const SceneDescription scene = load_scene(path(), {});
  const auto light = [&](const std::string& name) -> const SphereLightParams& {
    const auto found = std::find_if(scene.lights.items.begin(), scene.lights.items.end(),
                                    [&](const auto& item) { return item.name == name; });
    return std::get<SphereLightParams>(found->value);
  };
  EXPECT_EQ(light("key").position.at(1), V3f(1, 2, 3));
  EXPECT_EQ(light("key").radius, 0.5f);
  EXPECT_EQ(light("sphere").position.at(1), V3f(4, 5, 6));

  EXPECT_EQ(rig(R"({"action": "remove", "light": "key"})").status, 200);
  EXPECT_EQ(rig(R"({"action": "write"})").status, 200);
  const SceneDescription rest = load_scene(path(), {});
  EXPECT_EQ(rest.lights.items.size(), 2u);
  EXPECT_TRUE(std::none_of(rest.lights.items.begin(), rest.lights.items.end(),
                           [](const auto& item) { return item.name == "key"; }));
  expect_refused("rig.json", R"({"action": "text"})", "nothing to write");
}

TEST_F(SceneCommandsTest, TheOnlyLightIsReplaced) {
  const std::string text = read_file(path());
  const size_t begin = text.find("lights:"), end = text.find("\nrender:");
  ASSERT_LT(begin, end);
  scene_.write("scene.yaml", std::string(text).replace(
                                 begin, end - begin, "lights:\n  key: {type: sphere, position: [3, 3, 5]}"));
  state_.update([](ViewStatus& status) { status.lights = {{"key", "sphere", {}, false}}; });
  EXPECT_EQ(run("rig.json", R"({"action": "remove", "light": "key"})").status, 200);
  EXPECT_EQ(run("rig.json", R"({"action": "add", "type": "sphere"})").status, 200);
  const CommandAnswer written = run("rig.json", R"({"action": "write"})");
  EXPECT_EQ(written.status, 200) << written.json;
  EXPECT_NE(read_file(path()).find("lights:\n  sphere: {type: sphere}\n"), std::string::npos);
  EXPECT_EQ(load_scene(path(), {}).lights.items.size(), 1u);
}

TEST_F(SceneCommandsTest, ManyBouncesArePreviewed) {
  EXPECT_EQ(run("preview.json", R"({"dual": true})").status, 200);
  EXPECT_TRUE(state_.control().dual());
  expect_refused("preview.json", R"({"dual": 1})", "expected true or false");
  expect_refused("preview.json", R"({"daul": true})", "did you mean 'dual'?");
  EXPECT_EQ(run("preview.json", R"({"dual": false})").status, 200);
  EXPECT_FALSE(state_.control().dual());
}

TEST_F(SceneCommandsTest, WrongChangesOfLightsAreRefused) {
  state_.update([](ViewStatus& status) {
    status.lights = {{"key", "sphere", {}, false}, {"key.1", "sphere", {}, false}};
  });
  const auto change = [](const std::string& light, const std::string& values) {
    return R"({"action": "change", "light": ")" + light + R"(", "values": )" + values + "}";
  };
  expect_refused("rig.json", change("kye", "{}"), "did you mean 'key'?");
  expect_refused("rig.json", change("key", R"({"size": [1, 1]})"), "unknown key 'size'");
  expect_refused("rig.json", change("key", R"({"radius": [0]})"), "radius: expected a list of 1 number from");
  expect_refused("rig.json", change("key", R"({"radius": 0.5})"), "radius: expected a list of 1 number");
  expect_refused("rig.json", change("key.1", R"({"position": [1, 2, 3]})"), "a name with a dot");
  expect_refused("rig.json", R"({"action": "remove", "light": "key.1"})", "a name with a dot");
  expect_refused("rig.json", change("key", R"({"position": [1, 2]})"), "position: expected 3 numbers");
  expect_refused("rig.json", change("key", R"({"position": [1, 2, 1e99]})"), "position: expected 3 numbers");
  expect_refused("rig.json", R"({"action": "add", "type": "sphre"})", "did you mean 'sphere'?");
  expect_refused("rig.json", R"({"action": "add", "type": "mesh"})", "add it by hand");
  expect_refused("rig.json", R"({"action": "add", "type": 3})", "unknown type of light");
  expect_refused("rig.json", R"({"action": "shine"})", "unknown value 'shine'");
  EXPECT_TRUE(state_.control().lights().empty());
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
                 "stops: expected a number");
  expect_refused("lights.json", R"({"action": "text", "edit": 0, "lights": {"key": {"tint": [1, -1, 1]}}})",
                 "tint: expected");
  for (const char* box :
       {"[0, 0, 1]", "[0, 0, 1e9, 1]", "[4, 0, 4, 5]", "[0, 5, 4, 4]", "[-1, 0, 4, 4]", "true"})
    expect_refused("region.json", std::string(R"({"region": )") + box + "}", "region: expected");
}

}  // namespace
}  // namespace pelage
