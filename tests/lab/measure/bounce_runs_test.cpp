// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/bounce_runs.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace pelage {
namespace {

TEST(BounceRuns, BounceWhateverTheSceneSays) {
  for (const BounceMethod& method : bounce_methods()) {
    EXPECT_EQ(std::count(method.settings.begin(), method.settings.end(),
                         std::pair<std::string, std::string>("indirect", "path")),
              1)
        << method.id;
  }
}

}  // namespace
}  // namespace pelage
