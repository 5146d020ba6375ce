// SPDX-License-Identifier: Apache-2.0
#include "post/fill_holes.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace pelage {
namespace {

/// Small letters are near, capitals far, S very far, dots empty; what was invented comes back in brackets'
/// stead as '*'.
std::string filled(const std::string& text, int longest, RowEnds ends = {}, std::string* invented = nullptr) {
  std::vector<Sample> row;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    row.push_back(c == '.' ? Sample() : Sample(c >= 'a' ? 1.0f : c == 'S' ? 100.0f : 5.0f, c, 0));
  }
  std::vector<uint8_t> marks(row.size());
  fill_gaps(row, marks, longest, ends);
  std::string result;
  for (const Sample& sample : row) result += sample.is_empty() ? '.' : static_cast<char>(sample.x());
  if (invented) {
    invented->clear();
    for (uint8_t mark : marks) *invented += mark ? '*' : '-';
  }
  return result;
}

TEST(FillHoles, MirrorsTheFartherSide) {
  std::string marks;
  EXPECT_EQ(filled("ab...DEFG", 9, {}, &marks), "abFEDDEFG");
  EXPECT_EQ(marks, "--***----");
  EXPECT_EQ(filled("GFED...ab", 9), "GFEDDEFab");
}

TEST(FillHoles, DrawsOutWhereTheFartherSideEnds) { EXPECT_EQ(filled("ab.....DEcd", 9), "abEEEEDDEcd"); }

TEST(FillHoles, FillsNoMoreThanItMay) { EXPECT_EQ(filled("ab.....DEFG", 2), "ab...EDDEFG"); }

TEST(FillHoles, EqualBordersAreFilledFromTheLeft) { EXPECT_EQ(filled("AB..CD", 9), "ABBACD"); }

TEST(FillHoles, EndsAreFilledWhereThePictureIsCutOff) {
  EXPECT_EQ(filled("..AB..", 9), "BAABBA");
  EXPECT_EQ(filled("..AB..", 9, {false, false}), "..AB..");
  EXPECT_EQ(filled("..AB..", 9, {true, false}), "BAAB..");
}

TEST(FillHoles, NothingComesFromNothing) {
  EXPECT_EQ(filled("....", 9), "....");
  EXPECT_EQ(filled("", 9), "");
  EXPECT_EQ(filled("A..B", 0), "A..B");
}

TEST(FillHoles, WhatWasFilledIsNotMirrored) { EXPECT_EQ(filled("A..B..c", 9), "AAABBAc"); }

TEST(FillHoles, AThinThingIsMirroredWithTheBackgroundBesideIt) {
  // S is the sky: in the gap the far strand D ends where it ends beside it.
  EXPECT_EQ(filled("ab...DSSS", 9), "abSSDDSSS");
}

TEST(FillHoles, NearThingsAreNotMirrored) { EXPECT_EQ(filled("ab..DcE..", 9, {true, false}), "abEDDcE.."); }

TEST(FillHoles, WhatIsFarAwayIsNotTheGapsBackground) { EXPECT_EQ(filled("ab..DccccccE", 9), "abDDDccccccE"); }

}  // namespace
}  // namespace pelage
