// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "geom/io/obj_file.h"
#include "geom/io/strand_file.h"
#include "groom/groom.h"
#include "image/texture_library.h"
#include "tests/groom/scene_text.h"
#include "tests/support/data.h"
#include "tests/support/quiet_job.h"

// 228 guides of a production groom, interpolated, beside the full groom of 11,400 strands made from them by
// others.

namespace pelage {
namespace {

/// What a coat looks like from afar.
struct Portrait {
  std::map<std::array<int, 3>, double> density;    // roots by cell of space
  std::map<std::array<int, 3>, double> direction;  // root to tip, by cell of the unit sphere
  std::map<std::array<int, 3>, double> length;
  double mean_length = 0;

  void add(const Strands& strands, size_t strand, double weight) {
    const size_t first = strands.first_point(strand), count = strands.strand_points(strand);
    const V3f root = strands.point(first), tip = strands.point(first + count - 1);
    float arc = 0;
    for (size_t p = 1; p < count; ++p)
      arc += (strands.point(first + p) - strands.point(first + p - 1)).length();
    const V3f way = (tip - root).normalized();
    const auto cell = [](float x, float size) { return static_cast<int>(std::floor(x / size)); };
    density[{cell(root.x, 0.03f), cell(root.y, 0.03f), cell(root.z, 0.03f)}] += weight;
    direction[{cell(way.x, 0.4f), cell(way.y, 0.4f), cell(way.z, 0.4f)}] += weight;
    length[{cell(arc, 0.03f), 0, 0}] += weight;
    mean_length += weight * arc;
  }
};

Portrait portrait_of(const Strands& strands, size_t begin = 0, size_t step = 1) {
  Portrait result;
  const double weight = 1.0 / static_cast<double>((strands.strand_count() - begin + step - 1) / step);
  for (size_t s = begin; s < strands.strand_count(); s += step) result.add(strands, s, weight);
  return result;
}

/// Part of the strands that would have to change cells to make one histogram the other: 0 equal, 1 apart.
double difference(const std::map<std::array<int, 3>, double>& a,
                  const std::map<std::array<int, 3>, double>& b) {
  double sum = 0;
  for (const auto& [cell, weight] : a) {
    const auto found = b.find(cell);
    sum += std::fabs(weight - (found == b.end() ? 0.0 : found->second));
  }
  for (const auto& [cell, weight] : b) sum += a.count(cell) ? 0.0 : weight;
  return 0.5 * sum;
}

class SintelTest : public testing::Test {
 protected:
  Portrait grow(const std::string& spread, const std::string& length) {
    const ControlMesh bust = read_obj(data_folder() / "mesh/sintel_bust.obj");
    const auto topology = SurfaceTopology::create(bust, SubdivisionScheme::kBilinear,
                                                  BoundaryRule::kEdgeAndCorner, "sintel_bust.obj");
    const auto rest = std::make_shared<const LimitSurface>(topology, bust.positions);
    GroomParams params =
        scene_text::read<GroomParams>("skin: bust\nstrands: 11400\npoints: 16\nleaf_strands: 20000");
    params.operators = scene_text::read<OperatorList>(
        "- guides: {file: " + (data_folder() / "tfx/sintel_hair_emit.002.tfx").string() +
        ", scale: 0.01, translate: [0.0002, 1.1984, 0.0002]" + spread + "}\n" + length);
    MemoryLedger ledger;
    TextureLibrary textures(ledger);
    const auto groom = Groom::create("hair", params, rest, textures, QuietJob(2, ledger));
    const Strands strands = groom->grow(0, {{rest.get(), 1}, {}, 1, {}});
    EXPECT_EQ(strands.strand_count(), 11400u);
    return portrait_of(strands);
  }
};

TEST_F(SintelTest, InterpolatedGuidesLookLikeTheRealGroom) {
  PELAGE_REQUIRE_DATA();
  const Strands real = read_strands(data_folder() / "tfx/SintelHairOriginal.16points.tfx").strands;
  ASSERT_EQ(real.strand_count(), 11400u);
  const Portrait wanted = portrait_of(real);
  // The artist's strands are shorter than their guides: half of them by more than 0.7, evenly down to a half.
  const std::string shorter = "- length: {scale: 0.95, variation: 0.5}\n";
  const Portrait grown = grow(", growth_radius: 0.03", shorter);
  // Two halves of the real groom differ by 0.077, 0.029 and 0.013; a coat all over the bust by 0.73, 0.54 and
  // 0.77.
  EXPECT_LT(difference(grown.density, wanted.density), 0.22);
  EXPECT_LT(difference(grown.direction, wanted.direction), 0.16);
  EXPECT_LT(difference(grown.length, wanted.length), 0.09);
  EXPECT_NEAR(grown.mean_length / wanted.mean_length, 1.0, 0.07);
}

}  // namespace
}  // namespace pelage
