// SPDX-License-Identifier: Apache-2.0 The fraction of a flat skin that a combed coat covers, seen from above,
// in full and in reduced detail.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "base/parallel.h"
#include "image/texture_library.h"
#include "procedurals/detail/coat_stats.h"
#include "procedurals/fur.h"
#include "tests/groom/shapes.h"
#include "tests/groom/stacks.h"
#include "tests/support/quiet_job.h"

namespace pelage {
namespace {

class FlatTuft : public testing::Test {
 protected:
  FlatTuft() : textures_(ledger_), workers_(2) {
    const ControlMesh cage = shapes::square_cage(4);
    const auto rest = shapes::surface_of(cage);
    GroomParams params;
    params.skin.name = "square";
    params.strands = 160000;
    params.points = 4;
    stacks::add<Length>(params.operators, {.value = Field(0.05f), .scale = Field(1.0f), .variation = 0});
    stacks::add<Comb>(
        params.operators,
        {.direction = Field(Rgb(1, 0, 0)), .lift = Field(0.05f), .amount = Field(1.0f), .curve = 0});
    stacks::add<Width>(params.operators,
                       {.root = Field(0.00015f), .tip = Field(0.00015f), .profile = 1, .variation = 0});
    groom_ = Groom::create("tuft", params, rest, textures_, QuietJob(2, ledger_));
    stats_ = coat_stats(*groom_, rest.get(), workers_);
    CharacterPose pose;
    pose.topology = rest->shared_topology();
    pose.shutter.cages.push_back(cage.positions);
    pose.shutter.transforms.emplace_back();
    skin_ = std::make_shared<PosedCharacterSkin>(std::move(pose), std::make_shared<PoseCache>(2, ledger_));
  }

  /// The part of the middle of the square that strands lie over; a share of 1 is full detail.
  double coverage(float share) {
    std::optional<Simplification> lod;
    if (share < 1) {
      SimplificationParams params;
      params.min_share = share;
      LodView view;
      view.open.position = view.close.position = V3f(0.5f, 0.5f, 1e6f);
      lod.emplace(params, view, stats_, 1.0f);
    }
    const FurProcedural fur(groom_, skin_, lod);
    Lines lines;
    for (const auto& chunk : fur.split()) lines.add(chunk->generate());
    strands_ = lines.all.size();
    const int points = 60000;
    int covered = 0;
    for (uint64_t i = 0; i < points; ++i) {
      covered +=
          lines.cover({0.1f + 0.8f * unit_float(hash64(i, 1)), 0.1f + 0.8f * unit_float(hash64(i, 2))});
    }
    return static_cast<double>(covered) / points;
  }

  size_t strands_ = 0;

 private:
  /// Straight strands from above, along x, by rows.
  struct Lines {
    struct Line {
      float begin, end, y, radius;
    };
    static constexpr int kRows = 200;
    std::vector<Line> all, rows[kRows];

    void add(const Strands& strands) {
      for (size_t s = 0; s < strands.strand_count(); ++s) {
        const size_t first = strands.first_point(s), last = first + strands.strand_points(s) - 1;
        const Line line{strands.point(first).x, strands.point(last).x, strands.point(first).y,
                        strands.radius(first)};
        all.push_back(line);
        const auto row = [](float y) { return std::clamp(static_cast<int>(y * kRows), 0, kRows - 1); };
        for (int r = row(line.y - line.radius); r <= row(line.y + line.radius); ++r) rows[r].push_back(line);
      }
    }
    bool cover(const V2f& p) const {
      const auto& row = rows[static_cast<int>(p.y * kRows)];
      return std::any_of(row.begin(), row.end(), [&](const Line& line) {
        return p.x >= line.begin && p.x <= line.end && std::abs(p.y - line.y) <= line.radius;
      });
    }
  };

  MemoryLedger ledger_;
  TextureLibrary textures_;
  Workers workers_;
  std::shared_ptr<const Groom> groom_;
  CoatStats stats_;
  std::shared_ptr<const PosedCharacterSkin> skin_;
};

TEST_F(FlatTuft, CoversAsMuchAsBefore) {
  const double full = coverage(1);
  EXPECT_EQ(strands_, 160000u);
  EXPECT_GT(full, 0.5);
  EXPECT_LT(full, 0.9);
  for (const float share : {0.5f, 0.25f, 0.1f}) {
    EXPECT_NEAR(coverage(share), full, 0.01 * full) << share;
    EXPECT_NEAR(static_cast<double>(strands_), share * 160000, 0.3 * share * 160000);
  }
  EXPECT_NEAR(coverage(0.03f), full, 0.02 * full);
}

}  // namespace
}  // namespace pelage
