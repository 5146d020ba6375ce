// SPDX-License-Identifier: Apache-2.0
#include "rib/host/scene_rib.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include "base/file.h"
#include "render/frame/rest_place.h"
#include "tests/rib/syntax/rib_tokens.h"
#include "tests/world/furry_scene.h"
#include "tests/world/small_scene.h"
#include "world/world.h"

namespace pelage {
namespace {

/// The text of a file, decompressed if it is compressed.
std::string file_text(const std::filesystem::path& path) {
  std::string text;
  gzFile file = gzopen(path.c_str(), "rb");
  char buffer[4096];
  for (int count = 0; (count = gzread(file, buffer, sizeof(buffer))) > 0;)
    text.append(buffer, static_cast<size_t>(count));
  EXPECT_EQ(gzclose(file), Z_OK) << path;
  return text;
}

std::vector<RibRequest> file_requests(const std::filesystem::path& path) {
  return rib_requests(file_text(path));
}

class SceneRib : public testing::Test {
 protected:
  std::vector<std::filesystem::path> write(const std::string& name, const SceneRibOptions& options,
                                           const std::vector<Override>& overrides = {}) {
    QuietJob job;
    const SceneDescription scene = load_scene(files_.scene(), overrides);
    const auto assets = load_assets(scene, job);
    return write_scene_rib(files_.path(name), {files_.scene(), overrides, scene, *assets}, options, job);
  }
  std::vector<RibRequest> requests(const SceneRibOptions& options,
                                   const std::vector<Override>& overrides = {}) {
    return file_requests(write("a.rib", options, overrides).at(0));
  }
  static const RibRequest& find(const std::vector<RibRequest>& requests, const std::string& name) {
    for (const RibRequest& request : requests) {
      if (request.name == name) return request;
    }
    throw std::runtime_error("no " + name);
  }
  /// Ids of all Curves, with their points at the first key.
  static std::set<uint64_t> ids(const std::vector<RibRequest>& requests) {
    std::set<uint64_t> found;
    for (const RibRequest& request : requests) {
      if (request.name != "Curves") continue;
      for (const double id : request.parameter("uniform integer id").numbers)
        found.insert(static_cast<uint64_t>(id));
    }
    return found;
  }
  /// Fields of materials, such as noise, see the places at rest that they see in the scene itself.
  void expect_places_at_rest(const FurPart& read, const std::vector<Override>& overrides) {
    QuietJob job;
    const SceneDescription scene = load_scene(files_.scene(), overrides);
    const auto assets = load_assets(scene, job);
    const World world = compose(scene, *assets, 1, job);
    const bool first = read.name == "back.walker.coat";
    std::map<uint64_t, V3f> expected;
    visit_strands(world.scene.fur[first ? 0 : 1],
                  [&](uint64_t id, const V3f& place) { expected[id] = place; });
    // The still character has the positions of its roots, which are rounded.
    visit_strands(read, [&](uint64_t id, const V3f& place) {
      for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(place[axis], expected.at(id)[axis], 1e-6) << id;
    });
  }
  static void visit_strands(const FurPart& part, const std::function<void(uint64_t, const V3f&)>& visit) {
    for (const auto& procedural : part.procedurals) {
      for (const auto& leaf : procedural->split()) {
        const Strands strands = leaf->generate();
        Strands one;
        for (size_t s = 0; s < strands.strand_count(); ++s) {
          one.assign_strand(strands, s);
          visit(strands.id(s), rest_place(part, one).position);
        }
      }
    }
  }
  const FurryScene files_;
};

TEST_F(SceneRib, CameraProjectsLikeThePicture) {
  const auto rib = requests({}, {{"camera.lens", "{f_stop: 4, focal_length: 5, focus_distance: 7}"}});
  EXPECT_EQ(find(rib, "Format").arguments[0].numbers[0], 48);
  EXPECT_EQ(find(rib, "Format").arguments[1].numbers[0], 32);
  EXPECT_EQ(find(rib, "Display").arguments[0].texts[0], "a.exr");
  EXPECT_EQ(find(rib, "Quantize").arguments[1].numbers[0], 0) << "floats";
  EXPECT_EQ(find(rib, "Shutter").arguments[0].numbers[0], -0.25);
  EXPECT_EQ(find(rib, "DepthOfField").arguments[2].numbers[0], 7);
  EXPECT_EQ(
      find(rib, "PixelSamples").arguments[0].numbers[0] * find(rib, "PixelSamples").arguments[1].numbers[0],
      6);
  M44f matrix;
  const auto& numbers = find(rib, "ConcatTransform").arguments[0].numbers;
  for (int i = 0; i < 16; ++i) (&matrix[0][0])[i] = static_cast<float>(numbers[static_cast<size_t>(i)]);
  const auto fov = find(rib, "Projection").parameter("float fov").numbers[0] * M_PI / 180;
  QuietJob job;
  const SceneDescription scene = load_scene(files_.scene());
  const Camera camera(scene.camera, 1, 48, 32);
  for (const V3f& world : {V3f(0), V3f(1, 2, 3), V3f(-1, 0.5f, 2)}) {
    V3f local = world * matrix;
    const double scale = 1 / std::tan(fov / 2) / static_cast<double>(local.z);  // to the screen window
    const V3f expected = *camera.project(world, 0);
    EXPECT_NEAR((static_cast<double>(local.x) * scale / 1.5 + 1) * 24, expected.x, 1e-3);
    EXPECT_NEAR((1 - static_cast<double>(local.y) * scale) * 16, expected.y, 1e-3);
    EXPECT_GT(local.z, find(rib, "Clipping").arguments[0].numbers[0]);
    EXPECT_LT(local.z, find(rib, "Clipping").arguments[1].numbers[0]);
  }
}

// Renderers that read a floating-point 0 as something else quantise the picture to 0 .. 255.
TEST_F(SceneRib, BinaryQuantizeHasIntegers) {
  const std::string text =
      file_text(write("q.rib", {{RibEncoding::kBinary, false}, RibCoats::kProcedurals, false}).at(0));
  const std::string rgba = std::string("\x94") + "rgba";
  const size_t quantize = text.find("Quantize");
  ASSERT_NE(quantize, std::string::npos);
  const size_t at = text.find(rgba, quantize) + rgba.size();
  EXPECT_EQ(text.substr(at, 6), std::string("\x80\0\x80\0\x80\0", 6));
}

TEST_F(SceneRib, OrthographicCamerasHaveTheirWindow) {
  const auto rib = requests({}, {{"camera.orthographic", "6"}});
  EXPECT_EQ(find(rib, "Projection").arguments[0].texts[0], "orthographic");
  EXPECT_EQ(find(rib, "ScreenWindow").arguments[1].numbers[0], 4.5) << "48 x 32 pixels";
  EXPECT_EQ(find(rib, "ScreenWindow").arguments[3].numbers[0], 3);
}

TEST_F(SceneRib, PhotographicCamerasAreWrittenInTheTermsOfRi) {
  const auto rib = requests({}, {{"camera.fov", "null"},
                                 {"camera.lens", "null"},
                                 {"camera.focal_length", "50"},
                                 {"camera.f_stop", "2"},
                                 {"camera.shift", "[0.5, -0.25]"},
                                 {"camera.exposure", "3"}});
  EXPECT_NEAR(find(rib, "Projection").parameter("float fov").numbers[0],
              2 * std::atan(12 / 50.0) * 180 / M_PI, 1e-3);
  EXPECT_NEAR(find(rib, "DepthOfField").arguments[1].numbers[0], 5, 1e-5) << "centimetres";
  EXPECT_EQ(find(rib, "ScreenWindow").arguments[0].numbers[0], 0);
  EXPECT_EQ(find(rib, "ScreenWindow").arguments[2].numbers[0], -1.5);
  EXPECT_EQ(find(rib, "Exposure").arguments[0].numbers[0], 8);
}

TEST_F(SceneRib, MovingCameraIsAMotionBlock) {
  const auto rib = requests({}, {{"camera.position", "{keys: {0: [3, 2, 8], 2: [4, 2, 8]}}"}});
  size_t at = 0;
  while (rib[at].name != "MotionBegin") ++at;
  EXPECT_EQ(rib[at].arguments[0].numbers, (std::vector<double>{-0.25, 0, 0.25}));
  for (size_t key = 1; key <= 3; ++key) EXPECT_EQ(rib[at + key].name, "ConcatTransform");
  EXPECT_EQ(rib[at + 4].name, "MotionEnd");
}

TEST_F(SceneRib, MaterialsAndLightsAreParametrised) {
  const auto rib = requests({});
  std::vector<const RibRequest*> surfaces;
  for (const RibRequest& request : rib) {
    if (request.name == "Surface") surfaces.push_back(&request);
  }
  ASSERT_EQ(surfaces.size(), 4u);
  EXPECT_EQ(surfaces[0]->arguments[0].texts[0], "pelage_skin");
  EXPECT_EQ(surfaces[0]->parameter("color color").numbers.size(), 3u);
  EXPECT_EQ(surfaces[2]->arguments[0].texts[0], "pelage_fur");
  EXPECT_EQ(surfaces[2]->parameter("string name").texts[0], "fur");
  EXPECT_EQ(surfaces[2]->parameter("string model").texts[0], "cone-shell");
  EXPECT_EQ(static_cast<float>(surfaces[2]->parameter("float diffuse").numbers[0]), 0.7f);
  EXPECT_EQ(surfaces[2]->parameter("string pelage").texts[0],
            "{model: cone-shell, color: {attribute: color}, diffuse: 0.7, primary: [0.1, 0.2, 0.3]}");
  EXPECT_EQ(find(rib, "AreaLightSource").parameter("float intensity").numbers, std::vector<double>{3});
  const auto& p = find(rib, "Polygon").parameter("P").numbers;
  const auto corner = [&](size_t i) { return V3d(p[3 * i], p[3 * i + 1], p[3 * i + 2]); };
  const V3d x = corner(1) - corner(0), y = corner(3) - corner(0);
  EXPECT_NEAR(x.length(), 2, 1e-5);
  EXPECT_NEAR(y.length(), 1, 1e-5);
  EXPECT_GT(x.cross(y).dot(V3d(-5, -8, -5)), 0);  // towards look_at
  EXPECT_EQ(find(rib, "Sphere").arguments[0].numbers[0], 0.5);
  EXPECT_EQ(find(rib, "LightSource").parameter("string pelage").texts[0],
            "{type: environment, radiance: 0.3}");
}

TEST_F(SceneRib, SkinsWithoutAConstantColorHaveTheirMean) {
  const auto rib =
      requests({}, {{"materials.hide.color", "{ramp: {along: y, knots: [[-0.5, 0.2], [0.5, 0.6]]}}"}});
  const std::vector<double>& color = find(rib, "Color").arguments[0].numbers;
  ASSERT_EQ(color.size(), 3u);
  for (const double channel : color) EXPECT_NEAR(channel, 0.4, 1e-6);  // the cube is symmetric
}

TEST_F(SceneRib, BlocksOfThePictureTravelAsOptions) {
  const auto rib = requests({}, {{"image.width", "20"}});
  std::string image, render;
  for (const RibRequest& request : rib) {
    if (request.name != "Option") continue;
    if (request.has("string image")) image = request.parameter("string image").texts[0];
    if (request.has("string render")) render = request.parameter("string render").texts[0];
  }
  EXPECT_EQ(image, "{width: 20, height: 32}");
  EXPECT_EQ(render, "{samples: 6, bounces: 2, lod: {enabled: false}}");
}

TEST_F(SceneRib, ProceduralsNameTheSceneAndTheirBoxes) {
  const auto rib = requests({}, {{"render.lod.enabled", "true"}, {"frames", "2"}});
  std::vector<const RibRequest*> procedurals;
  for (const RibRequest& request : rib) {
    if (request.name == "Procedural") procedurals.push_back(&request);
  }
  ASSERT_EQ(procedurals.size(), 2u);
  EXPECT_EQ(procedurals[0]->arguments[0].texts[0], "DynamicLoad");
  EXPECT_EQ(procedurals[0]->arguments[1].texts[0], "libpelage_ri.so");
  EXPECT_EQ(procedurals[0]->arguments[1].texts[1],
            files_.scene() + " frame=2 character=walker coat=coat camera=scene set=render.lod.enabled=true");
  const auto& bound = procedurals[0]->arguments[2].numbers;
  Box3f box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = static_cast<float>(bound[static_cast<size_t>(2 * axis)]);
    box.max[axis] = static_cast<float>(bound[static_cast<size_t>(2 * axis + 1)]);
  }
  for (const auto& [id, strand] :
       picture_strands(files_.scene(), "walker.coat", 2, {{"render.lod.enabled", "true"}})) {
    EXPECT_TRUE(box.intersects(V3f(strand.points[0], strand.points[1], strand.points[2]))) << id;
  }
  EXPECT_LT(box.size().x, 6);
}

// Every way of writing coats gives Pelage the strands, skins and counts of the scene itself.
TEST_F(SceneRib, PelageReadsTheSceneBack) {
  const std::vector<Override> far{{"render.lod.enabled", "true"}, {"camera.position", "[30, 20, 80]"}};
  QuietJob job;
  for (const bool lod : {false, true}) {
    const std::vector<Override> overrides = lod ? far : std::vector<Override>();
    for (const RibCoats coats : {RibCoats::kProcedurals, RibCoats::kArchives, RibCoats::kExpanded}) {
      const std::filesystem::path file =
          write("back.rib", {{RibEncoding::kBinary, false}, coats, lod}, overrides).at(0);
      const SceneDescription scene = load_scene(file);
      EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front().message;
      const auto assets = load_assets(scene, job);
      const World world = compose(scene, *assets, 1, job);
      ASSERT_EQ(world.scene.fur.size(), 2u);
      ASSERT_EQ(world.scene.skins.size(), 2u);
      for (const FurPart& part : world.scene.fur) {
        StrandsById strands;
        for (const auto& procedural : part.procedurals) {
          for (const auto& leaf : procedural->split()) add_strands(leaf->generate(), strands);
        }
        EXPECT_EQ(strands, picture_strands(files_.scene(), part.name.substr(5), 1, overrides)) << part.name;
        expect_places_at_rest(part, overrides);
        const auto& own = world.scene.skins[part.name == "back.walker.coat" ? 0 : 1];
        if (coats == RibCoats::kProcedurals && lod && part.lod) {
          ASSERT_TRUE(own.lod) << "the skin below a reduced coat is reduced too";
          EXPECT_EQ(own.lod->depth(), part.lod->depth());
        }
        EXPECT_EQ(part.lod.has_value(), coats == RibCoats::kProcedurals && lod);
      }
    }
  }
}

TEST_F(SceneRib, ExpandedAndArchivedCoatsHaveAllStrands) {
  for (const bool gzip : {false, true}) {
    const RibFormat format{gzip ? RibEncoding::kAscii : RibEncoding::kBinary, gzip};
    const auto expanded = file_requests(write("b.rib", {format, RibCoats::kExpanded, false}).at(0));
    EXPECT_EQ(ids(expanded).size(), 900u);
    const auto archived = file_requests(write("c.rib", {format, RibCoats::kArchives, false}).at(0));
    EXPECT_TRUE(ids(archived).empty());
    std::set<uint64_t> found;
    size_t strands = 0;
    for (const RibRequest& request : archived) {
      if (request.name != "Procedural") continue;
      EXPECT_EQ(request.arguments[0].texts[0], "DelayedReadArchive");
      const auto& bound = request.arguments[2].numbers;
      for (const RibRequest& inner : file_requests(files_.path(request.arguments[1].texts[0]))) {
        if (inner.name != "Curves") continue;
        const auto& p = inner.parameter("P").numbers;
        for (size_t i = 3; i + 3 < p.size(); i += 3) {
          // Control points of thin, nearly straight strands stay within a strand's length of the curve's box.
          for (size_t axis = 0; axis < 3; ++axis) {
            EXPECT_GT(p[i + axis], bound[2 * axis] - 1);
            EXPECT_LT(p[i + axis], bound[2 * axis + 1] + 1);
          }
        }
      }
      const auto inner = ids(file_requests(files_.path(request.arguments[1].texts[0])));
      found.insert(inner.begin(), inner.end());
      strands += inner.size();
    }
    EXPECT_EQ(found, ids(expanded));
    EXPECT_EQ(strands, 930u);
  }
}

/// A scene with two characters, each with a coat of its own.
std::string two_coats(const std::string& a, const std::string& coat_a, const std::string& b,
                      const std::string& coat_b) {
  const auto character = [](const std::string& name, const std::string& coat) {
    return "  \"" + name + "\": {parts: [{skin: cube, material: hide, grooms: {\"" + coat + "\": fur}}]}\n";
  };
  const auto groom = [](const std::string& name, int strands) {
    return "  \"" + name + "\": {skin: cube, strands: " + std::to_string(strands) +
           ", points: 4, operators: [{color: {value: 0.5}}]}\n";
  };
  return "include: fur.yaml\ngrooms:\n" + groom(coat_a, 20) + (coat_b == coat_a ? "" : groom(coat_b, 30)) +
         "characters:\n" + character(a, coat_a) + character(b, coat_b);
}

TEST_F(SceneRib, NoNameLeavesTheFolderOrSharesAFile) {
  const std::string far(200, 'x');
  size_t number = 0;
  for (const auto& [a, coat_a, b, coat_b] :
       {std::array<std::string, 4>{"a", "b.c", "a.b", "c"},
        {"../../../outside", "../../../outside", "/outside", "coat/../../../outside"},
        {"..", ".", ".", ".."},
        {far + "1", "c", far + "2", "c"}}) {
    const std::string stem = "names" + std::to_string(++number);
    files_.write(stem + ".yaml", two_coats(a, coat_a, b, coat_b));
    QuietJob job;
    const SceneDescription scene = load_scene(files_.path(stem + ".yaml"));
    const auto assets = load_assets(scene, job);
    const auto file = files_.path(stem + ".rib");
    write_scene_rib(file, {files_.path(stem + ".yaml"), {}, scene, *assets},
                    {{RibEncoding::kAscii, false}, RibCoats::kArchives, false}, job);
    std::set<std::string> archives;
    size_t strands = 0;
    for (const RibRequest& request : file_requests(file)) {
      if (request.name != "Procedural") continue;
      const std::string& name = request.arguments[1].texts[0];
      EXPECT_TRUE(archives.insert(name).second) << name;
      EXPECT_TRUE(name.starts_with(stem + "_hair/") && name.find('/', stem.size() + 6) == std::string::npos)
          << name;
      strands += ids(file_requests(files_.path(name))).size();
    }
    EXPECT_EQ(strands, size_t{900 + 30 + 20 + (coat_a == coat_b ? 20u : 30u)}) << a;
  }
}

TEST_F(SceneRib, FollowsNoLinkBesideTheFile) {
  std::filesystem::create_directory(files_.path("elsewhere"));
  std::filesystem::create_directory_symlink("elsewhere", files_.path("g_hair"));
  const SceneRibOptions archives{{RibEncoding::kAscii, false}, RibCoats::kArchives, false};
  EXPECT_THROW(write("g.rib", archives), Error);
  EXPECT_TRUE(std::filesystem::is_empty(files_.path("elsewhere")));
  std::filesystem::create_directory(files_.path("h_hair"));
  files_.write("precious", "precious");
  std::filesystem::create_symlink("../precious", files_.path("h_hair/walker.coat.1.0.rib"));
  write("h.rib", archives);
  EXPECT_EQ(read_file(files_.path("precious")), "precious");
  EXPECT_FALSE(std::filesystem::is_symlink(files_.path("h_hair/walker.coat.1.0.rib")));
}

TEST_F(SceneRib, OneFileOrOneFilePerFrame) {
  const std::vector<Override> frames{{"frames", "'1-3'"}};
  const auto one = write("d.rib", {}, frames);
  ASSERT_EQ(one.size(), 1u);
  std::vector<double> numbers;
  for (const RibRequest& request : file_requests(one[0])) {
    if (request.name == "FrameBegin") numbers.push_back(request.arguments[0].numbers[0]);
  }
  EXPECT_EQ(numbers, (std::vector<double>{1, 2, 3}));
  const auto many = write("e.%04d.rib", {}, frames);
  ASSERT_EQ(many.size(), 3u);
  EXPECT_EQ(many[2].filename(), "e.0003.rib");
  EXPECT_EQ(find(file_requests(many[2]), "FrameBegin").arguments[0].numbers[0], 3);
}

TEST_F(SceneRib, BothEncodingsSayTheSame) {
  const auto ascii =
      file_requests(write("f.rib", {{RibEncoding::kAscii, false}, RibCoats::kExpanded, false}).at(0));
  const auto binary =
      file_requests(write("f.rib", {{RibEncoding::kBinary, false}, RibCoats::kExpanded, false}).at(0));
  ASSERT_EQ(ascii.size(), binary.size());
  for (size_t i = 0; i < ascii.size(); ++i) {
    EXPECT_EQ(ascii[i].name, binary[i].name);
    ASSERT_EQ(ascii[i].arguments.size(), binary[i].arguments.size());
    for (size_t k = 0; k < ascii[i].arguments.size(); ++k) {
      const auto &a = ascii[i].arguments[k], &b = binary[i].arguments[k];
      EXPECT_EQ(a.texts, b.texts);
      ASSERT_EQ(a.numbers.size(), b.numbers.size());
      for (size_t n = 0; n < a.numbers.size(); ++n)
        ASSERT_EQ(static_cast<float>(a.numbers[n]), static_cast<float>(b.numbers[n]));
    }
  }
}

}  // namespace
}  // namespace pelage
