// SPDX-License-Identifier: Apache-2.0
#include "lab/compare/contact_sheet.h"

#include <algorithm>

#include <fmt/format.h>

#include "lab/report/canvas.h"

namespace pelage {
namespace {

constexpr Canvas::Color kGround = {28, 28, 28}, kInk = {235, 235, 235}, kFaint = {150, 150, 150},
                        kEmpty = {60, 60, 60};
constexpr int kGap = 6, kHeader = 34, kLabel = 26;

int place_of(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) names.push_back(name);
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

std::string title_of(const std::string& light) { return "light: " + light; }
std::string figures_of(const ComparedFrame& frame) { return fmt::format("{:.1f} CPU s", frame.cpu_s); }

/// How wide a column must be so that no title reaches into the next, with names of this size.
int titles_width(const std::vector<ComparedFrame>& frames, int size) {
  int width = 0;
  for (const ComparedFrame& frame : frames) {
    width = std::max({width, Canvas::text_width(title_of(frame.light), size),
                      Canvas::text_width(frame.model, size) + Canvas::text_width(figures_of(frame), 1) + 12});
  }
  return width;
}

}  // namespace

Picture contact_sheet(const std::vector<ComparedFrame>& frames) {
  std::vector<std::string> models, lights;
  for (const ComparedFrame& frame : frames) {
    place_of(models, frame.model);
    place_of(lights, frame.light);
  }
  const int width = frames.front().picture.width, height = frames.front().picture.height;
  const int size = titles_width(frames, 2) <= width ? 2 : 1;
  const int column = std::max(width, titles_width(frames, size)) + kGap;
  const int row = height + kLabel + kGap;
  Canvas canvas(static_cast<int>(lights.size()) * column + kGap,
                kHeader + static_cast<int>(models.size()) * row + kGap, kGround);
  for (size_t i = 0; i < lights.size(); ++i) {
    const std::string text = title_of(lights[i]);
    const int x = kGap + static_cast<int>(i) * column;
    canvas.text(x + std::max(0, width - Canvas::text_width(text, size)) / 2, 10, text, kInk, size);
  }
  for (size_t m = 0; m < models.size(); ++m) {
    const int y = kHeader + static_cast<int>(m) * row;
    for (size_t i = 0; i < lights.size(); ++i)
      canvas.fill(kGap + static_cast<int>(i) * column, y + kLabel, width, height, kEmpty);
    canvas.text(kGap + 2, y + 6, models[m], kInk, size);
  }
  for (const ComparedFrame& frame : frames) {
    const int x = kGap + place_of(lights, frame.light) * column;
    const int y = kHeader + place_of(models, frame.model) * row;
    canvas.draw(x, y + kLabel, frame.picture);
    const std::string figures = figures_of(frame);
    canvas.text(x + column - kGap - Canvas::text_width(figures, 1) - 4, y + 12, figures, kFaint, 1);
  }
  return canvas.picture();
}

Picture halved(const Picture& picture) {
  Picture half = picture;
  half.width = std::max(1, picture.width / 2);
  half.height = std::max(1, picture.height / 2);
  half.pixels.clear();
  const auto channels = static_cast<size_t>(picture.channels);
  const auto at = [&](int x, int y, size_t c) {
    const auto u = static_cast<size_t>(std::min(x, picture.width - 1)),
               v = static_cast<size_t>(std::min(y, picture.height - 1));
    return static_cast<unsigned>(picture.pixels[channels * (v * static_cast<size_t>(picture.width) + u) + c]);
  };
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      for (size_t c = 0; c < channels; ++c) {
        const unsigned sum = at(2 * x, 2 * y, c) + at(2 * x + 1, 2 * y, c) + at(2 * x, 2 * y + 1, c) +
                             at(2 * x + 1, 2 * y + 1, c);
        half.pixels.push_back(static_cast<unsigned char>((sum + 2) / 4));
      }
    }
  }
  return half;
}

}  // namespace pelage
