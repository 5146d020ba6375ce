// SPDX-License-Identifier: Apache-2.0
#include "world/file_motion.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/file.h"
#include "geom/io/strand_file.h"
#include "groom/operators/follow.h"
#include "tests/support/quiet_job.h"
#include "tests/world/small_scene.h"
#include "world/guide_poses.h"
#include "world/motion_files.h"

namespace pelage::file_motion_test {
namespace {

constexpr int kGuides = 9;

/// The furry cube that walks, whose guides are read from files.
class FileMotionTest : public testing::Test {
 protected:
  FileMotionTest()
      : scene_(
            load_scene(files_.path("scene.yaml"),
                       {{"grooms.coat.dynamics", "{guides: 9, files: " + files_.path("g.%02d.hair") + "}"}})),
        assets_(load_assets(scene_, job_)),
        coats_(moving_coats(scene_, *assets_)),
        coat_(coats_.at(0)) {}

  static std::string name(int frame) { return "g.0" + std::to_string(frame) + ".hair"; }
  StrandArrays groomed(double frame) const {
    return guide_strands(*assets_, coat_, frame, {}, job_).arrays();
  }
  void write(int frame, StrandArrays arrays) const {
    write_strands(files_.path(name(frame)), Strands(std::move(arrays)), false);
  }
  /// The guides of a frame, each turned about its root by an angle about the y axis.
  StrandArrays turned_guides(int frame, double angle) const {
    StrandArrays arrays = groomed(frame);
    for (size_t g = 0; g < kGuides; ++g) {
      const float* root = &arrays.points[4 * arrays.first_point[g]];
      const V3d at(root[0], root[1], root[2]);
      for (size_t p = arrays.first_point[g]; p < arrays.first_point[g + 1]; ++p) {
        float* point = &arrays.points[4 * p];
        const V3d d = V3d(point[0], point[1], point[2]) - at;
        const double c = std::cos(angle), s = std::sin(angle);
        const V3d to = at + V3d(c * d.x + s * d.z, d.y, c * d.z - s * d.x);
        for (size_t k = 0; k < 3; ++k) point[k] = static_cast<float>(to[static_cast<int>(k)]);
      }
    }
    return arrays;
  }
  std::string failure(double frame, int half) const {
    try {
      FileMotion(scene_, *assets_, coat_, frame, job_).at(half);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      EXPECT_EQ(error.problems().size(), 1u);
      return error.what();
    }
    return "none";
  }
  size_t segments() const { return coat_.segments(); }

  const SmallScene files_;
  QuietJob quiet_{1};
  const Job job_ = quiet_;
  const SceneDescription scene_;
  const std::unique_ptr<Assets> assets_;
  const std::vector<MovingCoat> coats_;
  const MovingCoat& coat_;
};

/// Largest difference between the points of two batches.
double distance(const StrandArrays& a, const StrandArrays& b) {
  EXPECT_EQ(a.points.size(), b.points.size());
  double largest = 0;
  for (size_t i = 0; i < a.points.size(); ++i)
    largest = std::max(largest, std::abs(double(a.points[i]) - double(b.points[i])));
  return largest;
}

// Coordinates are below 8, where floats are rounded by at most 2^-22. The two ends of a segment of a tenth of
// a unit or more then turn it by less than 1e-5, so no point of a guide of 0.8 units is off by 1e-5.
constexpr double kRounding = 2e-5;

TEST_F(FileMotionTest, GuidesFollowTheirFile) {
  for (const double angle : {0.0, 0.4, -1.3}) {
    const StrandArrays wanted = turned_guides(2, angle);
    write(2, wanted);
    const GuideTurns turns = guide_turns(scene_, *assets_, coat_, 2, job_);
    ASSERT_EQ(turns.size(), 4 * segments());
    for (size_t i = 0; i < turns.size(); i += 4) {
      EXPECT_NEAR(V3d(turns[i], turns[i + 1], turns[i + 2]).length2() + turns[i + 3] * turns[i + 3], 1, 1e-6);
      EXPECT_GE(turns[i + 3], 0);
    }
    EXPECT_LT(distance(guide_strands(*assets_, coat_, 2, turns, job_).arrays(), wanted), kRounding) << angle;
  }
}

TEST_F(FileMotionTest, LengthsInTheFileHaveNoEffect) {
  const StrandArrays wanted = turned_guides(2, 0.4);
  StrandArrays longer = wanted;
  for (size_t g = 0; g < kGuides; ++g) {
    const size_t first = longer.first_point[g];
    for (size_t p = first; p < longer.first_point[g + 1]; ++p) {
      for (size_t k = 0; k < 3; ++k) {
        const float root = wanted.points[4 * first + k];
        longer.points[4 * p + k] = root + 1.5f * (wanted.points[4 * p + k] - root);
      }
    }
  }
  write(2, longer);
  const GuideTurns turns = guide_turns(scene_, *assets_, coat_, 2, job_);
  EXPECT_LT(distance(guide_strands(*assets_, coat_, 2, turns, job_).arrays(), wanted), kRounding);
}

TEST_F(FileMotionTest, HalfFramesLieBetweenTheirNeighbours) {
  write(1, turned_guides(1, 0.2));
  write(2, turned_guides(2, 0.6));
  FileMotion motion(scene_, *assets_, coat_, 2, job_);
  const GuideTurns middle = motion.at(3), before = motion.at(2), after = motion.at(4);
  EXPECT_EQ(middle, blend_turns(before, after, 0.5f));
  EXPECT_NE(middle, before);
  // There is no frame 3.
  EXPECT_EQ(motion.at(5), after);
  EXPECT_EQ(motion.at(6), after);
  // Frame 0 is missing, too.
  FileMotion first(scene_, *assets_, coat_, 1, job_);
  EXPECT_EQ(first.at(1), first.at(2));
  EXPECT_EQ(first.at(2), before);
}

TEST_F(FileMotionTest, TheFileOfTheFrameMustExist) {
  write(1, groomed(1));
  EXPECT_NE(failure(2, 4).find(name(2) + ": there is no such file"), std::string::npos) << failure(2, 4);
  EXPECT_EQ(failure(1, 4), "none");
  // Between frames, both are needed.
  EXPECT_NE(failure(1.5, 4).find(name(2)), std::string::npos);
}

TEST_F(FileMotionTest, BadFilesAreNamed) {
  const auto expect = [&](StrandArrays arrays, const std::string& why) {
    write(2, std::move(arrays));
    EXPECT_NE(failure(2, 4).find(name(2) + ": " + why), std::string::npos) << failure(2, 4);
  };
  StrandArrays few = groomed(2);
  few.first_point.pop_back();
  few.ids.pop_back();
  few.points.resize(4 * few.first_point.back());
  expect(few, "has 8 strands, but coat 'walker.coat' has 9 guides");

  StrandArrays cut = groomed(2);
  cut.points.resize(cut.points.size() - 4);
  --cut.first_point.back();
  expect(cut, "strand 8 has 4 points, but the guides of coat 'walker.coat' have 5");

  StrandArrays dot = groomed(2);
  dot.points.resize(4 * (dot.first_point[kGuides - 1] + 1));
  dot.first_point[kGuides] = dot.first_point[kGuides - 1] + 1;
  expect(dot, "strand 8 has no length, or a point that is not finite");

  StrandArrays nan = groomed(2);
  nan.points[4 * 7] = std::numeric_limits<float>::quiet_NaN();
  expect(nan, "strand 1 has no length, or a point that is not finite");

  StrandArrays repeated = groomed(2);
  std::copy_n(&repeated.points[4 * 6], 4, &repeated.points[4 * 7]);
  expect(repeated,
         "strand 1 has 4 points that differ from the one before, but the guides of coat "
         "'walker.coat' have 5");

  StrandArrays moved = groomed(2);
  for (size_t p = 0; p < moved.points.size(); p += 4) moved.points[p] += 10;
  expect(moved, "9 of 9 strands are farther from their guides than these are long; ");

  write(2, groomed(2));
  const std::string bytes = read_file(files_.path(name(2)));
  files_.write(name(2), bytes.substr(0, bytes.size() - 5));
  EXPECT_NE(failure(2, 4).find(name(2)), std::string::npos) << failure(2, 4);
  files_.write(name(2), "");
  EXPECT_NE(failure(2, 4).find(name(2)), std::string::npos) << failure(2, 4);
}

TEST_F(FileMotionTest, ReadingStaysWithinTheMemoryLimit) {
  write(2, groomed(2));
  QuietJob small{1};
  const Job job = small;
  FileMotion motion(scene_, *assets_, coat_, 2, job);
  small.ledger().set_limit(1);
  try {
    motion.at(4);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kMemory);
  }
}

TEST_F(FileMotionTest, ContentsOfTheFramesFilesCount) {
  const auto inputs = [&](int frame) {
    return motion_file_inputs(scene_, {&frame, 1}).at("file guides-1 g.%02d.hair");
  };
  const std::string before = inputs(2), far = inputs(5);
  write(3, groomed(3));
  const std::string with_next = inputs(2);
  EXPECT_NE(with_next, before);
  write(3, turned_guides(3, 0.1));
  EXPECT_NE(inputs(2), with_next);
  EXPECT_EQ(inputs(5), far);
  const int frame = 2;
  EXPECT_EQ(
      motion_files(scene_, {&frame, 1}),
      (std::vector<std::filesystem::path>{files_.path(name(1)), files_.path(name(2)), files_.path(name(3))}));
}

TEST_F(FileMotionTest, GuidesWithoutLengthFollowTheirSkin) {
  const SceneDescription scene = load_scene(
      files_.path("scene.yaml"),
      {{"grooms.coat.dynamics", "{guides: 9, files: " + files_.path("g.%02d.hair") + "}"},
       {"grooms.coat.operators", "[{length: {value: {sphere: 0.7, center: [0.5, 0, 0]}}}, {width: {}}]"}});
  const auto assets = load_assets(scene, job_);
  const std::vector<MovingCoat> coats = moving_coats(scene, *assets);
  const Strands guides = guide_strands(*assets, coats.at(0), 2, {}, job_);
  size_t still = 0;
  for (size_t g = 0; g < guides.strand_count(); ++g) {
    const size_t first = guides.first_point(g);
    still += guides.point(first) == guides.point(first + 4);
  }
  ASSERT_GT(still, 0u);
  ASSERT_LT(still, guides.strand_count());
  write(2, guides.arrays());
  const GuideTurns turns = guide_turns(scene, *assets, coats.at(0), 2, job_);
  ASSERT_EQ(turns.size(), 4 * coats.at(0).segments());
  EXPECT_LT(distance(guide_strands(*assets, coats.at(0), 2, turns, job_).arrays(), guides.arrays()),
            kRounding);
}

}  // namespace
}  // namespace pelage::file_motion_test
