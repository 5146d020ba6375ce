// SPDX-License-Identifier: Apache-2.0
#include "cli/progress_display.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/ioctl.h>
#include <unistd.h>

#include "base/visible_text.h"

namespace pelage {
namespace {

constexpr double kSteps = 1000;  // max number of clock queries per stage
constexpr double kRedraw_s = 0.1;
constexpr double kFirstLine_s = 10, kNextLine_s = 30, kShortStage_s = 1;  // of lines
constexpr int kNarrowestBar = 10;
constexpr int kWidestBar = 40;

ProgressTarget standard_error() {
  ProgressTarget target;
  target.write = [](std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
  };
  target.percent = [](std::string_view text) { std::cout << text << std::flush; };
  target.seconds = [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  };
  winsize size{};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) target.columns = size.ws_col;
  const char* terminal = std::getenv("TERM");
  const char* no_color = std::getenv("NO_COLOR");
  target.color = (no_color == nullptr || *no_color == '\0') && terminal && std::strcmp(terminal, "dumb") != 0;
  return target;
}

ProgressStyle resolve(ProgressStyle style) {
  if (style != ProgressStyle::kAuto) return style;
  return ::isatty(STDERR_FILENO) ? ProgressStyle::kBar : ProgressStyle::kPlain;
}

double fraction_of(double done, double total) { return std::clamp(done / total, 0.0, 1.0); }

// The small offset keeps a sum of many rounded amounts from ending at 99 %.
int percent_of(double fraction) { return static_cast<int>(fraction * 100 + 1e-6); }

}  // namespace

std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(std::clamp(std::round(seconds), 0.0, 1e9));
  const long hours = whole / 3600, minutes = whole / 60 % 60;
  if (hours > 0) return fmt::format("{}:{:02}:{:02}", hours, minutes, whole % 60);
  return fmt::format("{}:{:02}", minutes, whole % 60);
}

ProgressDisplay::ProgressDisplay(ProgressStyle style, std::function<bool()> cancelled)
    : ProgressDisplay(resolve(style), standard_error(), std::move(cancelled)) {}

ProgressDisplay::ProgressDisplay(ProgressStyle style, ProgressTarget target, std::function<bool()> cancelled)
    : style_(style), target_(std::move(target)), cancelled_(std::move(cancelled)) {}

ProgressDisplay::~ProgressDisplay() {
  if (line_open_) target_.write("\n");
}

void ProgressDisplay::frame(int number, size_t place, size_t count) {
  const std::lock_guard lock(mutex_);
  frame_.reset();
  if (count < 2) return;
  frame_ = {number, place, count};
  if (style_ == ProgressStyle::kPlain)
    target_.write(fmt::format("frame {} of {}: number {}\n", place, count, number));
}

void ProgressDisplay::begin(std::string_view stage, double total) {
  const std::lock_guard lock(mutex_);
  if (!stages_.empty()) stages_.back().done = done_.load(std::memory_order_relaxed);
  Stage next;
  next.name = stage;
  next.total = total > 0 ? total : 1;
  next.began_s = drawn_s_ = target_.seconds();
  next.due_s = next.began_s + kFirstLine_s;
  stages_.push_back(std::move(next));
  done_.store(0, std::memory_order_relaxed);
  set_next_step(0);
  if (style_ == ProgressStyle::kBar) draw(false);
}

void ProgressDisplay::advance(double amount) {
  const double done = done_.fetch_add(amount, std::memory_order_relaxed) + amount;
  if (style_ == ProgressStyle::kQuiet || done < next_step_.load(std::memory_order_relaxed)) return;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock || stages_.empty()) return;
  set_next_step(done);
  if (target_.seconds() - drawn_s_ >= kRedraw_s) draw(false);
}

void ProgressDisplay::expect(double total) {
  const std::lock_guard lock(mutex_);
  if (stages_.empty()) return;
  stages_.back().total = total > 0 ? total : 1;
  set_next_step(done_.load(std::memory_order_relaxed));
}

void ProgressDisplay::end() {
  const std::lock_guard lock(mutex_);
  if (stages_.empty()) return;
  if (style_ != ProgressStyle::kQuiet) draw(true);
  stages_.pop_back();
  done_.store(stages_.empty() ? 0 : stages_.back().done, std::memory_order_relaxed);
  if (!stages_.empty()) set_next_step(stages_.back().done);
}

void ProgressDisplay::note(std::string_view line) {
  if (style_ != ProgressStyle::kQuiet) show("note", line);
}

void ProgressDisplay::warn(std::string_view line) {
  const bool json = style_ == ProgressStyle::kJson;
  show("warning", json ? std::string(line) : fmt::format("pelage: warning: {}", line));
}

void ProgressDisplay::show(std::string_view kind, std::string_view line) {
  const std::lock_guard lock(mutex_);
  if (style_ == ProgressStyle::kJson) {
    target_.write(
        nlohmann::ordered_json{{kind, line}}.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) +
        "\n");
    return;
  }
  target_.write(fmt::format("{}{}\n", line_open_ ? "\r\x1b[K" : "", visible(line)));
  line_open_ = false;
  if (!stages_.empty() && style_ == ProgressStyle::kBar) draw(false);
}

void ProgressDisplay::set_next_step(double done) {
  const double step = stages_.back().total / kSteps;
  next_step_.store((std::floor(done / step) + 1) * step, std::memory_order_relaxed);
}

std::string ProgressDisplay::title(const Stage& stage) const {
  return frame_ ? fmt::format("frame {} of {}, {}", frame_->place, frame_->count, stage.name) : stage.name;
}

void ProgressDisplay::draw(bool last) {
  Stage& stage = stages_.back();
  stage.done = done_.load(std::memory_order_relaxed);
  drawn_s_ = target_.seconds();
  stage.left.add(drawn_s_ - stage.began_s, fraction_of(stage.done, stage.total));
  switch (style_) {
    case ProgressStyle::kBar:
      target_.write(last ? fmt::format("\r\x1b[K{}: {:.1f} s\n", title(stage), drawn_s_ - stage.began_s)
                         : bar_line(stage, drawn_s_));
      line_open_ = !last;
      return;
    case ProgressStyle::kJson:
      return draw_json(stage, last, drawn_s_);
    case ProgressStyle::kAlfred:
    case ProgressStyle::kTractor:
      return draw_percent(stage);
    default:
      return draw_line(stage, last, drawn_s_);
  }
}

void ProgressDisplay::draw_line(Stage& stage, bool last, double now_s) {
  const double elapsed_s = now_s - stage.began_s;
  if (last ? elapsed_s < kShortStage_s : now_s < stage.due_s) return;
  stage.due_s = now_s + kNextLine_s;
  const int percent = percent_of(fraction_of(stage.done, stage.total));
  const std::optional<double> left_s = stage.left.estimate();
  const std::string tail = last     ? fmt::format("{:.1f} s", elapsed_s)
                           : left_s ? duration_text(*left_s) + " left"
                                    : duration_text(elapsed_s) + " elapsed";
  const bool stopped = last && percent < 100 && (percent == 0 || cancelled());
  const std::string state = percent > 0 || !stopped ? fmt::format("{} %", percent) : "";
  const std::string_view how = !stopped ? "" : state.empty() ? "stopped" : "stopped at ";
  target_.write(fmt::format("{}: {}{}, {}\n", title(stage), how, state, tail));
}

void ProgressDisplay::draw_json(Stage& stage, bool last, double now_s) {
  const double fraction = fraction_of(stage.done, stage.total);
  const int percent = percent_of(fraction);
  if (percent == stage.shown_percent && !last) return;
  stage.shown_percent = percent;
  nlohmann::ordered_json json{
      {"stage", stage.name}, {"done", fraction}, {"elapsed_s", now_s - stage.began_s}};
  if (frame_) {
    json["frame"] = frame_->number;
    json["frame_place"] = frame_->place;
    json["frame_count"] = frame_->count;
  }
  if (const std::optional<double> left_s = stage.left.estimate()) json["left_s"] = *left_s;
  json["ended"] = last;
  target_.write(json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

void ProgressDisplay::draw_percent(const Stage& stage) {
  if (stage.name != "render") return;
  const double before = frame_ ? static_cast<double>(frame_->place - 1) : 0;
  const double frames = frame_ ? static_cast<double>(frame_->count) : 1;
  const int percent = percent_of((before + fraction_of(stage.done, stage.total)) / frames);
  if (percent <= run_percent_) return;
  run_percent_ = percent;
  target_.percent(style_ == ProgressStyle::kAlfred ? fmt::format("ALF_PROGRESS {}%\n", percent)
                                                   : fmt::format("TR_PROGRESS {:03}%\n", percent));
}

std::string ProgressDisplay::bar_line(const Stage& stage, double now_s) const {
  const double fraction = fraction_of(stage.done, stage.total);
  const std::optional<double> left_s = stage.left.estimate();
  const std::string tail =
      fmt::format("{:3} %  {}", percent_of(fraction),
                  left_s ? duration_text(*left_s) + " left" : duration_text(now_s - stage.began_s));
  const std::string name = title(stage);
  const int room = target_.columns - 1 - static_cast<int>(name.size() + tail.size()) - 6;
  if (room < kNarrowestBar)
    return fmt::format("\r\x1b[K{}", tail.substr(0, static_cast<size_t>(target_.columns - 1)));
  const int width = std::min(room, kWidestBar);
  const auto full = static_cast<size_t>(std::lround(fraction * width));
  const std::string filled(full, '#');
  const std::string empty(static_cast<size_t>(width) - full, '.');
  return fmt::format("\r\x1b[K{}  [{}{}{}{}]  {}", name, target_.color ? "\x1b[32m" : "", filled,
                     target_.color ? "\x1b[0m" : "", empty, tail);
}

}  // namespace pelage
