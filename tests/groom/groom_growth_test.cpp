// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "base/temporary_folder.h"
#include "geom/closest_point.h"
#include "geom/io/strand_file.h"
#include "geom/tessellation.h"
#include "groom/groom.h"
#include "tests/groom/operator_harness.h"
#include "tests/groom/scene_text.h"
#include "tests/support/quiet_job.h"

namespace pelage {
namespace {

constexpr const char* kOperators =
    "- length: {value: 0.4, variation: 0.3}\n"
    "- comb: {direction: [0, -1, 0.3], lift: 0.3}\n"
    "- clump: {spacing: 0.3, amount: 0.6}\n"
    "- noise: {amplitude: 0.05, frequency: 2}\n"
    "- push_out: {offset: 0.02}\n"
    "- width: {root: 0.008, tip: 0.001, variation: 0.2}\n"
    "- color: {value: {ramp: {along: strand, knots: [[0, [0, 1, 0]], [1, [1, 0, 0]]]}}, variation: 0.5}\n";

class GrowthStepsTest : public OperatorTest {
 protected:
  std::shared_ptr<const Groom> make(const std::string& keys, const std::string& operators) {
    GroomParams params = scene_text::read<GroomParams>(keys);
    params.operators = scene_text::read<OperatorList>(operators);
    return Groom::create("coat", params, rest_, textures_, QuietJob(2, ledger_));
  }

  /// The last step of some strands is the strand that grow() makes, bit for bit.
  static void expect_grown(const Groom& groom, const PosedSkin& pose, const std::vector<std::string>& names) {
    size_t follicle = 0;
    for (size_t leaf = 0; leaf < groom.follicles().leaves().size(); ++leaf) {
      const Strands grown = groom.grow(leaf, pose);
      for (size_t s = 0; s < grown.strand_count(); ++s, ++follicle) {
        if (s % 37 != 0) continue;
        const std::vector<GrowthStep> steps = groom.grow_steps(follicle, pose);
        ASSERT_EQ(steps.size(), names.size());
        for (size_t i = 0; i < steps.size(); ++i) {
          EXPECT_EQ(steps[i].name, names[i]);
          EXPECT_EQ(steps[i].strand.id(0), grown.id(s));
        }
        Strands wanted;
        wanted.assign_strand(grown, s);
        const auto all = [](const Strands& strand) {
          const std::span<const float> points = strand.points().first(4 * strand.point_count());
          std::vector<float> values(points.begin(), points.end());
          if (const StrandAttribute* color = strand.find_attribute("color"))
            values.insert(values.end(), color->values.begin(), color->values.end());
          return values;
        };
        EXPECT_EQ(all(steps.back().strand), all(wanted));
      }
    }
  }
};

TEST_F(GrowthStepsTest, TheLastStepIsTheGrownStrand) {
  const auto groom = make("skin: ball\nstrands: 600\nleaf_strands: 100", kOperators);
  std::vector<V3f> positions = shapes::ball_cage(1.2f).positions;
  for (V3f& p : positions) p = V3f(1.5f * p.x + 0.3f * p.y, 1.5f * p.y, 1.5f * p.z + 2);
  const LimitSurface pose(rest_->shared_topology(), positions);
  View view;
  view.focal_pixels = 1e9f;
  const SkinMesh mesh = tessellate(std::span(&pose, 1), view, {4, 8}, workers_);
  const ClosestPointTree tree(mesh, 0);
  PosedSkin skin;
  skin.keys = std::span(&pose, 1);
  skin.trees = std::span(&tree, 1);
  skin.scale = 1.5f;
  skin.length = 0.7f;
  const std::vector<std::string> names{"follicle", "length",   "comb",  "clump",
                                       "noise",    "push_out", "width", "color"};
  expect_grown(*groom, skin, names);
  // Each operator that moves strands moves this one, and the others do not.
  const std::vector<GrowthStep> steps = groom->grow_steps(0, skin);
  for (size_t i = 1; i < steps.size(); ++i) {
    const std::string& name = steps[i].name;
    const size_t tip = steps[i].strand.point_count() - 1;
    const float moved = (steps[i].strand.point(tip) - steps[i - 1].strand.point(tip)).length();
    if (name == "width" || name == "color") {
      EXPECT_EQ(moved, 0) << name;
    } else if (name != "push_out") {
      EXPECT_GT(moved, 0) << name;
    }
    EXPECT_EQ(steps[i].strand.point(0), steps[0].strand.point(0)) << "roots never move";
  }
}

TEST_F(GrowthStepsTest, StrandsOfAFileBeginAsTheyAre) {
  StrandArrays arrays;
  arrays.basis = CurveBasis::kLinear;
  arrays.first_point = {0, 3, 7};
  arrays.ids = {0, 1};
  for (const float y : {0.0f, 1.0f, 2.0f, 0.0f, 1.0f, 2.0f, 3.0f})
    arrays.points.insert(arrays.points.end(), {y * y, y, 0, 0.01f});
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "two.hair").string();
  write_strands(file, Strands(arrays));
  const auto groom =
      make("strands_file: " + file + "\nattach: none", "- bend: {direction: [1, 0, 0], angle: 30}\n");
  expect_grown(*groom, {}, {"follicle", "bend"});
}

}  // namespace
}  // namespace pelage
