// SPDX-License-Identifier: Apache-2.0
#include "cli/info.h"

#include <fstream>
#include <iostream>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/temporary_folder.h"
#include "cli/commands.h"
#include "tests/geom/alembic/ogawa_bytes.h"

namespace pelage {
namespace {

TEST(InfoScene, OutlinesWhatASceneHolds) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "s.yaml";
  std::ofstream(path) << R"(pelage: 1
frames: 1-4
skins:
  rat: {mesh: rat.obj, poses: {files: "walk.%04d.obj", count: 12}}
  eyes: {mesh: eyes.obj}
grooms:
  under: {skin: rat, strands: 1000, operators: [{length: {value: 1}}, {clump: {spacing: 1}}]}
  loose: {strands_file: a.hair}
materials:
  hide: {model: lambert}
  fur: {model: cone-shell, diffuse: 0.6}
characters:
  rat:
    parts:
      - {skin: rat, material: hide, grooms: {under: fur, loose: fur}}
      - {skin: eyes, material: hide}
crowds: {pack: {of: [rat], count: 7, area: {type: disc}}}
lights:
  key: {type: sphere, radius: 2}
  sun: {type: sun, temperature: 5000, visible: true, illuminates: [rat.under, pack], shadowed_by: []}
magnets: {window: {type: rectangle}}
)";
  const std::string text = describe_scene(load_scene(path));
  EXPECT_EQ(text.substr(0, 55), "scene, 1280 x 720 pixels, frames 1-4, 64 samples, 4 bou");
  for (const char* part :
       {"2 skins\n", "12 poses", "under: 1000 strands with 8 points on rat, under: length, clump\n",
        "rat: rat in hide with under in fur, loose in fur; eyes in hide\n", "1 crowds\n  pack: 7 of rat\n",
        "key: sphere\n", "1 magnets\n  window: rectangle\n",
        "sun: sun, 5000 K, visible, illuminates rat.under, pack, shadowed by nothing\n"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
}

TEST(InfoMemory, FilesThatNeedMoreAreRefusedInOneLine) {
  const TemporaryFolder folder;
  const std::string folder_name = folder.path().string() + "/";
  const std::string corners = "(0, 0, 0), (1, 0, 0), (0, 1, 0)";
  std::ofstream(folder_name + "a.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  std::ofstream(folder_name + "a.usda") << "#usda 1.0\ndef Mesh \"m\" { int[] faceVertexCounts = [3]\n int[] "
                                           "faceVertexIndices = [0, 1, 2]\n point3f[] points = ["
                                        << corners << "] }\n";
  std::ofstream(folder_name + "b.usda")
      << "#usda 1.0\ndef BasisCurves \"c\" { uniform token type = \"linear\"\n int[] curveVertexCounts = "
         "[3]\n point3f[] points = ["
      << corners << "] }\n";
  ExrImage image;
  image.width = image.height = 4;
  image.channels = {{"Y", ChannelType::kFloat, std::vector<float>(16), {}}};
  write_exr(folder_name + "a.exr", image);
  for (const char* name : {"a.obj", "a.usda", "b.usda", "a.exr"}) {
    for (const char* memory : {"60", "1M"}) {
      const std::optional<Options> options =
          parse_options({"info", folder_name + name, "--memory", memory}, std::cout);
      ASSERT_TRUE(options);
      try {
        testing::internal::CaptureStdout();
        run_info(*options);
        testing::internal::GetCapturedStdout();
        EXPECT_EQ(std::string(memory), "1M") << name;
      } catch (const Error& error) {
        testing::internal::GetCapturedStdout();
        EXPECT_EQ(std::string(memory), "60") << name << error.what();
        EXPECT_EQ(error.kind(), ErrorKind::kMemory);
        EXPECT_EQ(error.problems().size(), 1u);
        EXPECT_NE(std::string(error.what()).find("--memory"), std::string::npos) << error.what();
        EXPECT_EQ(std::string(error.what()).find("render.memory"), std::string::npos) << error.what();
      }
    }
  }
}

TEST(InfoMemory, OnlySceneFilesHaveValuesToSet) {
  const TemporaryFolder folder;
  const std::string mesh = (folder.path() / "a.obj").string();
  std::ofstream(mesh) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const std::optional<Options> options =
      parse_options({"info", mesh, "--set", "render.memory=1G"}, std::cout);
  ASSERT_TRUE(options);
  try {
    run_info(*options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), "--set works on scene files only");
  }
}

TEST(InfoAlembic, MeshesBesideUnreadableCurvesAreDescribed) {
  using namespace ogawa_bytes;
  const TemporaryFolder folder;
  Options options;
  options.input = folder.path() / "s.abc";
  OgawaBytes b;
  const Part hermite = b.curves("h", {4}, curve_form(0, 0, 4));
  const std::vector<Part> faces{b.array("P", kFloat, 3, {raw<float>({0, 0, 0, 1, 0, 0, 0, 1, 0})}),
                                b.array(".faceIndices", kInt32, 1, {raw<int32_t>({0, 1, 2})}),
                                b.array(".faceCounts", kInt32, 1, {raw<int32_t>({3})})};
  const Part mesh = b.object("m", "AbcGeom_PolyMesh_v1", {b.compound(".geom", faces)});
  std::ofstream(options.input, std::ios::binary) << b.file({hermite, mesh});
  testing::internal::CaptureStdout();
  EXPECT_EQ(run_info(options), 0);
  EXPECT_NE(testing::internal::GetCapturedStdout().find("1 face"), std::string::npos);
  std::ofstream(options.input, std::ios::binary) << b.file({hermite});
  try {
    run_info(options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("has no curves; curves with the bases Hermite"),
              std::string::npos);
  }
}

TEST(InfoUsd, MistakesOfCurvesAreNotHiddenByMeshes) {
  const TemporaryFolder folder;
  Options options;
  options.input = folder.path() / "s.usda";
  const std::string mesh =
      "#usda 1.0\ndef Mesh \"m\" { int[] faceVertexCounts = [3]\n int[] faceVertexIndices = "
      "[0, 1, 2]\n point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)] }\n";
  std::ofstream(options.input) << mesh;
  EXPECT_EQ(run_info(options), 0);
  std::ofstream(options.input) << mesh
                               << "def BasisCurves \"h\" { int[] curveVertexCounts = [7]\n point3f[] points "
                                  "= [(0, 0, 0)] }\n";
  EXPECT_THROW(run_info(options), Error);
}

TEST(InfoScene, OutlinesRib) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "s.rib";
  std::ofstream(path) << "WorldBegin LightSource \"ambientlight\" 1 Surface \"plastic\" Sphere 1 -1 1 360 "
                         "WorldEnd";
  Options options;
  options.input = path;
  options.progress = ProgressStyle::kQuiet;
  testing::internal::CaptureStdout();
  EXPECT_EQ(run_info(options), 0);
  const std::string text = testing::internal::GetCapturedStdout();
  for (const char* part : {": scene, 640 x 480 pixels", "plastic: lambert\n",
                           "1 archives\n  s: ", "s.rib, 1 surface\n", "ambientlight: environment\n"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

}  // namespace
}  // namespace pelage
