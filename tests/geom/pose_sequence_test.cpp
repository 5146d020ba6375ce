// SPDX-License-Identifier: Apache-2.0
#include "geom/pose_sequence.h"

#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/temporary_folder.h"
#include "tests/geom/cages.h"

namespace pelage {
namespace {

// Three poses of a triangle that rises by one unit per pose.
class PoseSequenceTest : public ::testing::Test {
 protected:
  PoseSequenceTest() {
    for (int i = 0; i < 3; ++i) {
      files_.push_back(folder_.path() / ("pose" + std::to_string(i) + ".obj"));
      std::ofstream(files_.back()) << "v 0 " << i << " 0\nv 1 " << i << " 0\nv 0 " << i << " 1\nf 1 2 3\n";
    }
  }
  float height(const PoseSequence& poses, double pose) const { return poses.positions(pose)[2].y; }

  TemporaryFolder folder_;
  std::vector<std::filesystem::path> files_;
  const MeshOrder triangle_ = mesh_order(make_cage({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {{0, 1, 2}}));
  MemoryLedger ledger_;
};

TEST_F(PoseSequenceTest, BlendsBetweenPosesAndHoldsTheEnds) {
  const PoseSequence poses(files_, 1, false, triangle_, ledger_);
  EXPECT_EQ(height(poses, 1), 0);
  EXPECT_FLOAT_EQ(height(poses, 2.25), 1.25f);
  EXPECT_EQ(height(poses, -7.5), 0);
  EXPECT_EQ(height(poses, 3.5), 2);
}

TEST_F(PoseSequenceTest, CyclesInBothDirections) {
  const PoseSequence poses(files_, 1, true, triangle_, ledger_);
  EXPECT_EQ(height(poses, 4), 0);
  EXPECT_FLOAT_EQ(height(poses, 3.5), 1.0f);  // halfway from the last pose to the first
  EXPECT_EQ(height(poses, 0), 2);
  EXPECT_EQ(height(poses, -300), 2);
}

TEST_F(PoseSequenceTest, TakesAnyNumber) {
  for (bool cycle : {false, true}) {
    const PoseSequence poses(files_, 1, cycle, triangle_, ledger_);
    for (double pose :
         {1e18, -1e18, 1e300, -1e300, 1 - 1e-17, double(INFINITY), -double(INFINITY), double(NAN)}) {
      const float y = height(poses, pose);
      EXPECT_TRUE(y >= 0 && y <= 2) << pose;
    }
  }
}

TEST_F(PoseSequenceTest, PosesMayBeFramesApart) {
  const PoseSequence poses(files_, 1, true, triangle_, ledger_, 4);
  EXPECT_EQ(height(poses, 1), 0);
  EXPECT_EQ(height(poses, 3), 0.5f);
  EXPECT_EQ(height(poses, 5), 1);
  EXPECT_EQ(height(poses, 13), 0);
}

TEST_F(PoseSequenceTest, ReadsEachFileOnce) {
  const PoseSequence poses(files_, 1, false, triangle_, ledger_);
  EXPECT_EQ(ledger_.current(MemoryTag::kSkins), 0);
  const float first = height(poses, 1.5);
  EXPECT_EQ(ledger_.current(MemoryTag::kSkins), static_cast<int64_t>(2 * 3 * sizeof(V3f)));
  for (const auto& file : files_) std::filesystem::remove(file);
  EXPECT_EQ(height(poses, 1.5), first);
  EXPECT_THROW(poses.positions(3), Error);  // was not needed before
}

TEST_F(PoseSequenceTest, KeepsNoMoreThanTheLimitHasRoomFor) {
  const auto pose = static_cast<int64_t>(3 * sizeof(V3f));
  ledger_.set_limit(static_cast<uint64_t>(100 * pose));
  const MemoryCharge others(ledger_, MemoryTag::kFilm, 98 * pose);
  const PoseSequence poses(files_, 1, false, triangle_, ledger_);
  for (const double at : {1.5, 2.5, 1.0}) EXPECT_EQ(height(poses, at), at - 1);
  EXPECT_EQ(ledger_.peak(MemoryTag::kSkins), 2 * pose);
  const MemoryCharge more(ledger_, MemoryTag::kFilm, 2 * pose);
  try {
    poses.positions(2);
    ADD_FAILURE() << "there is no room for another pose";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kMemory);
    EXPECT_NE(std::string(error.what()).find("pose1.obj"), std::string::npos);
  }
}

TEST_F(PoseSequenceTest, NamesTheFileThatIsMissingOrDoesNotFit) {
  files_[1] = folder_.path() / "nowhere.obj";
  try {
    PoseSequence(files_, 1, false, triangle_, ledger_).positions(2);
    FAIL() << "a missing pose was accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("nowhere.obj"), std::string::npos);
  }
  EXPECT_THROW(PoseSequence(files_, 1, false, {4, triangle_.faces}, ledger_).positions(1), Error);
}

}  // namespace
}  // namespace pelage
