// SPDX-License-Identifier: Apache-2.0
#include "rib/document/rib_document.h"

#include <gtest/gtest.h>

#include "base/file.h"
#include "base/temporary_folder.h"
#include "rib/document/rib_values.h"
#include "tests/support/quiet_job.h"
#include "world/world.h"

namespace pelage::rib_document_test {
namespace {

class RibDocumentTest : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text, const char* name = "shot.rib") const {
    write_file(folder_.path() / name, text);
    return folder_.path() / name;
  }
  SceneDescription shot(const std::string& text, const std::vector<Override>& overrides = {}) const {
    return load_scene(write(text), overrides);
  }
  std::string failure(const std::string& text, const std::vector<Override>& overrides = {}) const {
    try {
      shot(text, overrides);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }
  TemporaryFolder folder_;
};

const std::string kHair =
    "Curves \"linear\" [2] \"nonperiodic\" \"P\" [0 0 0 0 1 0] \"constantwidth\" 0.1 \"uniform color Cs\" [1 "
    "0 0]\n";

std::string matrix_text(const M44f& m) {
  std::string text = "ConcatTransform [";
  for (const auto& row : m.x) {
    for (const float x : row) text += std::to_string(x) + " ";
  }
  return text + "]\n";
}

TEST_F(RibDocumentTest, TheCameraGivesTheRaysOfTheScenesCamera) {
  CameraParams params;
  params.position = V3f(3, 2, 8);
  params.look_at = V3f(1, 0.5f, 0);
  params.up = V3f(0.2f, 1, 0);
  params.fov = 31.0f;
  params.lens = LensParams{4, 0.5f, 7};
  // Landscape and portrait: the field of view of RI is that of the shorter side, unless ScreenWindow says
  // else.
  for (const auto& [width, height, window] :
       {std::tuple(320, 180, ""), std::tuple(180, 320, "ScreenWindow -0.5625 0.5625 -1 1"),
        std::tuple(320, 180, "ScreenWindow -1.7777778 1.7777778 -1 1")}) {
    const Camera camera(params, 1, width, height);
    const SceneDescription scene =
        shot("Format " + std::to_string(width) + " " + std::to_string(height) + " 1 DepthOfField 4 0.5 7 " +
             window + " Projection \"perspective\" \"fov\" 31\n" + matrix_text(camera.world_to_camera()) +
             "WorldBegin " + kHair + "WorldEnd");
    const Camera read(scene.camera, 1, scene.image.width, scene.image.height);
    for (const auto& [x, y] : {std::pair(0.f, 0.f), std::pair(100.f, 30.f), std::pair(170.f, 160.f)}) {
      const CameraRay a = camera.ray(x, y, V2f(.3f, .8f), 0), b = read.ray(x, y, V2f(.3f, .8f), 0);
      // std::to_string writes six decimals of the matrix.
      EXPECT_LT((a.origin - b.origin).length(), 3e-5f);
      EXPECT_LT((a.direction - b.direction).length(), 1e-5f);
    }
  }
}

TEST_F(RibDocumentTest, ScreenWindowShiftsTheLensAndExposureIsInStops) {
  const SceneDescription scene = shot(
      "Format 200 100 1 Exposure 4 1 ScreenWindow 0 4 -1.5 0.5 Projection \"perspective\" \"fov\" 90 "
      "Scale 1 1 -1 WorldBegin " +
      kHair + "WorldEnd");
  EXPECT_EQ(scene.camera.shift, V2f(0.5f, -0.25f));
  EXPECT_EQ(scene.camera.exposure.at(1), 2);
  const Camera camera(scene.camera, 1, 200, 100);
  EXPECT_LT((camera.ray(200, 100, V2f(.5f), 0).direction - V3f(4, -1.5f, -1).normalized()).length(), 1e-6f);
}

TEST_F(RibDocumentTest, AMovingCameraHasKeysOverTheShutter) {
  const SceneDescription scene = shot(
      "FrameBegin 7 Shutter -0.25 0.25 Projection \"perspective\" \"fov\" 30 MotionBegin [-0.25 0.25] "
      "Translate 0 0 5 "
      "Translate 0 0 6 MotionEnd Scale 1 1 -1 WorldBegin " +
      kHair + "WorldEnd FrameEnd");
  EXPECT_EQ(scene.frames.frames, (std::vector<int>{7}));
  EXPECT_EQ(scene.camera.shutter, V2f(-.25f, .25f));
  EXPECT_NEAR(scene.camera.position.at(6.75).z, 5, 1e-5);
  EXPECT_NEAR(scene.camera.position.at(7.25).z, 6, 1e-5);
}

TEST_F(RibDocumentTest, FramesBecomeKeys) {
  const auto frame = [](int number) {
    return "FrameBegin " + std::to_string(number) + " Projection \"perspective\" Translate 0 0 " +
           std::to_string(number) + " Scale 1 1 -1 WorldBegin " + kHair + "WorldEnd FrameEnd\n";
  };
  const SceneDescription scene = shot(frame(2) + frame(4));
  EXPECT_EQ(scene.frames.frames, (std::vector<int>{2, 4}));
  EXPECT_NEAR(scene.camera.position.at(2).z, 2, 1e-5);
  EXPECT_NEAR(scene.camera.position.at(4).z, 4, 1e-5);
}

TEST_F(RibDocumentTest, OverridesWinOverTheFile) {
  const std::string text =
      "Option \"pelage\" \"string image\" [\"{filter: box, width: 7}\"] Option \"pelage\" \"string "
      "render\" [\"{bounces: 2, samples: 9}\"] Format 64 48 1 PixelSamples 4 4 Projection "
      "\"perspective\" WorldBegin " +
      kHair + "WorldEnd";
  SceneDescription scene = shot(text);
  EXPECT_EQ(scene.image.width, 64) << "requests win over the option, because other programs may edit them";
  EXPECT_EQ(scene.render.samples, 16);
  EXPECT_EQ(scene.render.bounces, 2);
  scene = shot(text, {{"image.width", "20"}, {"render.samples", "3"}, {"camera.fov", "12"}});
  EXPECT_EQ(scene.image.width, 20);
  EXPECT_EQ(scene.render.samples, 3);
  EXPECT_NEAR(scene.camera.fov.at(1), 12, 1e-5);
  EXPECT_NE(failure(text, {{"image.widht", "20"}}).find("did you mean 'width'"), std::string::npos);
}

TEST_F(RibDocumentTest, MaterialsAndLightsThatPelageWrote) {
  const SceneDescription scene = shot(
      "WorldBegin AttributeBegin AreaLightSource \"arealight\" 1 \"string name\" \"key\" \"string pelage\" "
      "[\"{type: sphere, position: [1, 2, 3], radius: 0.5}\"] Sphere 0.5 -0.5 0.5 360 AttributeEnd "
      "Surface \"pelage_fur\" \"string name\" \"fur\" \"float diffuse\" 0.7 \"string pelage\" "
      "[\"{model: cone-shell, color: {attribute: color}, diffuse: 0.7}\"] " +
      kHair + "WorldEnd");
  ASSERT_EQ(scene.lights.items.size(), 1u);
  EXPECT_EQ(scene.lights.items[0].name, "key");
  EXPECT_EQ(std::get<SphereLightParams>(scene.lights.items[0].value).radius, .5f);
  ASSERT_TRUE(scene.materials.find("fur"));
  EXPECT_EQ(std::get<ConeShellParams>(scene.materials.find("fur")->value).diffuse, .7f);
}

TEST_F(RibDocumentTest, LightsAndMaterialsOfOtherPrograms) {
  const SceneDescription scene = shot(
      "Projection \"perspective\" WorldBegin LightSource \"envlight\" 1 \"intensity\" 0.5 \"string name\" "
      "\"sky\" LightSource "
      "\"pointlight\" 2 "
      "\"from\" [0 5 0] LightSource \"gobo\" 3 AttributeBegin AreaLightSource \"finite\" 4 \"color "
      "lightcolor\" [1 2 3] "
      "Polygon \"P\" [0 0 0 2 0 0 2 1 0 0 1 0] AttributeEnd Surface \"plastic\" Color [0.1 0.2 0.3] "
      "PointsPolygons [3] [0 1 2] \"P\" [0 0 0 1 0 0 0 1 0] WorldEnd");
  ASSERT_EQ(scene.lights.items.size(), 3u);
  EXPECT_TRUE(std::holds_alternative<EnvironmentLightParams>(scene.lights.items[0].value));
  EXPECT_EQ(scene.lights.items[0].name, "sky");
  EXPECT_TRUE(std::holds_alternative<PointLightParams>(scene.lights.items[1].value));
  EXPECT_EQ(scene.lights.items[1].name, "pointlight");
  const auto& quad = std::get<RectangleLightParams>(scene.lights.items[2].value);
  EXPECT_EQ(quad.size, V2f(2, 1));
  // The corners turn left as seen from z = 1, in a left-handed world, which is mirrored.
  EXPECT_LT(quad.look_at.at(1).z, 0);
  EXPECT_EQ(quad.radiance, Rgb(1, 2, 3));
  EXPECT_TRUE(std::holds_alternative<LambertParams>(scene.materials.find("plastic")->value));
  EXPECT_EQ(scene.warnings.size(), 2u) << "one for gobo, one for plastic";
}

TEST_F(RibDocumentTest, OrthographicCamerasAndTheirWindow) {
  // Without a projection, RI sees [-1, 1] of the shorter side, from the origin along +z.
  SceneDescription scene = shot("Format 64 48 1 WorldBegin " + kHair + "WorldEnd");
  Camera camera(scene.camera, 1, 64, 48);
  EXPECT_LT((camera.ray(64, 48, V2f(.5f), 0).origin - V3f(4.0f / 3, -1, 0)).length(), 1e-6f);
  EXPECT_EQ(camera.ray(64, 48, V2f(.5f), 0).direction, V3f(0, 0, -1)) << "the world is mirrored";
  scene = shot(
      "Format 64 64 1 ScreenWindow 0 4 -1 3 Projection \"orthographic\" Translate 0 0 9 Scale 2 2 -2 "
      "WorldBegin " +
      kHair + "WorldEnd");
  EXPECT_TRUE(scene.warnings.empty());
  camera = Camera(scene.camera, 1, 64, 64);
  for (const V3f& p : {V3f(0, 0, 0), V3f(1, 0.5f, 2), V3f(0.3f, -0.2f, -7)}) {
    const auto at = camera.project(p, 0);
    ASSERT_TRUE(at);
    EXPECT_NEAR(at->x, 16 * 2 * p.x, 1e-3f);
    EXPECT_NEAR(at->y, 64 - 16 * (2 * p.y + 1), 1e-3f);
  }
}

TEST_F(RibDocumentTest, LightsOfOldShadersAreNoBackground) {
  write("", "sky.hdr");
  write("", "sky.env");
  const SceneDescription scene = shot(
      "Projection \"perspective\" WorldBegin LightSource \"ambientlight\" 1 LightSource \"envlight\" 2 "
      "\"string filename\" "
      "\"sky.hdr\" LightSource \"envlight\" 3 \"string filename\" \"sky.env\" LightSource \"envlight\" 4 "
      "\"string "
      "filename\" \"none.hdr\" LightSource \"shadowspot\" 5 \"from\" [1 2 3] \"to\" [0 0 0] LightSource "
      "\"mySun\" 6 AttributeBegin AreaLightSource \"a\" 7 Polygon \"P\" [0 0 0 2 0 0 3 1 0 2 2 0 0 2 0] "
      "AttributeEnd WorldEnd");
  ASSERT_EQ(scene.lights.items.size(), 7u);
  const auto environment = [&](size_t i) {
    return std::get<EnvironmentLightParams>(scene.lights.items[i].value);
  };
  for (size_t i = 0; i < 4; ++i) EXPECT_FALSE(environment(i).visible);
  EXPECT_EQ(environment(1).file.path, folder_.path() / "sky.hdr");
  EXPECT_TRUE(environment(2).file.empty());
  EXPECT_TRUE(environment(3).file.empty());
  const auto& spot = std::get<SpotLightParams>(scene.lights.items[4].value);
  EXPECT_EQ(spot.position.at(1), V3f(1, 2, -3));
  EXPECT_EQ(spot.look_at.at(1), V3f(0));
  EXPECT_NEAR(spot.cone, 60, 1e-4) << "the standard shader's default is half of it";
  EXPECT_NEAR(spot.softness, 1 / 6.0, 1e-5);
  EXPECT_EQ(std::get<SunLightParams>(scene.lights.items[5].value).direction.at(1), V3f(0, 0, -1));
  const auto& polygon = std::get<RectangleLightParams>(scene.lights.items[6].value);
  EXPECT_NEAR(polygon.size.x * polygon.size.y, 5, 1e-5);
  EXPECT_EQ(scene.warnings.size(), 3u) << "the missing map, the map of another kind, the polygon";
}

TEST_F(RibDocumentTest, LightsOfUnknownShadersShineFromTheirOrigin) {
  const SceneDescription scene = shot(
      "Projection \"perspective\" Scale 1 1 -1 WorldBegin TransformBegin Translate 1 2 3 LightSource "
      "\"uberlight\" 1 TransformEnd LightSource \"stagelight\" 2 \"from\" [4 5 6] WorldEnd");
  ASSERT_EQ(scene.lights.items.size(), 2u);
  EXPECT_EQ(std::get<PointLightParams>(scene.lights.items[0].value).position.at(1), V3f(1, 2, 3));
  EXPECT_EQ(std::get<PointLightParams>(scene.lights.items[1].value).position.at(1), V3f(4, 5, 6));
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].message.find("'uberlight' is not known"), std::string::npos);
}

TEST_F(RibDocumentTest, ThousandsOfLightsHaveNoLayers) {
  std::string lights;
  for (int i = 0; i < 101; ++i) lights += "LightSource \"pointlight\" 1 ";
  const std::string picture = "Projection \"perspective\" WorldBegin " + lights + "WorldEnd";
  EXPECT_FALSE(shot(picture).image.light_layers);
  EXPECT_EQ(shot(picture).warnings.size(), 1u);
  EXPECT_TRUE(shot(picture, {{"image.light_layers", "true"}}).image.light_layers);
  EXPECT_TRUE(
      shot("Option \"pelage\" \"string image\" [\"{light_layers: true}\"] " + picture).image.light_layers);
}

TEST_F(RibDocumentTest, LightsOfRis) {
  const SceneDescription scene = shot(
      "Projection \"perspective\" Scale 1 1 -1 WorldBegin Light \"PxrDomeLight\" \"dome\" \"float "
      "intensity\" [2] \"float exposure\" "
      "[1] \"color lightColor\" [1 .5 .25] AttributeBegin Translate 0 5 0 Scale 4 2 1 Light \"PxrRectLight\" "
      "\"rect\" "
      "AttributeEnd Attribute \"visibility\" \"int camera\" [0] Light \"PxrSphereLight\" \"ball\" Light "
      "\"PxrDistantLight\" \"sun\" \"float angleExtent\" [2] \"int enableTemperature\" [1] \"float "
      "temperature\" [3000] "
      "AttributeBegin Translate 0 3 0 Rotate -90 1 0 0 Scale 4 1 7 Light \"PxrDiskLight\" \"disk\" \"int "
      "enableShadows\" [0] "
      "AttributeEnd Light \"PxrMeshLight\" \"mesh\" WorldEnd");
  ASSERT_EQ(scene.lights.items.size(), 5u);
  const auto& dome = std::get<EnvironmentLightParams>(scene.lights.items[0].value);
  EXPECT_EQ(scene.lights.items[0].name, "dome");
  EXPECT_EQ(dome.radiance, Rgb(4, 2, 1));
  EXPECT_TRUE(dome.visible);
  const auto& rect = std::get<RectangleLightParams>(scene.lights.items[1].value);
  EXPECT_NEAR(rect.size.x * rect.size.y, 8, 1e-5);
  EXPECT_LT((rect.look_at.at(1) - rect.position.at(1)).normalized().z, -0.999f);
  EXPECT_TRUE(rect.visible);
  const auto& ball = std::get<SphereLightParams>(scene.lights.items[2].value);
  EXPECT_FLOAT_EQ(ball.radius, .5f);
  EXPECT_FALSE(ball.visible);
  const auto& sun = std::get<SunLightParams>(scene.lights.items[3].value);
  EXPECT_EQ(sun.angle, 2);
  EXPECT_NEAR(*sun.irradiance, M_PI, 1e-5);
  EXPECT_EQ(sun.temperature, 3000.0f);
  EXPECT_FALSE(sun.visible) << "in no renderer";
  const auto& disk = std::get<DiskLightParams>(scene.lights.items[4].value);
  EXPECT_NEAR(disk.radius, 1, 1e-5) << "the area of the ellipse";
  EXPECT_NEAR((disk.look_at.at(1) - disk.position.at(1)).normalized().y, -1, 1e-5);
  EXPECT_FALSE(disk.shadows);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].message.find("PxrMeshLight"), std::string::npos);
}

TEST_F(RibDocumentTest, AnObjectIsNotDefinedAgainWithinItself) {
  write("ObjectBegin 1 Sphere 1 -1 1 360 ObjectEnd", "again.rib");
  EXPECT_THROW(
      shot("Projection \"perspective\" WorldBegin ObjectBegin 1 ReadArchive \"again.rib\" Sphere 1 -1 1 "
           "360 ObjectEnd ObjectInstance 1 WorldEnd"),
      Error);
}

TEST_F(RibDocumentTest, BxdfsAndOpacity) {
  const std::string mesh = "PointsPolygons [3] [0 1 2] \"P\" [0 0 0 1 0 0 0 1 0] ";
  const SceneDescription scene = shot(
      "Projection \"perspective\" WorldBegin LightSource \"ambientlight\" 1 Bxdf \"PxrSurface\" \"eye\" "
      "\"color diffuseColor\" [.2 .4 .6] \"float "
      "diffuseGain\" [.5] \"color specularFaceColor\" [1 1 1] \"float specularRoughness\" [.1] " +
      mesh + "Bxdf \"PxrDiffuse\" \"skin\" " + mesh +
      "Bxdf \"PxrMarschnerHair\" \"hair\" \"color diffuseColor\" [0 0 0] \"color specularColorTT\" [.3 .2 "
      ".1] \"float "
      "specularConeAngleR\" [9] " +
      kHair +
      "Pattern \"PxrPrimvar\" \"own\" \"string varname\" [\"Cs\"] Bxdf \"PxrDisney\" \"tuft\" \"reference "
      "color baseColor\" "
      "[\"own:resultRGB\"] Opacity .5 .5 .5 " +
      kHair + "WorldEnd");
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0].message;
  const auto& eye = std::get<GlossyParams>(scene.materials.find("eye")->value);
  EXPECT_EQ(eye.color.color({}), Rgb(.1f, .2f, .3f));
  EXPECT_EQ(eye.roughness, .1f);
  EXPECT_TRUE(std::holds_alternative<LambertParams>(scene.materials.find("skin")->value));
  const auto& hair = std::get<MarschnerParams>(scene.materials.find("hair")->value);
  EXPECT_EQ(hair.color.color({}), Rgb(.3f, .2f, .1f));
  EXPECT_EQ(hair.beta, 9);
  const auto& tuft = std::get<ConeShellParams>(scene.materials.find("tuft")->value);
  EXPECT_EQ(tuft.color.attribute_names(), (std::vector<std::string>{"color"}));
  EXPECT_FLOAT_EQ(tuft.opacity.value({}), .5f);
}

TEST_F(RibDocumentTest, AFileNamesNoFolderToWriteInto) {
  const std::string surfaces =
      "Surface \"hair\" \"string pelage\" [\"{model: yan, preset: mouse, tables: /etc}\"]\n" + kHair +
      "Surface \"other\" \"string model\" \"yan\" \"string preset\" \"mouse\" \"string tables\" \"/etc\"\n" +
      kHair;
  const std::string text =
      "Option \"pelage\" \"string render\" [\"{bvh: {file: /etc}, bounces: 3}\"]\n"
      "Projection \"perspective\" WorldBegin\n" +
      surfaces + "WorldEnd";
  const SceneDescription scene = shot(text);
  EXPECT_TRUE(scene.render.bvh.file.empty());
  EXPECT_EQ(scene.render.bounces, 3);
  for (const char* name : {"hair", "other"})
    EXPECT_TRUE(std::get<YanParams>(scene.materials.find(name)->value).tables.empty()) << name;
  ASSERT_EQ(scene.warnings.size(), 3u);
  EXPECT_NE(scene.warnings[0].message.find("`file` is ignored"), std::string::npos);
  EXPECT_EQ(scene.warnings[0].position.line, 1);
  const SceneDescription asked = shot(text, {{"render.bvh.file", "trees"}, {"materials.hair.tables", "t"}});
  EXPECT_EQ(asked.render.bvh.file.path, "trees");
  EXPECT_EQ(std::get<YanParams>(asked.materials.find("hair")->value).tables.path, "t");

  // Files that a scene places as archives, whatever their names, may not either. Their scene may.
  write(surfaces, "a.inc");
  write_file(folder_.path() / "scene.yaml",
             "pelage: 1\ncamera: {position: [0, 0, 5], look_at: [0, 0, 0]}\nrender: {bvh: {file: trees}}\n"
             "materials: {own: {model: yan, preset: mouse, tables: t}}\narchives: {a: {rib: a.inc}}\n");
  const SceneDescription outer = load_scene(folder_.path() / "scene.yaml");
  EXPECT_TRUE(std::get<YanParams>(outer.materials.find("a.hair")->value).tables.empty());
  EXPECT_EQ(std::get<YanParams>(outer.materials.find("own")->value).tables.path, folder_.path() / "t");
  EXPECT_FALSE(outer.render.bvh.file.empty());
  EXPECT_EQ(outer.warnings.size(), 2u);
}

TEST_F(RibDocumentTest, MistakesHavePositions) {
  EXPECT_NE(failure("WorldBegin\n Translate 1 WorldEnd").find("shot.rib:2:2: Translate: expected 3 numbers"),
            std::string::npos);
  EXPECT_NE(failure(kHair).find("the file has no WorldBegin"), std::string::npos);
  EXPECT_NE(failure("Option \"pelage\" \"string image\" [\"{widht: 5}\"] WorldBegin WorldEnd")
                .find("shot.rib:1:32: unknown key 'widht'"),
            std::string::npos);
  for (const char* block : {"{a: \xff}", "{a: \x01}", "{a: [}", "{a: \xff\n"})
    EXPECT_NE(
        failure("Option \"pelage\" \"string image\" [\"" + std::string(block) + "\"] WorldBegin WorldEnd")
            .find("shot.rib:1:32: "),
        std::string::npos)
        << block;
}

TEST_F(RibDocumentTest, ScenesGetMaterialsForTheSurfacesOfTheirArchives) {
  write(
      "Surface \"pelage_fur\" \"string name\" \"fur\" \"string model\" \"cone-shell\" \"color color\" [1 0 "
      "0] " +
          kHair + "Surface \"plastic\" PointsPolygons [3] [0 1 2] \"P\" [0 0 0 1 0 0 0 1 0]",
      "a.rib");
  write(
      "pelage: 1\nmaterials: {hide: {model: lambert}}\narchives:\n  fox: {rib: a.rib, materials: {plastic: "
      "hide}}\n",
      "scene.yaml");
  const SceneDescription scene = load_scene(folder_.path() / "scene.yaml");
  ASSERT_TRUE(scene.materials.find("fox.fur"));
  EXPECT_FALSE(scene.materials.find("fox.plastic"));
  EXPECT_EQ(scene.archives.items[0].value.materials.find("fur")->value.name, "fox.fur");
  EXPECT_TRUE(scene.warnings.empty());

  write(
      "pelage: 1\nmaterials: {hide: {model: lambert}}\narchives:\n  fox: {rib: a.rib, materials: {plastik: "
      "hide}}\n",
      "scene.yaml");
  const SceneDescription misspelt = load_scene(folder_.path() / "scene.yaml");
  ASSERT_EQ(misspelt.warnings.size(), 2u) << "also: the shader plastic is not known";
  EXPECT_NE(misspelt.warnings[0].message.find("no surface 'plastik'; did you mean 'plastic'?"),
            std::string::npos);
  write("pelage: 1\narchives:\n  fox: {rib: none.rib}\n", "scene.yaml");
  try {
    load_scene(folder_.path() / "scene.yaml");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("scene.yaml:3:14: "), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace pelage::rib_document_test
