// SPDX-License-Identifier: Apache-2.0
#include "world/assets.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/file.h"
#include "base/progress.h"
#include "tests/world/small_scene.h"

namespace pelage {
namespace {

/// The assets of the small scene with a second groom, brought up to date after each edit.
class UpdatedAssets : public testing::Test {
 protected:
  UpdatedAssets() {
    edit("materials:", "  fuzz: {skin: still, strands: 30, operators: [{length: {value: 0.2}}]}\nmaterials:");
    update();
  }
  void edit(const std::string& from, const std::string& to) {
    std::string text = read_file(scene_.path("scene.yaml"));
    const size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    scene_.write("scene.yaml", text.replace(at, from.size(), to));
  }
  void update() {
    update_assets(load_scene(scene_.path("scene.yaml")), Job{workers_, ledger_, progress_}, assets_);
  }
  std::shared_ptr<const Groom> groom(const std::string& name) const { return assets_.grooms.at(name); }
  const LimitSurface* skin(const std::string& name) const { return assets_.skins.at(name).rest.get(); }

  SmallScene scene_{true};
  Workers workers_{1};
  MemoryLedger ledger_;
  NoProgress progress_;
  Assets assets_{ledger_, &progress_};
};

TEST_F(UpdatedAssets, AGroomLeavesTheOthers) {
  const auto coat = groom("coat"), fuzz = groom("fuzz");
  const LimitSurface* const cube = skin("cube");
  edit("length: {value: 0.4}", "length: {value: 0.5}");
  update();
  EXPECT_NE(groom("coat"), coat);
  EXPECT_EQ(&groom("coat")->follicles(), &coat->follicles()) << "only an operator changed";
  EXPECT_EQ(groom("fuzz"), fuzz);
  EXPECT_EQ(skin("cube"), cube);

  edit("strands: 400", "strands: 300");
  update();
  EXPECT_EQ(groom("coat")->follicles().size(), 300u);
  EXPECT_EQ(groom("fuzz"), fuzz);
}

TEST_F(UpdatedAssets, ASkinTakesItsGroomsWithIt) {
  const auto coat = groom("coat"), fuzz = groom("fuzz");
  edit("skins:\n", "skins:\n  # a comment\n");
  update();
  EXPECT_EQ(groom("coat"), coat);
  edit("still: {mesh: cube.obj}", "still: {mesh: cube.obj, scheme: none}");
  update();
  EXPECT_EQ(groom("coat"), coat);
  EXPECT_NE(groom("fuzz"), fuzz);

  const auto again = groom("fuzz");
  std::string mesh = read_file(scene_.path("cube.obj"));
  scene_.write("cube.obj", mesh.replace(mesh.find("0.5"), 3, "0.7"));
  update();
  EXPECT_NE(groom("coat"), coat);
  EXPECT_NE(groom("fuzz"), again);
}

TEST_F(UpdatedAssets, AreThoseOfAFreshSceneAfterEachEdit) {
  const auto expect_fresh = [&] {
    MemoryLedger ledger;
    const auto fresh = load_assets(load_scene(scene_.path("scene.yaml")), {workers_, ledger, progress_});
    ASSERT_EQ(assets_.grooms.size(), fresh->grooms.size());
    for (const auto& [name, groom] : fresh->grooms)
      EXPECT_TRUE(assets_.grooms.at(name)->content_hash() == groom->content_hash()) << name;
    ASSERT_EQ(assets_.skins.size(), fresh->skins.size());
    EXPECT_EQ(ledger_.budgeted(), ledger.budgeted()) << "everything old is freed";
  };
  const std::pair<const char*, const char*> edits[] = {
      {"points: 5", "points: 6"},
      {"strands: 30,", "strands: 40,"},
      {"  fuzz: {skin: still", "  down: {skin: still"},
      {"scheme: none", "scheme: catmull-clark"},
      {"  still: {mesh", "  more: {mesh: cube.obj}\n  still: {mesh"},
      {"memory: 1G", "memory: 2G"}};
  edit("still: {mesh: cube.obj}", "still: {mesh: cube.obj, scheme: none}");
  edit("samples: 4", "samples: 4, memory: 1G");
  for (const auto& [from, to] : edits) {
    edit(from, to);
    update();
    expect_fresh();
  }
}

TEST_F(UpdatedAssets, CanBeCalledAgainAfterAnError) {
  const auto coat = groom("coat");
  edit("fuzz: {skin: still, strands: 30",
       "fuzz: {skin: still, strands: 40, density: {map: none.ppm, channel: r}");
  EXPECT_THROW(update(), Error);
  EXPECT_EQ(groom("coat"), coat);
  scene_.write("none.ppm", "P3\n1 1\n255\n90 90 90\n");
  update();
  EXPECT_EQ(groom("coat"), coat);
  EXPECT_EQ(groom("fuzz")->follicles().size(), 40u);
}

TEST_F(UpdatedAssets, AChangedMapIsReadAgain) {
  scene_.write("map.ppm", "P3\n1 1\n255\n90 90 90\n");
  edit("color: 0.4}", "color: {map: map.ppm, space: linear}}");
  edit("length: {value: 0.2}", "length: {value: {map: map.ppm, channel: r}}");
  update();
  const auto coat = groom("coat"), fuzz = groom("fuzz");
  scene_.write("map.ppm", "P3\n1 1\n255\n180 180 180\n");
  update();
  EXPECT_EQ(groom("coat"), coat);
  EXPECT_NE(groom("fuzz"), fuzz);
  const auto& hide = std::get<LambertParams>(assets_.materials.front());
  EXPECT_NEAR(hide.color.color({}).x, 180.0f / 255, 1e-3f);
}

// A table takes 0.16 s. It depends neither on the colour nor on the name of the material.
TEST_F(UpdatedAssets, MaterialsThatDifferInColorShareATable) {
  edit("materials:\n",
       "materials:\n"
       "  a: {model: cone-shell, color: 0.2}\n"
       "  b: {model: cone-shell, color: [0.5, 0.3, 0.1], opacity: 0.5}\n"
       "  c: {model: cone-shell, color: 0.2, primary_width: 20}\n");
  update();
  const auto table = [&](size_t material) {
    return fibre_params(assets_.materials.at(material))->coat_color;
  };
  EXPECT_TRUE(table(0));
  EXPECT_EQ(table(0), table(1));
  EXPECT_NE(table(0), table(2));
}

/// A sheet of 2 n^2 triangles; with `sides` 2, each face is written twice, the second time turned over.
std::string sheet(int n, int sides) {
  std::string text;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j)
      text += "v " + std::to_string(i) + " " + std::to_string(i * j % 3) + " " + std::to_string(j) + "\n";
  }
  const auto face = [&](int a, int b, int c) {
    for (int side = 0; side < sides; ++side)
      text += "f " + std::to_string(a) + " " + std::to_string(side ? c : b) + " " +
              std::to_string(side ? b : c) + "\n";
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 1; j <= n; ++j) {
      const int at = i * (n + 1) + j;
      face(at, at + 1, at + n + 2);
      face(at, at + n + 2, at + n + 1);
    }
  }
  return text;
}

class SheetAssets : public testing::Test {
 protected:
  struct Warnings final : NoProgress {
    void warn(std::string_view line) override { lines.emplace_back(line); }
    std::vector<std::string> lines;
  };

  std::unique_ptr<Assets> load(const std::string& skins, const std::string& memory) {
    files_.write("scene.yaml",
                 "pelage: 1\nskins: " + skins +
                     "\nmaterials: {hide: {model: lambert}}\ncharacters: {a: {parts: [{skin: a, "
                     "material: hide}]}}\nrender: {memory: " +
                     memory + "}\n");
    return load_assets(load_scene(files_.path("scene.yaml")), Job{workers_, ledger_, progress_});
  }

  SmallScene files_;
  Workers workers_{1};
  MemoryLedger ledger_;
  Warnings progress_;
};

TEST_F(SheetAssets, FacesOfBothSidesAreOne) {
  files_.write("a.obj", sheet(4, 2));
  files_.write("pose.0001.obj", sheet(4, 2));
  const auto assets = load("{a: {mesh: a.obj, poses: {files: pose.%04d.obj, count: 1}}}", "1G");
  EXPECT_EQ(assets->skins.at("a").cage.face_count(), 32u);
  EXPECT_EQ(assets->skins.at("a").poses->positions(1).size(), 25u) << "the pose fits the file";
  ASSERT_EQ(progress_.lines.size(), 1u);
  EXPECT_NE(progress_.lines[0].find("left out 32 faces of "), std::string::npos) << progress_.lines[0];
}

/// Each skin fits the limit alone.
TEST_F(SheetAssets, SkinsThatDoNotFitTogetherAreRefusedBeforeTheyAreMade) {
  files_.write("a.obj", sheet(16, 1));
  files_.write("b.obj", sheet(15, 1));
  load("{a: {mesh: a.obj}}", "24M");
  load("{a: {mesh: b.obj}}", "24M");
  EXPECT_EQ(ledger_.budgeted(), 0);
  try {
    load("{a: {mesh: a.obj}, b: {mesh: b.obj}}", "24M");
    ADD_FAILURE() << "two skins fit";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kMemory);
    EXPECT_NE(std::string(error.what()).find("skin 'b'"), std::string::npos) << error.what();
  }
  EXPECT_LE(ledger_.peak(MemoryTag::kSkins), 24 << 20);
}

}  // namespace
}  // namespace pelage
