// SPDX-License-Identifier: Apache-2.0
#include "cli/progress_display.h"

#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace pelage {
namespace {

struct Recorder {
  std::vector<std::string> writes;
  ProgressTarget target(int columns = 80, bool color = false) {
    return {[this](std::string_view text) { writes.emplace_back(text); }, columns, color};
  }
};

// A stage long enough, in the eyes of the clock, for a few redraws.
void run_stage(ProgressDisplay& display, int steps = 5) {
  display.begin("grow", steps);
  for (int i = 0; i < steps; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(110));
    display.advance(1);
  }
  display.end();
}

const auto kNever = [] { return false; };

TEST(ProgressDisplay, PlainLinesRiseToAHundred) {
  Recorder recorder;
  ProgressDisplay display(ProgressStyle::kPlain, recorder.target(), kNever);
  run_stage(display);
  ASSERT_GE(recorder.writes.size(), 2u);
  EXPECT_EQ(recorder.writes[0].substr(0, 11), "grow: 20 %,");
  int before = 0;
  for (const std::string& line : recorder.writes) {
    EXPECT_EQ(line.find('\n'), line.size() - 1);
    const int percent = std::stoi(line.substr(6));
    EXPECT_GE(percent, before);
    before = percent;
  }
  EXPECT_EQ(before, 100);
}

TEST(ProgressDisplay, JsonLinesParse) {
  Recorder recorder;
  ProgressDisplay display(ProgressStyle::kJson, recorder.target(), kNever);
  run_stage(display, 3);
  display.note("a \"note\" \xff");
  ASSERT_GE(recorder.writes.size(), 3u);
  const auto first = nlohmann::json::parse(recorder.writes.front());
  EXPECT_EQ(first.at("stage"), "grow");
  EXPECT_EQ(first.at("ended"), false);
  EXPECT_NEAR(first.at("done").get<double>(), 1.0 / 3, 1e-12);
  EXPECT_GT(first.at("left_s").get<double>(), 0);
  const auto last = nlohmann::json::parse(recorder.writes[recorder.writes.size() - 2]);
  EXPECT_EQ(last.at("done"), 1.0);
  EXPECT_EQ(last.at("ended"), true);
  EXPECT_TRUE(nlohmann::json::parse(recorder.writes.back()).contains("note"));
}

TEST(ProgressDisplay, BarFitsTheTerminal) {
  for (const int columns : {20, 40, 60, 80, 200}) {
    Recorder recorder;
    ProgressDisplay display(ProgressStyle::kBar, recorder.target(columns), kNever);
    run_stage(display, 2);
    for (const std::string& redraw : recorder.writes) {
      ASSERT_EQ(redraw.substr(0, 4), "\r\x1b[K");
      EXPECT_LT(redraw.size() - 4, static_cast<size_t>(columns)) << redraw;
      EXPECT_EQ(redraw.find("\x1b[3"), std::string::npos);
    }
    EXPECT_EQ(recorder.writes.back().back(), '\n');
  }
}

TEST(ProgressDisplay, ColourOnlyWhereWanted) {
  Recorder recorder;
  ProgressDisplay display(ProgressStyle::kBar, recorder.target(80, true), kNever);
  run_stage(display, 2);
  EXPECT_NE(recorder.writes.front().find("\x1b[32m"), std::string::npos);
}

TEST(ProgressDisplay, QuietSaysNothing) {
  Recorder recorder;
  ProgressDisplay display(ProgressStyle::kQuiet, recorder.target(), kNever);
  run_stage(display, 2);
  display.note("nothing");
  EXPECT_TRUE(recorder.writes.empty());
}

TEST(ProgressDisplay, AsksWhetherToStop) {
  bool stop = false;
  ProgressDisplay display(ProgressStyle::kQuiet, Recorder().target(), [&] { return stop; });
  EXPECT_FALSE(display.cancelled());
  stop = true;
  EXPECT_TRUE(display.cancelled());
}

TEST(ProgressDisplay, ManyThreadsMayAdvance) {
  constexpr int kThreads = 8, kSteps = 20000;
  Recorder recorder;
  ProgressDisplay display(ProgressStyle::kJson, recorder.target(), kNever);
  display.begin("render", kThreads * kSteps);
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < kSteps; ++i) display.advance(1);
    });
  }
  for (std::thread& thread : threads) thread.join();
  display.end();
  EXPECT_EQ(nlohmann::json::parse(recorder.writes.back()).at("done"), 1.0);
}

TEST(ProgressDisplay, Durations) {
  EXPECT_EQ(duration_text(0.4), "0:00");
  EXPECT_EQ(duration_text(7), "0:07");
  EXPECT_EQ(duration_text(760), "12:40");
  EXPECT_EQ(duration_text(3723), "1:02:03");
  EXPECT_EQ(duration_text(-5), "0:00");
}

}  // namespace
}  // namespace pelage
