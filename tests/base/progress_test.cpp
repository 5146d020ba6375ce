// SPDX-License-Identifier: Apache-2.0
#include "base/progress.h"

#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace pelage {
namespace {

/// Records the calls that it receives.
class Written final : public Progress {
 public:
  void begin(std::string_view stage, double total) override {
    text += "begin " + std::string(stage) + " " + std::to_string(static_cast<int>(total)) + "; ";
  }
  void advance(double amount) override { text += std::to_string(static_cast<int>(amount)) + "; "; }
  void end() override { text += "end"; }
  bool cancelled() const override { return false; }

  std::string text;
};

TEST(ProgressStage, EndsWithItsScope) {
  Written progress;
  {
    const ProgressStage stage(progress, "sort", 7);
    stage.advance(3);
  }
  EXPECT_EQ(progress.text, "begin sort 7; 3; end");
}

TEST(ProgressStage, EndsWhenSomethingIsThrown) {
  Written progress;
  EXPECT_THROW(
      {
        const ProgressStage stage(progress, "sort", 7);
        throw std::runtime_error("no");
      },
      std::runtime_error);
  EXPECT_EQ(progress.text, "begin sort 7; end");
}

TEST(ProgressStage, ShowsNothingOfWhatIsOverInAMoment) {
  Written progress;
  {
    const ProgressStage stage(progress, "sort", 7, false);
    stage.advance(3);
  }
  EXPECT_EQ(progress.text, "");
}

}  // namespace
}  // namespace pelage
