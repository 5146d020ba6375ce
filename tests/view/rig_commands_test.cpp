// SPDX-License-Identifier: Apache-2.0
#include "view/rig_commands.h"

#include <filesystem>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "tests/world/small_scene.h"
#include "view/scene_commands.h"
#include "view/scene_edit.h"

namespace pelage::rig_commands_test {
namespace {

class RigCommands : public testing::Test {
 protected:
  std::string path() const { return scene_.path("scene.yaml"); }
  /// Runs a command while the picture shows the scene file with the changes of the view; returns the answer.
  nlohmann::json run(const std::string& body, const char* name = "rig.json") {
    const LightChanges changes = state_.control().lights();
    SceneDescription scene = load_scene(path(), light_change_overrides(changes, path()));
    state_.update([&](ViewStatus& status) {
      status.lights = view_lights(scene, 1, changes);
      status.edit = std::make_shared<const SceneEdit>(SceneEdit{std::move(scene), {}});
    });
    const CommandAnswer answer = SceneCommands(path(), {}, state_).run(name, body);
    EXPECT_EQ(answer.status, 200) << body << answer.json;
    return nlohmann::json::parse(answer.json);
  }
  std::string text() { return run(R"({"action": "text"})")["text"]; }

  SmallScene scene_;
  ViewState state_;
};

TEST_F(RigCommands, ACopyHasAllKeysOfItsLight) {
  scene_.write("lamp.ies", "IESNA:LM-63-1995\nTILT=NONE\n1 1000 1 2 1 1 2 0 0 0\n1 1 50\n0 90 0 100 0\n");
  scene_.write("lit.yaml",
               "include: scene.yaml\nlights:\n"
               "  bulb: {type: point, position: [1, 2, 3], temperature: 2700, profile: lamp.ies}\n");
  const std::string lit = scene_.path("lit.yaml");
  const LightChange copy = copy_of(load_document(lit), lit, RigItem("bulb"), {{"position", {4, 5, 6}}});
  EXPECT_EQ(light_change_edits({{"bulb_2", copy}})[0].block,
            "{type: point, temperature: 2700, profile: 'lamp.ies', position: [4, 5, 6]}");
  // As an option, a file is relative to the current folder instead.
  const std::vector<Override> options = light_change_overrides({{"bulb_2", copy}}, lit);
  const SceneDescription scene = load_scene(lit, options);
  EXPECT_EQ(std::get<PointLightParams>(scene.lights.find("bulb_2")->value).profile.path,
            scene_.path("lamp.ies"));
}

TEST_F(RigCommands, CopiesOfCopiesAreNumbered) {
  EXPECT_EQ(run(R"({"action": "copy", "light": "key", "values": {"position": [1, 1, 1]}})")["light"],
            "key_2");
  EXPECT_EQ(run(R"({"action": "change", "light": "key_2", "values": {"radius": [0.5]}})").size(), 0u);
  EXPECT_EQ(run(R"({"action": "copy", "light": "key_2", "values": {"position": [2, 2, 2]}})")["light"],
            "key_3");
  EXPECT_EQ(text(),
            "lights:\n  key_2: {type: sphere, intensity: 30, position: [1, 1, 1], radius: 0.5}\n"
            "  key_3: {type: sphere, intensity: 30, radius: 0.5, position: [2, 2, 2]}\n");
}

TEST_F(RigCommands, MagnetsAreAddedMovedWrittenAndRemoved) {
  const std::string before = read_file(path());
  const auto magnet = [](const std::string& rest) { return R"({"block": "magnets", )" + rest + "}"; };
  EXPECT_EQ(run(magnet(
                R"("action": "add", "type": "rectangle", "values": {"position": [1, 2, 3], "size": [1, 2]})"))
                ["light"],
            "magnet");
  run(magnet(R"("action": "change", "light": "magnet", "values": {"share": [0.5]})"));
  EXPECT_EQ(text(), "magnets:\n  magnet: {type: rectangle, position: [1, 2, 3], share: 0.5, size: [1, 2]}\n");
  run(R"({"action": "write"})");
  EXPECT_EQ(
      read_file(path()),
      before + "magnets:\n  magnet: {type: rectangle, position: [1, 2, 3], share: 0.5, size: [1, 2]}\n");
  EXPECT_EQ(load_scene(path(), {}).magnets.items.size(), 1u);
  run(magnet(R"("action": "remove", "light": "magnet")"));
  run(R"({"action": "write"})");
  EXPECT_EQ(read_file(path()), before);
}

TEST_F(RigCommands, ChangesAreTakenBackGestureByGesture) {
  const auto change = [&](int x, const char* gesture) {
    run(R"({"action": "change", "light": "key", "values": {"position": [)" + std::to_string(x) +
        R"(, 0, 0]}, "gesture": ")" + gesture + "\"}");
  };
  change(1, "a"), change(2, "a"), change(3, "b");
  run(R"({"action": "remove", "light": "sky"})");
  run(R"({"action": "reset"})");
  const std::string moved = "lights:\n  key:\n    position: [", rest = ", 0, 0]\n";
  run(R"({"action": "undo"})");
  EXPECT_EQ(text(), moved + "3" + rest + "  # removed: sky\n");
  run(R"({"action": "undo"})");
  EXPECT_EQ(text(), moved + "3" + rest);
  run(R"({"action": "undo"})");
  EXPECT_EQ(text(), moved + "2" + rest);
  change(4, "a");
  run(R"({"action": "undo"})");
  EXPECT_EQ(text(), moved + "2" + rest) << "a gesture ends when it is taken back";
  run(R"({"action": "undo"})");
  EXPECT_TRUE(state_.control().lights().empty());
  EXPECT_FALSE(state_.control().can_undo_rig());
}

TEST_F(RigCommands, TheOldestStepsAreForgotten) {
  ViewControl& control = state_.control();
  const auto undone = [&] {
    int steps = 0;
    while (control.undo_rig()) ++steps;
    return steps;
  };
  for (int i = 0; i < 300; ++i)
    control.change_rig([&](LightChanges& changes) { changes["key"].values["radius"] = {i + 1.0}; });
  EXPECT_EQ(undone(), 200);
  EXPECT_EQ(control.lights().at("key").values.at("radius"), std::vector<double>{100});
  // Fewer steps where each holds many changes.
  control.change_rig([&](LightChanges& changes) {
    for (int i = 0; i < 10'000; ++i) changes["light_" + std::to_string(i)].values["radius"] = {1};
  });
  for (int i = 0; i < 20; ++i) control.change_rig([](LightChanges&) {});
  EXPECT_EQ(undone(), 3);
}

TEST_F(RigCommands, AMixOfALightThatIsNotInTheFileStaysInTheView) {
  const std::string before = read_file(path());
  run(R"({"action": "add", "type": "sphere", "values": {"intensity": [20]}})");
  run(R"({"action": "write", "edit": 0, "lights": {"sphere": {"stops": 1, "tint": [1, 0.5, 0]}}})",
      "lights.json");
  EXPECT_EQ(read_file(path()), before);
  EXPECT_EQ(text(), "lights:\n  sphere: {type: sphere, intensity: 40, radiance: [1, 0.5, 0]}\n");
}

}  // namespace
}  // namespace pelage::rig_commands_test
