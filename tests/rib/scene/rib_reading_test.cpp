// SPDX-License-Identifier: Apache-2.0
#include "rib/scene/rib_reading.h"

#include <gtest/gtest.h>

#include "tests/rib/scene/rib_scenes.h"

namespace pelage::rib_reading_test {
namespace {

using namespace rib_test;

TEST(RibReading, TransformsApplyFromTheInnermost) {
  expect_near(tip("Translate 1 2 3 " + kHair), {1, 3, 3});
  expect_near(tip("Translate 1 0 0 Scale 2 3 4 " + kHair), {1, 3, 0});
  expect_near(tip("Scale 2 2 2 Translate 1 0 0 " + kHair), {2, 2, 0});
  expect_near(tip("Rotate 90 0 0 1 " + kHair), {-1, 0, 0});
  expect_near(tip("Rotate 90 0 0 0 " + kHair), {0, 1, 0});  // exporters write this for no rotation
  expect_near(tip("ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1] " + kHair), {5, 7, 7});
  expect_near(tip("Translate 9 9 9 Identity " + kHair), {0, 1, 0});
  expect_near(tip("Translate 9 9 9 Transform [2 0 0 0 0 2 0 0 0 0 2 0 0 0 1 1] " + kHair), {0, 2, 1});
  expect_near(
      tip("Translate 1 0 9 WorldBegin Translate 5 5 5 CoordSysTransform \"camera\" " + kHair + "WorldEnd"),
      {-1, 1, -9});
  expect_near(tip("Translate 1 0 0 CoordinateSystem \"here\" Identity CoordSysTransform \"here\" " + kHair),
              {1, 1, 0});
}

TEST(RibReading, BlocksRestoreTheState) {
  expect_near(tip("TransformBegin Translate 5 0 0 TransformEnd " + kHair), {0, 1, 0});
  const RibScene scene =
      read("Color [1 0 0] AttributeBegin Color [0 1 0] TransformBegin Color [0 0 1] TransformEnd " + kHair +
           "AttributeEnd " + kHair);
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[0].color, Rgb(0, 0, 1)) << "TransformEnd restores the transform alone";
  EXPECT_EQ(scene.materials[1].color, Rgb(1, 0, 0));
}

TEST(RibReading, CameraAndWorld) {
  const RibScene scene = read(
      "Format 320 200 1 PixelSamples 4 4 Shutter -0.25 0.25 DepthOfField 4 0.5 12 "
      "ScreenWindow -1.6 1.6 -1 1 Projection \"perspective\" \"fov\" [35] Translate 0 0 5 "
      "Display \"a.tif\" \"file\" \"rgba\" WorldBegin Translate 1 0 0 " +
      kHair + "WorldEnd");
  const RibCamera& camera = scene.camera;
  EXPECT_TRUE(camera.stated);
  EXPECT_EQ(camera.fov, 35);
  EXPECT_EQ(camera.format->first, 320);
  EXPECT_EQ(*camera.shutter, V2f(-0.25f, 0.25f));
  EXPECT_EQ(*camera.lens, V3f(4, .5f, 12));
  EXPECT_EQ(camera.display, "a.tif");
  EXPECT_EQ(camera.to_camera.at(0).translation(), V3f(0, 0, 5));
  expect_near(tips(scene)[0], {1, 1, 0});
  EXPECT_TRUE(scene.warnings.empty());
}

// RenderMan's camera space is left-handed. Without a mirror between the world and the camera, the world is
// too.
TEST(RibReading, LeftHandedWorldsAreMirroredOnRequest) {
  const std::string hair = "Curves \"linear\" [2] \"nonperiodic\" \"P\" [0 0 0 1 2 3] \"constantwidth\" 0.1 ";
  RibReadOptions options;
  options.mirror_left_handed = true;
  expect_near(tips(read("WorldBegin " + hair + "WorldEnd", options))[0], {1, 2, -3});
  expect_near(tips(read("Scale 1 1 -1 WorldBegin " + hair + "WorldEnd", options))[0], {1, 2, 3});
  expect_near(tips(read("WorldBegin Identity " + hair + "WorldEnd", options))[0], {1, 2, -3});
  expect_near(tips(read("WorldBegin " + hair + "WorldEnd"))[0], {1, 2, 3});
}

TEST(RibReading, MotionOfTransformsAndOfPoints) {
  RibReadOptions options;
  options.shutter = V2f(0, 0.5f);
  RibScene scene = read("MotionBegin [0 1] Translate 0 0 0 Translate 4 0 0 MotionEnd " + kHair, options);
  EXPECT_EQ(scene.coats[0].batches[0]->motion_keys(), 2);
  expect_near(tips(scene, 0)[0], {0, 1, 0});
  expect_near(tips(scene, 1)[0], {2, 1, 0});
  const std::string moved =
      "Curves \"linear\" [2] \"nonperiodic\" \"P\" [0 0 0 0 3 0] \"constantwidth\" 0.1 ";
  scene = read("MotionBegin [0 0.5] " + kHair + moved + "MotionEnd", options);
  expect_near(tips(scene, 1)[0], {0, 3, 0});
  for (const std::string times : {"24 24.5", "1 1.5", "2 2.5"}) {
    scene = read("Shutter " + times + " WorldBegin MotionBegin [" + times + "] " + kHair + moved +
                     "MotionEnd WorldEnd",
                 options);
    ASSERT_TRUE(scene.camera.shutter);
    EXPECT_EQ(*scene.camera.shutter, V2f(0, 0.5f)) << times;
    expect_near(tips(scene, 1)[0], {0, 3, 0});
  }
  for (const std::string times : {"-0.25 0.25", "23.75 24.25", "0.75 1.25"}) {
    scene = read("Shutter " + times + " WorldBegin WorldEnd");
    ASSERT_TRUE(scene.camera.shutter);
    EXPECT_EQ(*scene.camera.shutter, V2f(-0.25f, 0.25f)) << times;
  }
  scene = read("Shutter 24 25 WorldBegin WorldEnd");
  EXPECT_EQ(*scene.camera.shutter, V2f(0, 1));
  EXPECT_EQ(read("MotionBegin [0 1] Translate 0 0 0 Translate 4 0 0 MotionEnd " + kHair)
                .coats[0]
                .batches[0]
                ->motion_keys(),
            1);
}

TEST(RibReading, ObjectsAndArchivesAreReplayed) {
  const RibScene scene =
      read("ObjectBegin 1 " + kHair + "ObjectEnd ArchiveBegin \"tuft\" Translate 0 0 1 " + kHair +
           "ArchiveEnd AttributeBegin Translate 1 0 0 ObjectInstance 1 AttributeEnd "
           "AttributeBegin Translate 2 0 0 ObjectInstance 1 AttributeEnd ReadArchive \"tuft\"");
  const std::vector<V3f> all = tips(scene);
  ASSERT_EQ(all.size(), 3u);
  expect_near(all[0], {1, 1, 0});
  expect_near(all[1], {2, 1, 0});
  expect_near(all[2], {0, 1, 1});
  EXPECT_EQ(scene.coats[0].batches[0]->id(2), 2u) << "ids go on";
}

TEST(RibReading, MaterialsAndCoats) {
  const std::string fur = "Surface \"pelage_fur\" \"string name\" [\"coat\"] \"float diffuse\" [0.5] ";
  const RibScene scene =
      read(fur + "Attribute \"identifier\" \"string name\" [\"tuft.a\"] " + kHair + kHair + fur + kHair +
           "Attribute \"identifier\" \"name\" \"tuft.b\" " + kHair +
           "Surface \"plastic\" \"float Kd\" 0.3 PointsPolygons [3] [0 1 2] \"P\" [0 0 0 1 0 0 0 1 0]");
  ASSERT_EQ(scene.coats.size(), 2u);
  EXPECT_EQ(scene.coats[0].name, "tuft.a");
  EXPECT_EQ(scene.coats[0].batches[0]->strand_count(), 3u) << "the same shader twice is one material";
  EXPECT_EQ(scene.coats[1].name, "tuft.b");
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[0].name, "coat");
  EXPECT_TRUE(scene.materials[0].fibre);
  EXPECT_EQ(scene.materials[0].shader->find("diffuse")->numbers, (std::vector<float>{.5f}));
  EXPECT_EQ(scene.materials[1].name, "plastic");
  ASSERT_EQ(scene.skins.size(), 1u);
  EXPECT_EQ(scene.skins[0].material, 1u);
}

TEST(RibReading, Lights) {
  const RibScene scene = read(
      "WorldBegin LightSource \"distantlight\" 1 \"intensity\" 2 AttributeBegin AreaLightSource "
      "\"arealight\" 2 "
      "\"string name\" \"key\" Translate 0 5 0 Sphere 0.5 -0.5 0.5 360 AttributeEnd AttributeBegin "
      "AreaLightSource "
      "\"arealight\" 3 Polygon \"P\" [0 0 0 1 0 0 1 1 0 0 1 0] AttributeEnd WorldEnd");
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[1].name, "key");
  EXPECT_EQ(scene.lights[1].shape, RibLight::Shape::kSphere);
  EXPECT_EQ(scene.lights[1].radius, 0.5f);
  expect_near(V3f(0) * scene.lights[1].to_world.at(0), {0, 5, 0});
  EXPECT_EQ(scene.lights[2].corners.size(), 4u);
  EXPECT_TRUE(scene.skins.empty()) << "a light is no skin";
}

TEST(RibReading, FramesAreReadOneByOne) {
  const std::string text = "FrameBegin 3 WorldBegin " + kHair +
                           "WorldEnd FrameEnd FrameBegin 5 WorldBegin Translate 0 0 1 " + kHair +
                           "WorldEnd FrameEnd";
  RibScene scene = read(text);
  EXPECT_EQ(scene.frame, 3);
  expect_near(tips(scene)[0], {0, 1, 0});
  RibReadOptions options;
  options.frame = 5;
  scene = read(text, options);
  ASSERT_EQ(tips(scene).size(), 1u);
  expect_near(tips(scene)[0], {0, 1, 1});
  options.frame = 4;
  EXPECT_TRUE(read(text, options).coats.empty());
}

TEST(RibReading, OptionsOfPelage) {
  const RibScene scene = read("Option \"pelage\" \"string image\" [\"{width: 20}\"]");
  EXPECT_EQ(scene.options.at("image").front().strings[0], "{width: 20}");
}

TEST(RibReading, SkippedRequestsWarnOncePerKind) {
  const RibScene scene = read(
      "Blobby 1 [] [] [] Blobby 1 [] [] []\nPoints TrimCurve\n"
      "Attribute \"dice\" \"float rate\" 1 Attribute \"dice\" \"float rate\" 2 Geometry \"teapot\" " +
      kHair);
  ASSERT_EQ(scene.warnings.size(), 5u);
  EXPECT_EQ(scene.warnings[0].message, "request 'Blobby' is not supported; skipped");
  EXPECT_EQ(scene.warnings[0].position.line, 1);
  EXPECT_EQ(scene.warnings[1].position.line, 2);
  EXPECT_EQ(tips(scene).size(), 1u);
}

TEST(RibReading, MistakesHavePositions) {
  EXPECT_EQ(failure("AttributeEnd"), "a.rib:1:1: AttributeEnd: there is no open AttributeBegin");
  EXPECT_EQ(failure("AttributeBegin"), "a.rib:1:1: AttributeBegin has no AttributeEnd");
  EXPECT_NE(failure("AttributeBegin TransformEnd").find("the innermost open block is AttributeBegin"),
            std::string::npos);
  EXPECT_EQ(failure("\n Translate 1 2"), "a.rib:2:2: Translate: expected 3 numbers, got 2");
  EXPECT_EQ(failure("Translate 1 2 \"x\""), "a.rib:1:15: Translate: expected a number, got a string");
  EXPECT_EQ(failure("Scale 1 0 1 WorldBegin"),
            "a.rib:1:13: WorldBegin: the transform of the camera has no inverse");
  EXPECT_EQ(failure("Transform [1 0 0 .5 0 1 0 0 0 0 1 0 0 0 0 1]"),
            "a.rib:1:1: Transform: the last column of a matrix must be 0 0 0 1; perspective belongs to "
            "Projection");
  EXPECT_EQ(failure("Basis \"bspline\" 1 \"bspline\" 1"),
            "a.rib:1:7: Basis: unknown basis 'bspline'; did you mean 'b-spline'?");
  EXPECT_EQ(failure("MotionBegin [1 0]"), "a.rib:1:1: MotionBegin: the times of a motion block must ascend");
  EXPECT_EQ(failure("MotionBegin [0 1] Translate 0 0 0 MotionEnd"),
            "a.rib:1:35: MotionEnd: the motion block has 2 times but 1 requests");
  EXPECT_EQ(failure("MotionBegin [0 1] Translate 0 0 0 Scale 1 1 1 MotionEnd"),
            "a.rib:1:35: Scale: the requests of a motion block must be the same, here Translate");
  EXPECT_EQ(failure("MotionBegin [0] WorldBegin MotionEnd"),
            "a.rib:1:17: WorldBegin: this request is invalid within a motion block");
  EXPECT_EQ(failure("MotionBegin [0 1]"), "a.rib:1:1: the motion block has no MotionEnd");
  EXPECT_EQ(failure("ObjectBegin 1"), "a.rib:1:1: the object has no ObjectEnd");
  EXPECT_EQ(failure("ObjectBegin 1 ObjectInstance 1 ObjectEnd ObjectInstance 1"),
            "a.rib:1:15: ObjectInstance: an instance within an object");
  EXPECT_EQ(failure("Shutter 1 0"), "a.rib:1:1: Shutter: the shutter closes before it opens");
  EXPECT_EQ(failure("Format 0 5 1"), "a.rib:1:1: Format: a picture is 1 to 65536 pixels wide and high");
  std::string deep;
  for (int i = 0; i < 1001; ++i) deep += "AttributeBegin ";
  EXPECT_NE(failure(deep).find("more than 1000 nested blocks"), std::string::npos);
  RibReadOptions few;
  few.max_points = 3;
  EXPECT_EQ(failure(kHair + kHair, few), "a.rib:2:1: Curves: the file has more than 3 points");
}

TEST(RibReading, ArchivesThatReadThemselvesAreErrors) {
  const Files files;
  files.write("ReadArchive \"b.rib\"", "a.rib");
  files.write("ReadArchive \"a.rib\"", "b.rib");
  EXPECT_NE(error_of([&] {
              read_rib(files.folder.path() / "a.rib", {});
            }).find("b.rib:1:1: ReadArchive: the file reads itself"),
            std::string::npos);
}

TEST(RibReading, ArchivesCannotMultiplyWithoutEnd) {
  const Files files;
  for (char c = 'a'; c < 'h'; ++c) {
    const std::string next = std::string("ReadArchive \"") + static_cast<char>(c + 1) + ".rib\"\n";
    files.write(next + next, std::string(1, c) + ".rib");
  }
  files.write("Color 1 1 1", "h.rib");
  RibReadOptions options;
  options.max_inner_archives = 252;  // 4 + 8 + ... + 128
  EXPECT_EQ(read_rib(files.folder.path() / "a.rib", options).files.size(), 8u);
  options.max_inner_archives = 251;
  EXPECT_NE(error_of([&] {
              read_rib(files.folder.path() / "a.rib", options);
            }).find("g.rib:2:1: ReadArchive: archives read more than 251 archives"),
            std::string::npos);
}

TEST(RibReading, ArchivesAreFoundOnTheSearchPath) {
  const Files files;
  std::filesystem::create_directory(files.folder.path() / "hair");
  write_file(files.folder.path() / "hair" / "b.rib", kHair);
  const RibScene scene = read_rib(
      files.write("Option \"searchpath\" \"string archive\" [\"none:hair:@\"] ReadArchive \"b.rib\""), {});
  EXPECT_EQ(tips(scene).size(), 1u);
  EXPECT_EQ(scene.files.size(), 2u);
}

// A compressed file of a few kilobytes can have arguments of gigabytes, before there are any strands to
// count.
TEST(RibReading, TheArgumentsOfOneRequestAreLimited) {
  constexpr uint32_t kCount = 8'000'000;
  std::string text_array = "[", strings = "[";
  for (int i = 0; i < 1'000'000; ++i) text_array += "0 ", strings += "\"\" ";
  const std::string binary =
      std::string("\xcb") + big_endian(kCount, 4) + std::string(size_t(4) * kCount, '\0');
  std::string parts = "Curves \"linear\"";
  for (int i = 0; i < 8; ++i)
    parts += std::string("\xcb") + big_endian(kCount / 8, 4) + std::string(size_t(kCount) / 2, '\0');
  for (const std::string& file : {"Curves \"linear\" " + binary, "Curves \"linear\" " + text_array + "]",
                                  "Curves \"linear\" " + strings + "]", parts}) {
    const std::string bytes = gzipped(file);
    ASSERT_LT(bytes.size(), 100'000u);
    RibReadOptions options;
    options.max_request_bytes = size_t(4) << 20;
    EXPECT_EQ(failure(bytes, options),
              "a.rib:1:1: Curves: one request may take 4.0 MiB of memory (render.memory)");
    size_t most = 0;
    options = {};
    options.reserve = [&](size_t taken) {
      most = std::max(most, taken);
      if (taken > (size_t(4) << 20)) throw Error(ErrorKind::kMemory, "no room");
    };
    EXPECT_EQ(failure(bytes, options), "another kind: no room");
    EXPECT_LE(most, size_t(8) << 20) << "asked before it is taken, in steps of a factor of two";
  }
  // What fits is read, and the next request has all the room again.
  RibReadOptions options;
  options.max_request_bytes = size_t(4) << 20;
  std::string two;
  for (int i = 0; i < 2; ++i)
    two += "Unknown \xcb" + big_endian(900'000, 4) + std::string(size_t(3'600'000), '\0') + "\n";
  EXPECT_EQ(failure(two, options), "no error");
}

TEST(RibReading, TextBinaryAndCompressedFilesGiveTheSameStrands) {
  const std::vector<float> points{0, 0, 0, .1f, 1, .3f, 1, 2, 3.7f, -4, 5, 6e-3f};
  std::string text = "Basis \"b-spline\" 1 \"b-spline\" 1 Curves \"cubic\" [4] \"nonperiodic\" \"P\" [";
  for (const float x : points) text += std::to_string(x) + " ";
  text += "] \"constantwidth\" [0.25]";
  const std::string binary =
      "\xcc\x01\x96"
      "Curves"
      "Basis \"b-spline\" \x80\x01 \"b-spline\" 1 \xa6\x01\"cubic\" [\x80\x04] "
      "\x9b"
      "nonperiodic"
      "\x91P" +
      binary_floats(points) + "\"constantwidth\"\xa4" + binary_float(.25f);
  const RibScene a = read(text), b = read(binary), c = read(gzipped(binary)), d = read(gzipped(text));
  for (const RibScene* other : {&b, &c, &d}) {
    ASSERT_EQ(other->coats.size(), 1u);
    EXPECT_EQ(a.coats[0].batches[0]->arrays().points, other->coats[0].batches[0]->arrays().points);
  }
}

}  // namespace
}  // namespace pelage::rib_reading_test
