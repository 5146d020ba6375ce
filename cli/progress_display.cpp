// SPDX-License-Identifier: Apache-2.0
#include "cli/progress_display.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/ioctl.h>
#include <unistd.h>

namespace pelage {
namespace {

constexpr double kSteps = 1000;  // at most this many looks at the clock per stage
constexpr auto kRedrawInterval = std::chrono::milliseconds(100);
constexpr int kNarrowestBar = 10;
constexpr int kWidestBar = 40;

ProgressTarget standard_error() {
  ProgressTarget target;
  target.write = [](std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
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

void ProgressDisplay::begin(std::string_view stage, double total) {
  const std::lock_guard lock(mutex_);
  stage_ = stage;
  total_ = total > 0 ? total : 1;
  began_ = drawn_ = Clock::now();
  in_stage_ = true;
  shown_percent_ = -1;
  done_.store(0, std::memory_order_relaxed);
  set_next_step(0);
  if (style_ == ProgressStyle::kBar) draw(0, false);
}

void ProgressDisplay::advance(double amount) {
  const double done = done_.fetch_add(amount, std::memory_order_relaxed) + amount;
  if (style_ == ProgressStyle::kQuiet || done < next_step_.load(std::memory_order_relaxed)) return;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock || !in_stage_) return;
  set_next_step(done);
  if (Clock::now() - drawn_ >= kRedrawInterval) draw(done, false);
}

void ProgressDisplay::expect(double total) {
  const std::lock_guard lock(mutex_);
  if (!in_stage_) return;
  total_ = total > 0 ? total : 1;
  set_next_step(done_.load(std::memory_order_relaxed));
}

void ProgressDisplay::end() {
  const std::lock_guard lock(mutex_);
  if (!in_stage_) return;
  in_stage_ = false;
  if (style_ != ProgressStyle::kQuiet) draw(done_.load(std::memory_order_relaxed), true);
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
  target_.write(fmt::format("{}{}\n", line_open_ ? "\r\x1b[K" : "", line));
  line_open_ = false;
  if (in_stage_ && style_ == ProgressStyle::kBar) draw(done_.load(std::memory_order_relaxed), false);
}

void ProgressDisplay::set_next_step(double done) {
  const double step = total_ / kSteps;
  next_step_.store((std::floor(done / step) + 1) * step, std::memory_order_relaxed);
}

void ProgressDisplay::draw(double done, bool last) {
  drawn_ = Clock::now();
  const double elapsed = std::chrono::duration<double>(drawn_ - began_).count();
  const double fraction = std::clamp(done / total_, 0.0, 1.0);
  const double left = fraction > 0 ? elapsed * (1 - fraction) / fraction : 0;
  // The small excess keeps a sum of many rounded amounts from ending at 99 %.
  const int percent = static_cast<int>(fraction * 100 + 1e-6);
  if (style_ == ProgressStyle::kBar) {
    target_.write(last ? fmt::format("\r\x1b[K{}: {:.1f} s\n", stage_, elapsed)
                       : bar_line(fraction, elapsed));
    line_open_ = !last;
    return;
  }
  if (percent == shown_percent_ && !last) return;
  shown_percent_ = percent;
  if (style_ == ProgressStyle::kPlain) {
    target_.write(last ? fmt::format("{}: {} %, {:.1f} s\n", stage_, percent, elapsed)
                       : fmt::format("{}: {} %, {} left\n", stage_, percent, duration_text(left)));
  } else {
    nlohmann::ordered_json json{{"stage", stage_}, {"done", fraction}, {"elapsed_s", elapsed}};
    if (fraction > 0) json["left_s"] = left;
    json["ended"] = last;
    target_.write(json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  }
}

std::string ProgressDisplay::bar_line(double fraction, double elapsed) const {
  const double left = fraction > 0 ? elapsed * (1 - fraction) / fraction : -1;
  const std::string tail = fmt::format("{:3} %  {}", static_cast<int>(fraction * 100),
                                       left >= 0 ? duration_text(left) + " left" : duration_text(elapsed));
  const int room = target_.columns - 1 - static_cast<int>(stage_.size() + tail.size()) - 6;
  if (room < kNarrowestBar)
    return fmt::format("\r\x1b[K{}", tail.substr(0, static_cast<size_t>(target_.columns - 1)));
  const int width = std::min(room, kWidestBar);
  const auto full = static_cast<size_t>(std::lround(fraction * width));
  const std::string filled(full, '#');
  const std::string empty(static_cast<size_t>(width) - full, '.');
  return fmt::format("\r\x1b[K{}  [{}{}{}{}]  {}", stage_, target_.color ? "\x1b[32m" : "", filled,
                     target_.color ? "\x1b[0m" : "", empty, tail);
}

}  // namespace pelage
