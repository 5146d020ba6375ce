// SPDX-License-Identifier: Apache-2.0
#include "render/path/frame_chunks.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "cli/compose.h"
#include "tests/cli/small_scene.h"
#include "tests/support/allocation_meter.h"

namespace pelage {
namespace {

// A bumpy sheet that replaces the cube.
std::string sheet(int side, float x) {
  std::string text;
  for (int i = 0; i <= side; ++i) {
    for (int j = 0; j <= side; ++j) {
      const float u = static_cast<float>(i) / static_cast<float>(side) - 0.5f;
      const float v = static_cast<float>(j) / static_cast<float>(side) - 0.5f;
      text += "v " + std::to_string(x + u) + " " + std::to_string(v) + " " +
              std::to_string(0.1f * std::sin(20 * u) * std::cos(17 * v)) + "\n";
    }
  }
  for (int i = 0; i < side; ++i) {
    for (int j = 1; j <= side; ++j) {
      const int a = i * (side + 1) + j, b = a + side + 1;
      text += "f " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(b + 1) + " " +
              std::to_string(a + 1) + "\n";
    }
  }
  return text;
}

class FrameChunksTest : public testing::Test {
 protected:
  FrameChunksTest() {
    files_.write("cube.obj", sheet(60, 0));
    for (int pose = 1; pose <= 3; ++pose)
      files_.write("cube.000" + std::to_string(pose) + ".obj", sheet(60, static_cast<float>(pose)));
  }

  World compose_frame(const std::vector<Override>& overrides) {
    description_ = load_scene(files_.path("scene.yaml"), overrides);
    assets_ = load_assets(description_, workers_, ledger_);
    return compose(description_, *assets_, 1, workers_, ledger_);
  }

  SmallScene files_;
  Workers workers_{1};
  MemoryLedger ledger_;
  SceneDescription description_;
  std::unique_ptr<Assets> assets_;
};

TEST_F(FrameChunksTest, SmallBudgetsDivideSkins) {
  const World world = compose_frame({{"render.memory", "64M"}, {"grooms.coat.leaf_strands", "100"}});
  const FrameChunks chunks(world.scene, workers_, ledger_);
  const size_t leaves = chunks.leaves().size();
  EXPECT_GE(leaves, 4u);
  EXPECT_GE(chunks.size(), leaves + 2 * 3) << "two skins, each in pieces";
  size_t triangles[2] = {};
  for (auto chunk = static_cast<uint32_t>(leaves); chunk < chunks.size(); ++chunk) {
    const ChunkContents contents = chunks.grow(chunk);
    const auto& mesh = std::get<SkinMesh>(contents.geometry);
    const ChunkCounts counts = chunks.counts(chunk);
    EXPECT_EQ(mesh.triangle_count(), counts.triangles);
    EXPECT_EQ(mesh.vertex_count(), counts.vertices);
    EXPECT_EQ(chunks.name(chunk), world.scene.skins[contents.part].name);
    triangles[contents.part] += counts.triangles;
  }
  for (size_t skin = 0; skin < 2; ++skin) {
    const SkinMesh whole = world.scene.skins[skin].skin->tessellate({}, world.scene.camera.view());
    EXPECT_EQ(triangles[skin], whole.triangle_count());
  }
  EXPECT_EQ(chunks.name(0), "walker.coat");

  const World roomy = compose_frame({{"render.memory", "16G"}});
  EXPECT_EQ(FrameChunks(roomy.scene, workers_, ledger_).size(), 1u + 2u);
}

// What growing takes is reserved before: the heap is never asked for more.
TEST_F(FrameChunksTest, GrowthBytesHoldWhatIsAllocated) {
  for (const char* push_out : {"push_out: {}", "frizz: {amplitude: 0.02, frequency: 3}"}) {
    const World world =
        compose_frame({{"render.memory", "64M"},
                       {"grooms.coat.leaf_strands", "100"},
                       {"grooms.coat.operators",
                        std::string("[{length: {value: 0.4}}, {") + push_out + "}, {width: {root: 0.02}}]"}});
    const FrameChunks chunks(world.scene, workers_, ledger_);
    for (uint32_t chunk = 0; chunk < chunks.size(); ++chunk) {
      const ChunkCounts counts = chunks.counts(chunk);
      const size_t before = live_bytes();
      reset_peak();
      const ChunkContents contents = chunks.grow(chunk);
      const size_t peak = peak_bytes() - before, kept = live_bytes() - before;
      EXPECT_LE(peak, kept + counts.growth_bytes) << chunks.name(chunk) << " " << chunk << ", " << push_out;
    }
  }
}

// What describes chunks is charged as what it is: seen by what more of them take, because a pose that
// dividing skins leaves behind for others is charged with the skins.
TEST_F(FrameChunksTest, BytesAreThoseOfTheHeap) {
  const auto measure = [&](const char* leaf_strands) {
    const World world =
        compose_frame({{"grooms.coat.strands", "40000"}, {"grooms.coat.leaf_strands", leaf_strands}});
    const size_t before = live_bytes();
    const FrameChunks chunks(world.scene, workers_, ledger_);
    return std::pair(static_cast<double>(chunks.bytes()), static_cast<double>(live_bytes() - before));
  };
  const auto [few_said, few_taken] = measure("40");
  const auto [many_said, many_taken] = measure("10");
  EXPECT_NEAR((many_said - few_said) / (many_taken - few_taken), 1.0, 0.25);
}

}  // namespace
}  // namespace pelage
