// SPDX-License-Identifier: Apache-2.0
#include "cli/time_left.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace pelage {
namespace {

TEST(TimeLeft, AnEvenJobIsForetold) {
  TimeLeft left;
  for (int i = 1; i <= 500; ++i) {
    left.add(0.1 * i, i / 1000.0);
    if (i < 30) {
      EXPECT_FALSE(left.estimate()) << "the first seconds say nothing";
    } else {
      ASSERT_TRUE(left.estimate()) << i;
      EXPECT_NEAR(*left.estimate(), 0.1 * (1000 - i), 1e-6);
    }
  }
}

TEST(TimeLeft, WhatASlowBeginningSuggestsIsNotSaid) {
  // Half a minute in which fur grows and next to nothing is rendered, then a minute of rendering: the rate
  // of the whole time would foretell half an hour when that begins.
  TimeLeft left;
  const auto done = [](double t) { return t < 30 ? t / 30000 : 0.001 + (t - 30) / 60; };
  double max = 0;
  for (double t = 0.1; t < 85; t += 0.1) {
    left.add(t, done(t));
    if (left.estimate()) max = std::max(max, *left.estimate() - (89.5 - t));
  }
  ASSERT_TRUE(left.estimate());
  EXPECT_NEAR(*left.estimate(), 4.6, 1);
  EXPECT_LT(max, 20);
}

TEST(TimeLeft, NothingIsSaidOfAStageThatDoesNotAdvance) {
  TimeLeft left;
  for (double t = 0; t < 100; t += 0.5) left.add(t, 0);
  EXPECT_FALSE(left.estimate());
  left.add(101, 0.5);
  for (double t = 101; t < 1000; t += 0.5) left.add(t, 0.5);
  EXPECT_FALSE(left.estimate()) << "it stands still";
}

}  // namespace
}  // namespace pelage
