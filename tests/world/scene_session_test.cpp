// SPDX-License-Identifier: Apache-2.0
#include "world/scene_session.h"

#include <thread>

#include <gtest/gtest.h>

#include "base/stop_switch.h"
#include "geom/io/host_geometry.h"
#include "geom/io/obj_file.h"
#include "geom/io/strand_file.h"
#include "tests/world/small_scene.h"

namespace pelage::scene_session_test {
namespace {

std::vector<float> pixels(SceneSession& session) {
  NoProgress progress;
  const RenderedFrame frame = session.render({}, progress);
  std::vector<float> all;
  for (const ExrChannel& channel : frame.result.film.exr_rows(0, frame.result.film.height()))
    all.insert(all.end(), channel.pixels.begin(), channel.pixels.end());
  return all;
}

Override given(const std::string& key, Value value) { return {key, "", std::move(value)}; }
Override number(const std::string& key, const std::string& text) {
  return given(key, Value::scalar({key, 0, 0}, text));
}

std::string message_of(SceneSession& session, const std::vector<Override>& changes) {
  try {
    session.set(changes);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(SceneSession, SetsAllValuesOrNone) {
  SmallScene files(true);
  SceneSession session(files.path("scene.yaml"));
  EXPECT_EQ(
      message_of(session, {number("image.width", "8"), number("grooms.coat.operators.lenght.value", "1")}),
      "grooms.coat.operators.lenght.value: no item 'lenght' in the list; did you mean 'length'?");
  EXPECT_EQ(message_of(session, {number("image.width", "wide")}),
            "image.width: expected a whole number 1 .. 65536, got 'wide'");
  EXPECT_NE(session.scene()->image.width, 8);
  session.set({number("image.width", "8")});
  EXPECT_EQ(session.scene()->image.width, 8);
}

TEST(SceneSession, AnEditGivesThePixelsOfAFreshScene) {
  SmallScene files(true);
  const std::vector<Override> small{number("image.width", "24"), number("image.height", "16"),
                                    number("render.samples", "1")};
  SceneSession session(files.path("scene.yaml"), small);
  const std::vector<float> before = pixels(session);
  const std::vector<Override> longer{number("grooms.coat.operators.length.value", "0.6")};
  session.set(longer);
  std::vector<Override> all = small;
  all.insert(all.end(), longer.begin(), longer.end());
  SceneSession fresh(files.path("scene.yaml"), all);
  EXPECT_NE(pixels(session), before);
  EXPECT_EQ(pixels(session), pixels(fresh));
}

/// A scene without any file: its mesh and its strands are in memory.
TEST(SceneSession, MeshAndStrandsFromMemoryGiveThePixelsOfTheirFiles) {
  SmallScene files(true);
  SceneSession of_files(files.path("scene.yaml"), {number("render.samples", "1")});
  NoProgress progress;
  const Strands grown = of_files.grow("coat", {}, progress);
  write_strands(files.path("grown.hair"), grown);
  const std::string scene = R"(
pelage: 1
camera: {position: [0, 1, 4], look_at: [0, 0, 0], fov: 40}
image: {width: 24, height: 16}
skins: {cube: {mesh: cube.obj}}
grooms: {hair: {skin: cube, strands_file: grown.hair}}
materials: {skin: {model: lambert}, fur: {model: chiang}}
characters: {one: {parts: [{skin: cube, material: skin, grooms: {hair: fur}}]}}
lights: {key: {type: rectangle, position: [2, 4, 3], look_at: [0, 0, 0], size: [2, 2], radiance: [5, 5, 5]}}
render: {samples: 1}
)";
  const Value document = parse_document(scene, files.path("host.yaml"));
  SceneSession from_files(document);
  const auto mesh = share_mesh(read_obj(files.path("cube.obj")));
  const auto strands =
      share_strands(std::make_shared<const Strands>(read_strands(files.path("grown.hair")).strands));
  SceneSession from_memory(document, {given("skins.cube.mesh", Value::host({}, mesh)),
                                      given("grooms.hair.strands_file", Value::host({}, strands))});
  const std::vector<float> expected = pixels(from_files);
  EXPECT_GT(*std::max_element(expected.begin(), expected.end()), 0);
  EXPECT_EQ(pixels(from_memory), expected);
}

TEST(SceneSession, GrowNamesTheNearestCoat) {
  SmallScene files(true);
  SceneSession session(files.path("scene.yaml"));
  NoProgress progress;
  const Strands strands = session.grow("coat", {}, progress);
  EXPECT_EQ(strands.id(strands.strand_count() - 1), strands.strand_count() - 1);
  try {
    session.grow("caot", {}, progress);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "there is no coat 'caot'; did you mean 'coat'?");
  }
}

TEST(SceneSession, AnotherThreadStopsARender) {
  SmallScene files(true);
  SceneSession session(files.path("scene.yaml"), {number("render.samples", "1000000")});
  StopSwitch progress;
  std::thread other([&] { progress.stop(); });
  try {
    EXPECT_TRUE(session.render({}, progress).result.partial);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kStopped);
  }
  other.join();
}

}  // namespace
}  // namespace pelage::scene_session_test
