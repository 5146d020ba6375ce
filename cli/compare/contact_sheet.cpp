// SPDX-License-Identifier: Apache-2.0
#include "cli/compare/contact_sheet.h"

#include <algorithm>

#include <fmt/format.h>

#include "cli/report/canvas.h"

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

}  // namespace

Picture contact_sheet(const std::vector<ComparedFrame>& frames) {
  std::vector<std::string> models, lights;
  for (const ComparedFrame& frame : frames) {
    place_of(models, frame.model);
    place_of(lights, frame.light);
  }
  const int width = frames.front().picture.width, height = frames.front().picture.height;
  const int row = height + kLabel + kGap;
  Canvas canvas(static_cast<int>(lights.size()) * (width + kGap) + kGap,
                kHeader + static_cast<int>(models.size()) * row + kGap, kGround);
  for (size_t i = 0; i < lights.size(); ++i) {
    const std::string text = "light: " + lights[i];
    const int x = kGap + static_cast<int>(i) * (width + kGap);
    canvas.text(x + (width - Canvas::text_width(text)) / 2, 10, text, kInk);
  }
  for (size_t m = 0; m < models.size(); ++m) {
    for (size_t i = 0; i < lights.size(); ++i) {
      canvas.fill(kGap + static_cast<int>(i) * (width + kGap), kHeader + static_cast<int>(m) * row + kLabel,
                  width, height, kEmpty);
    }
    canvas.text(kGap + 2, kHeader + static_cast<int>(m) * row + 6, models[m], kInk);
  }
  for (const ComparedFrame& frame : frames) {
    const int x = kGap + place_of(lights, frame.light) * (width + kGap);
    const int y = kHeader + place_of(models, frame.model) * row;
    canvas.draw(x, y + kLabel, frame.picture);
    const std::string figures = fmt::format("{:.1f} CPU s", frame.cpu_s);
    canvas.text(x + width - Canvas::text_width(figures, 1) - 4, y + 12, figures, kFaint, 1);
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
