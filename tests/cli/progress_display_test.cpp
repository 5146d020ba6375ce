// SPDX-License-Identifier: Apache-2.0
#include "cli/progress_display.h"

#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace pelage {
namespace {

/// Writes and a clock that a test sets.
struct Recorder {
  std::vector<std::string> writes, percents;
  double now_s = 1000;
  ProgressTarget target(int columns = 80, bool color = false) {
    return {[this](std::string_view text) { writes.emplace_back(text); }, [this] { return now_s; }, columns,
            color, [this](std::string_view text) { percents.emplace_back(text); }};
  }
};

void run_stage(ProgressDisplay& display, Recorder& recorder, int steps = 5, double step_s = 0.11) {
  display.begin("grow", steps);
  for (int i = 0; i < steps; ++i) {
    recorder.now_s += step_s;
    display.advance(1);
  }
  display.end();
}

const auto kNever = [] { return false; };

TEST(ProgressDisplay, LinesComeNowAndThenAndAtTheEnd) {
  Recorder recorder;
  ProgressDisplay display(ProgressStyle::kPlain, recorder.target(), kNever);
  run_stage(display, recorder, 100);  // 11 s
  ASSERT_EQ(recorder.writes.size(), 2u);
  EXPECT_EQ(recorder.writes[0], "grow: 91 %, 0:01 left\n");
  EXPECT_EQ(recorder.writes[1], "grow: 100 %, 11.0 s\n");

  recorder.writes.clear();
  run_stage(display, recorder, 360, 1);
  EXPECT_EQ(recorder.writes.size(), 13u);  // after 10 s, every 30 s to 340 s, and the end

  recorder.writes.clear();
  run_stage(display, recorder);
  EXPECT_TRUE(recorder.writes.empty()) << "half a second is not worth a line: " << recorder.writes[0];
}

TEST(ProgressDisplay, WorkThatWasStoppedIsNotSaidToBeDone) {
  Recorder recorder;
  bool cancelled = false;
  ProgressDisplay display(ProgressStyle::kPlain, recorder.target(), [&] { return cancelled; });
  display.begin("read", 1);
  display.begin("grow", 100);
  recorder.now_s += 2;
  display.advance(11);
  cancelled = true;
  display.end();
  display.end();
  EXPECT_EQ(recorder.writes,
            (std::vector<std::string>{"grow: stopped at 11 %, 2.0 s\n", "read: stopped, 2.0 s\n"}));
}

TEST(ProgressDisplay, LinesSayWhichFrameOfHowMany) {
  Recorder recorder;
  ProgressDisplay display(ProgressStyle::kPlain, recorder.target(), kNever);
  display.frame(1001, 3, 48);
  run_stage(display, recorder, 2, 1);
  display.frame(7, 1, 1);
  run_stage(display, recorder, 2, 1);
  EXPECT_EQ(recorder.writes,
            (std::vector<std::string>{"frame 3 of 48: number 1001\n", "frame 3 of 48, grow: 100 %, 2.0 s\n",
                                      "grow: 100 %, 2.0 s\n"}));
}

TEST(ProgressDisplay, AStageGoesOnAfterOneWithinIt) {
  Recorder recorder;
  ProgressDisplay display(ProgressStyle::kPlain, recorder.target(), kNever);
  display.begin("read", 4);
  display.advance(1);
  run_stage(display, recorder, 2, 1);
  recorder.now_s += 5;
  display.advance(1);
  display.end();
  EXPECT_EQ(recorder.writes, (std::vector<std::string>{"grow: 100 %, 2.0 s\n", "read: 50 %, 7.0 s\n"}));
}

TEST(ProgressDisplay, JsonLinesParse) {
  Recorder recorder;
  ProgressDisplay display(ProgressStyle::kJson, recorder.target(), kNever);
  run_stage(display, recorder, 3, 2);
  display.note("a \"note\" \xff");
  ASSERT_GE(recorder.writes.size(), 3u);
  const auto first = nlohmann::json::parse(recorder.writes.front());
  EXPECT_EQ(first.at("stage"), "grow");
  EXPECT_EQ(first.at("ended"), false);
  EXPECT_NEAR(first.at("done").get<double>(), 1.0 / 3, 1e-12);
  EXPECT_FALSE(first.contains("left_s")) << "nobody can tell after two seconds";
  EXPECT_NEAR(nlohmann::json::parse(recorder.writes[1]).at("left_s").get<double>(), 2, 1e-6);
  const auto last = nlohmann::json::parse(recorder.writes[recorder.writes.size() - 2]);
  EXPECT_EQ(last.at("done"), 1.0);
  EXPECT_EQ(last.at("ended"), true);
  EXPECT_TRUE(nlohmann::json::parse(recorder.writes.back()).contains("note"));
}

TEST(ProgressDisplay, QueuesGetOnePercentageForAllFrames) {
  for (const ProgressStyle style : {ProgressStyle::kAlfred, ProgressStyle::kTractor}) {
    Recorder recorder;
    ProgressDisplay display(style, recorder.target(), kNever);
    for (size_t frame = 1; frame <= 2; ++frame) {
      display.frame(static_cast<int>(10 * frame), frame, 2);
      run_stage(display, recorder);  // "grow" does not count
      display.begin("render", 4);
      for (int i = 0; i < 4; ++i) {
        recorder.now_s += 1;
        display.advance(1);
      }
      display.end();
    }
    display.note("a note");
    const std::vector<std::string> wanted =
        style == ProgressStyle::kAlfred
            ? std::vector<std::string>{"12%", "25%", "37%", "50%", "62%", "75%", "87%", "100%"}
            : std::vector<std::string>{"012%", "025%", "037%", "050%", "062%", "075%", "087%", "100%"};
    ASSERT_EQ(recorder.percents.size(), wanted.size());
    for (size_t i = 0; i < wanted.size(); ++i) {
      EXPECT_EQ(recorder.percents[i],
                (style == ProgressStyle::kAlfred ? "ALF_PROGRESS " : "TR_PROGRESS ") + wanted[i] + "\n");
    }
    EXPECT_EQ(recorder.writes, std::vector<std::string>{"a note\n"});
  }
}

TEST(ProgressDisplay, BarFitsTheTerminal) {
  for (const int columns : {20, 40, 60, 80, 200}) {
    Recorder recorder;
    ProgressDisplay display(ProgressStyle::kBar, recorder.target(columns), kNever);
    run_stage(display, recorder, 2);
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
  run_stage(display, recorder, 2);
  EXPECT_NE(recorder.writes.front().find("\x1b[32m"), std::string::npos);
}

TEST(ProgressDisplay, QuietSaysNothing) {
  Recorder recorder;
  ProgressDisplay display(ProgressStyle::kQuiet, recorder.target(), kNever);
  run_stage(display, recorder, 2);
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
