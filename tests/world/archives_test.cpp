// SPDX-License-Identifier: Apache-2.0
#include "world/archives.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "geom/io/strand_file.h"
#include "tests/support/quiet_job.h"
#include "tests/world/small_scene.h"
#include "world/world.h"

namespace pelage {
namespace {

// Strands that a .hair file represents exactly: linear curves with a radius per point.
Strands tuft() {
  StrandArrays a;
  a.basis = CurveBasis::kLinear;
  a.first_point = {0};
  const auto random = [&](uint64_t s, uint64_t use) {
    return unit_float(hash64(s, random_use("tuft"), use));
  };
  for (uint64_t s = 0; s < 500; ++s) {
    const V3f root(2 * random(s, 0) - 1, 0, 2 * random(s, 1) - 1),
        lean(random(s, 2) - .5f, 1, random(s, 3) - .5f);
    for (int i = 0; i < 4; ++i) {
      const V3f p = root + (static_cast<float>(i) / 3) * lean;
      a.points.insert(a.points.end(), {p.x, p.y, p.z, 0.02f - 0.005f * static_cast<float>(i)});
    }
    a.first_point.push_back(static_cast<uint32_t>(4 * s + 4));
    a.ids.push_back(s);
  }
  return Strands(std::move(a));
}

std::string rib_of(const Strands& strands) {
  std::string sizes, points, widths;
  char text[32];
  const auto add = [&](std::string& to, float x) {
    std::snprintf(text, sizeof text, "%.9g ", static_cast<double>(x));
    to += text;
  };
  for (size_t s = 0; s < strands.strand_count(); ++s) sizes += std::to_string(strands.strand_points(s)) + " ";
  for (size_t i = 0; i < strands.point_count(); ++i) {
    for (int axis = 0; axis < 3; ++axis) add(points, strands.point(i)[axis]);
    add(widths, 2 * strands.radius(i));
  }
  return "Curves \"linear\" [" + sizes + "] \"nonperiodic\" \"P\" [" + points + "] \"vertex float width\" [" +
         widths + "]\n";
}

class ArchivesTest : public testing::Test {
 protected:
  struct Frame {
    SceneDescription scene;
    std::unique_ptr<Assets> assets;
    World world;
  };
  // A scene with the given blocks; the camera sees [-1, 1] in x.
  Frame compose_scene(const std::string& blocks, double frame = 1,
                      const std::vector<Override>& overrides = {}) {
    files_.write("s.yaml",
                 "pelage: 1\ncamera: {position: [0, 1, 6], look_at: [0, 0.5, 0], fov: 24}\n"
                 "image: {width: 32, height: 24, filter: box}\n"
                 "materials:\n  hide: {model: lambert, color: 0.4}\n  fur: {model: cone-shell, diffuse: 0.6, "
                 "color: [0.6, "
                 "0.4, 0.2]}\n"
                 "lights: {sky: {type: environment, radiance: 1}, key: {type: sphere, position: [4, 5, 3], "
                 "intensity: 20}}\n"
                 "render: {samples: 16, bounces: 2, lod: {enabled: false}}\n" +
                     blocks);
    SceneDescription scene = load_scene(files_.path("s.yaml"), overrides);
    auto assets = load_assets(scene, QuietJob(2, ledger_));
    World world = compose(scene, *assets, frame, QuietJob(2, ledger_));
    return {std::move(scene), std::move(assets), std::move(world)};
  }
  std::vector<Rgb> picture(const World& world) {
    const FrameResult result = render(world, QuietJob(2, ledger_));
    std::vector<Rgb> pixels;
    for (int y = 0; y < 24; ++y) {
      for (int x = 0; x < 32; ++x) pixels.push_back(result.film.radiance(x, y));
    }
    return pixels;
  }
  // Mean absolute difference over the mean.
  static double difference(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
    double sum = 0, all = 0;
    for (size_t i = 0; i < a.size(); ++i) {
      sum += std::abs(double(luminance(a[i])) - luminance(b[i]));
      all += luminance(a[i]);
    }
    return sum / all;
  }

  SmallScene files_;
  MemoryLedger ledger_;
};

// The same ids, points and samples: only the grid to which coordinates are rounded may differ, so a ray may
// hit another strand here and there.
TEST_F(ArchivesTest, ThePictureIsThatOfTheSameStrandsFromAHairFile) {
  write_strands(files_.path("tuft.hair"), tuft());
  files_.write("tuft.rib", rib_of(tuft()));
  const Frame hair = compose_scene(
      "grooms: {g: {strands_file: tuft.hair, basis: linear, attach: none}}\nskins: {cube: {mesh: cube.obj}}\n"
      "characters: {c: {parts: [{skin: cube, material: hide, grooms: {g: fur}}]}}\n");
  files_.write("cube.rib",
               "ReadArchive \"tuft.rib\"\nPointsPolygons [4 4 4 4 4 4] [0 2 3 1 4 5 7 6 0 1 5 4 2 6 7 3 0 4 "
               "6 2 1 3 7 5] "
               "\"P\" [-.5 -.5 -.5 .5 -.5 -.5 -.5 .5 -.5 .5 .5 -.5 -.5 -.5 .5 .5 -.5 .5 -.5 .5 .5 .5 .5 .5]");
  const Frame rib = compose_scene("archives: {a: {rib: cube.rib, materials: {hair: fur, surface: hide}}}\n");
  ASSERT_EQ(rib.world.scene.fur.size(), 1u);
  ASSERT_EQ(rib.world.scene.skins.size(), 1u);
  EXPECT_EQ(rib.world.scene.fur[0].name, "a.hair");
  EXPECT_EQ(rib.world.counts.strands_described, 500);
  // The cube of the scene is a subdivision surface, that of the file has flat faces: compare the fur alone.
  Frame bare = compose_scene("archives: {a: {rib: tuft.rib, materials: {hair: fur}}}\n");
  World alone = compose(hair.scene, *hair.assets, 1, QuietJob(2, ledger_));
  alone.scene.skins.clear();
  for (FurPart& part : alone.scene.fur) part.skin.reset();
  EXPECT_LT(difference(picture(alone), picture(bare.world)), 0.01);
}

TEST_F(ArchivesTest, DeferralChangesNoPixel) {
  files_.write("tuft.rib", rib_of(tuft()));
  files_.write("late.rib", "Procedural \"DelayedReadArchive\" [\"tuft.rib\"] [-2 2 0 2 -2 2]");
  const Frame now = compose_scene("archives: {a: {rib: tuft.rib, materials: {hair: fur}}}\n");
  const Frame late = compose_scene("archives: {a: {rib: late.rib, materials: {hair: fur}}}\n");
  EXPECT_GT(now.assets->archives.at("a").rib->coats[0].batches.size(), 0u);
  EXPECT_EQ(late.assets->archives.at("a").rib->coats[0].batches.size(), 0u);
  const std::vector<Rgb> expected = picture(now.world);
  EXPECT_EQ(difference(expected, picture(late.world)), 0);
  const Frame tight = compose_scene("archives: {a: {rib: late.rib, materials: {hair: fur}}}\n", 1,
                                    {{"render.memory", "64M"}, {"render.bounds", "exact"}});
  EXPECT_EQ(difference(expected, picture(tight.world)), 0) << "law 1";
}

TEST_F(ArchivesTest, TransformsPlaceAndMoveArchives) {
  files_.write("tuft.rib", rib_of(tuft()));
  const auto box = [](const Frame& f) {
    return f.world.scene.fur[0].procedurals[0]->bound(BoundSpan::kShutter);
  };
  const Box3f still = box(compose_scene("archives: {a: {rib: tuft.rib}}\n"));
  const Box3f moved =
      box(compose_scene("archives: {a: {rib: tuft.rib, transform: {translate: [0, 0, 5], scale: 2}}}\n"));
  EXPECT_NEAR(moved.max.y, 2 * still.max.y, 1e-4);
  EXPECT_NEAR(moved.max.z, 5 + 2 * still.max.z, 1e-4);
  const Frame moving = compose_scene(
      "archives: {a: {rib: tuft.rib, transform: {translate: {keys: {1: [0, 0, 0], 2: [8, 0, 0]}}}}}\n", 1,
      {{"camera.shutter", "[0, 0.5]"}});
  const Strands strands = moving.world.scene.fur[0].procedurals[0]->generate();
  ASSERT_EQ(strands.motion_keys(), 2);
  EXPECT_NEAR(strands.point(0, 1).x - strands.point(0, 0).x, 4, 1e-5);
}

TEST_F(ArchivesTest, SkinsMove) {
  files_.write(
      "a.rib",
      "MotionBegin [0 0.5] PointsPolygons [3] [0 1 2] \"P\" [0 0 0 1 0 0 0 1 0] PointsPolygons [3] [0 1 2] "
      "\"P\" [0 0 3 1 0 3 0 1 3] MotionEnd");
  const Frame f = compose_scene("archives: {a: {rib: a.rib, materials: {surface: hide}}}\n", 1,
                                {{"camera.shutter", "[0, 0.5]"}});
  const auto& skin = *f.world.scene.skins[0].skin;
  const SkinMesh mesh = skin.tessellate(
      skin.divide(f.world.scene.camera.view(), 4096, QuietJob(2, ledger_))[0], f.world.scene.camera.view());
  ASSERT_EQ(mesh.motion_keys, 2);
  EXPECT_EQ(mesh.position(0, 1).z - mesh.position(0, 0).z, 3);
}

TEST_F(ArchivesTest, WrongMaterialsAndLittleMemoryAreErrors) {
  files_.write("tuft.rib", rib_of(tuft()));
  const auto failure = [&](const std::string& blocks, const std::vector<Override>& overrides = {}) {
    try {
      compose_scene(blocks, 1, overrides);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_NE(failure("archives: {a: {rib: tuft.rib, materials: {hair: hide}}}\n")
                .find("'hide' is a material for skins"),
            std::string::npos);
  EXPECT_NE(failure("archives: {a: {rib: tuft.rib, materials: {hair: fru}}}\n").find("did you mean 'fur'"),
            std::string::npos);
  EXPECT_NE(failure("archives: {a: {rib: tuft.rib, materials: {hair: fur}}}\n", {{"render.memory", "10K"}})
                .find("reading archive 'a'"),
            std::string::npos);
}

}  // namespace
}  // namespace pelage
