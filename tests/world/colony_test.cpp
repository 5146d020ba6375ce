// SPDX-License-Identifier: Apache-2.0
// What the example colonies show, by their posed skins: no hair is grown.
#include <filesystem>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "procedurals/crowd/crowd_placement.h"
#include "tests/support/effort.h"
#include "tests/support/quiet_job.h"
#include "world/compose.h"
#include "world/frame_characters.h"

namespace pelage {
namespace {

class ColonyTest : public testing::TestWithParam<std::pair<const char*, int64_t>> {
 protected:
  ColonyTest() {
    const auto file = std::filesystem::path(PELAGE_SOURCE_DIR) / "examples" / GetParam().first;
    scene_ = load_scene(file, {{"grooms.under.strands", "10"},
                               {"grooms.guard.strands", "10"},
                               {"grooms.whiskers.strands", "10"},
                               {"grooms.under.cache", "null"},
                               {"grooms.guard.cache", "null"},
                               {"grooms.whiskers.cache", "null"},
                               {"camera.shutter", "[0, 0]"}});
    assets_ = load_assets(scene_, QuietJob(2, ledger_));
  }

  /// Height in pixels of what is in the picture of a skin; 0 where it is too far away to matter.
  static float visible_height(const SkinPart& part, const Camera& camera, const ImageParams& image) {
    const Box3f box = part.skin->bound({}, BoundSpan::kShutter);
    if (camera.view().pixels_per_unit(box.center()) * box.size().length() < 100) return 0;
    const SkinMesh mesh = part.skin->tessellate({}, camera.view());
    float low = std::numeric_limits<float>::infinity(), high = -low;
    for (size_t i = 0; i < mesh.vertex_count(); ++i) {
      const auto at = camera.project(mesh.position(i), 0);
      if (!at || at->x < 0 || at->x > static_cast<float>(image.width)) continue;
      low = std::min(low, std::clamp(at->y, 0.0f, static_cast<float>(image.height)));
      high = std::max(high, std::clamp(at->y, 0.0f, static_cast<float>(image.height)));
    }
    return std::max(0.0f, high - low);
  }

  Workers workers_{2};
  MemoryLedger ledger_;
  SceneDescription scene_;
  std::unique_ptr<Assets> assets_;
};

TEST_P(ColonyTest, IsInTheFrameAndTallInFront) {
  const World world = compose(scene_, *assets_, 1, QuietJob(2, ledger_));
  const int64_t rats = GetParam().second;
  std::vector<float> heights;
  for (const SkinPart& part : world.scene.skins) {
    if (!part.name.ends_with(".rat")) continue;
    heights.push_back(visible_height(part, world.scene.camera, scene_.image));
  }
  EXPECT_GE(world.counts.characters_in_frame, rats * 9 / 10);
  std::sort(heights.rbegin(), heights.rend());
  if (rats >= 100) {
    EXPECT_EQ(scene_.image.height, 720);
    EXPECT_GT(heights.at(9), 200);
  }
}

TEST_P(ColonyTest, NoRatStandsInAnother) {
  std::vector<PlacedFootprint> rats;
  for (size_t crowd = 0; crowd < assets_->crowds.size(); ++crowd) {
    for (const CrowdMember& member : assets_->crowds[crowd]) {
      const NameReference& of = scene_.crowds.items[crowd].value.of[member.prototype];
      rats.push_back(placed_footprint(member, scene_.characters.find(of.name)->value.footprint));
    }
  }
  ASSERT_EQ(static_cast<int64_t>(rats.size()), GetParam().second);
  for (size_t i = 0; i < rats.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      if ((rats[i].place.position - rats[j].place.position).length() > 45) continue;
      EXPECT_GE(footprint_distance(rats[i].footprint, rats[i].place, rats[j].footprint, rats[j].place),
                scene_.crowds.items.back().value.spacing - 1e-3f);
    }
  }
}

// What an animal costs before any hair grows is its posed cages; beside these there are a few poses at a
// time.
TEST_P(ColonyTest, ARatIsItsPosedCages) {
  const int64_t before = ledger_.current(MemoryTag::kSkins);
  scene_.render.lod.enabled = false;  // far coats have a pose of the whole skin in hand
  const World world = compose(scene_, *assets_, 1, QuietJob(2, ledger_));
  const int64_t bytes = ledger_.current(MemoryTag::kSkins) - before, rats = GetParam().second;
  size_t points = 0;
  for (const char* skin : {"rat", "eyes"}) points += assets_->skins.at(skin).cage.positions.size();
  const auto cages = static_cast<int64_t>(points * sizeof(V3f));
  EXPECT_GT(bytes, rats * cages);
  EXPECT_LT(bytes, rats * (cages + 2048) + (1 << 20));
}

// The largest has nothing for a sanitizer that the others lack.
std::vector<std::pair<const char*, int64_t>> colonies() {
  std::vector<std::pair<const char*, int64_t>> all = {{"colony_small.yaml", 25}, {"colony_100.yaml", 100}};
  if (!kSanitized) all.emplace_back("colony.yaml", 1000);
  return all;
}

INSTANTIATE_TEST_SUITE_P(Examples, ColonyTest, testing::ValuesIn(colonies()));

}  // namespace
}  // namespace pelage
