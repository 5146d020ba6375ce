// SPDX-License-Identifier: Apache-2.0
#include "lab/compare/contact_sheet.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lab/report/canvas.h"

namespace pelage {
namespace {

constexpr Canvas::Color kGround = {28, 28, 28}, kInk = {235, 235, 235}, kFaint = {150, 150, 150},
                        kEmpty = {60, 60, 60};
constexpr int kGap = 6, kHeader = 34, kLabel = 26;
constexpr double kTitle = 16, kSmall = 12;  // font sizes

int place_of(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) names.push_back(name);
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

std::string title_of(const std::string& light) { return "light: " + light; }
std::string figures_of(const ComparedFrame& frame) { return fmt::format("{:.1f} CPU s", frame.cpu_s); }

/// Width of a column such that titles do not overlap.
int titles_width(const std::vector<ComparedFrame>& frames) {
  double width = 0;
  for (const ComparedFrame& frame : frames) {
    width = std::max({width, text_width(title_of(frame.light), kTitle),
                      text_width(frame.model, kTitle) + text_width(figures_of(frame), kSmall) + 12});
  }
  return static_cast<int>(std::ceil(width));
}

}  // namespace

Picture contact_sheet(const std::vector<ComparedFrame>& frames) {
  std::vector<std::string> models, lights;
  for (const ComparedFrame& frame : frames) {
    place_of(models, frame.model);
    place_of(lights, frame.light);
  }
  const int width = frames.front().picture.width, height = frames.front().picture.height;
  const int column = std::max(width, titles_width(frames)) + kGap;
  const int row = height + kLabel + kGap;
  Canvas canvas(static_cast<int>(lights.size()) * column + kGap,
                kHeader + static_cast<int>(models.size()) * row + kGap, kGround);
  for (size_t i = 0; i < lights.size(); ++i) {
    const double middle = kGap + static_cast<double>(i) * column + 0.5 * (column - kGap);
    canvas.label({middle, 24, title_of(lights[i]), TextAnchor::kMiddle, kInk, kTitle});
  }
  for (size_t m = 0; m < models.size(); ++m) {
    const int y = kHeader + static_cast<int>(m) * row;
    for (size_t i = 0; i < lights.size(); ++i)
      canvas.fill(kGap + static_cast<int>(i) * column, y + kLabel, width, height, kEmpty);
    canvas.label({kGap + 2.0, y + 19.0, models[m], TextAnchor::kStart, kInk, kTitle});
  }
  for (const ComparedFrame& frame : frames) {
    const int x = kGap + place_of(lights, frame.light) * column;
    const int y = kHeader + place_of(models, frame.model) * row;
    canvas.draw(x, y + kLabel, frame.picture);
    canvas.label({x + column - kGap - 4.0, y + 19.0, figures_of(frame), TextAnchor::kEnd, kFaint, kSmall});
  }
  return canvas.picture();
}

}  // namespace pelage
