// SPDX-License-Identifier: Apache-2.0
#include "lab/report/canvas.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace pelage {

double text_width(std::string_view text, double size) {
  const auto characters = std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; });
  return 6.3 / 11.5 * size * static_cast<double>(characters);
}

Canvas::Canvas(int width, int height, Color ground) {
  PELAGE_CHECK(width > 0 && height > 0);
  picture_.width = width;
  picture_.height = height;
  picture_.pixels.resize(static_cast<size_t>(width) * static_cast<size_t>(height) * 3);
  fill(0, 0, width, height, ground);
}

void Canvas::blend(int x, int y, Color color, double share) {
  if (x < 0 || y < 0 || x >= picture_.width || y >= picture_.height) return;
  unsigned char* pixel = &picture_.pixels[3 * (static_cast<size_t>(y) * static_cast<size_t>(picture_.width) +
                                               static_cast<size_t>(x))];
  for (size_t c = 0; c < 3; ++c)
    pixel[c] = static_cast<unsigned char>(std::lround(pixel[c] + share * (color[c] - pixel[c])));
}

void Canvas::fill(int x, int y, int width, int height, Color color) {
  for (int v = y; v < y + height; ++v) {
    for (int u = x; u < x + width; ++u) blend(u, v, color, 1);
  }
}

void Canvas::draw(int x, int y, const Picture& picture) {
  const auto channels = static_cast<size_t>(picture.channels);
  for (int v = 0; v < picture.height; ++v) {
    for (int u = 0; u < picture.width; ++u) {
      const unsigned char* from =
          &picture.pixels[channels * (static_cast<size_t>(v) * static_cast<size_t>(picture.width) +
                                      static_cast<size_t>(u))];
      blend(x + u, y + v, channels == 1 ? Color{*from, *from, *from} : Color{from[0], from[1], from[2]}, 1);
    }
  }
}

void Canvas::line(double x0, double y0, double x1, double y1, Color color) {
  constexpr double kHalfWidth = 0.75;
  const double dx = x1 - x0, dy = y1 - y0, length2 = std::max(dx * dx + dy * dy, 1e-12);
  if (!std::isfinite(length2)) return;
  const int left = static_cast<int>(std::floor(std::max(0.0, std::min(x0, x1) - 2)));
  const int right = static_cast<int>(std::ceil(std::min(picture_.width - 1.0, std::max(x0, x1) + 2)));
  const int top = static_cast<int>(std::floor(std::max(0.0, std::min(y0, y1) - 2)));
  const int bottom = static_cast<int>(std::ceil(std::min(picture_.height - 1.0, std::max(y0, y1) + 2)));
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      const double px = x + 0.5 - x0, py = y + 0.5 - y0;
      const double t = std::clamp((px * dx + py * dy) / length2, 0.0, 1.0);
      const double distance = std::hypot(px - t * dx, py - t * dy);
      blend(x, y, color, std::clamp(kHalfWidth + 0.5 - distance, 0.0, 1.0));
    }
  }
}

}  // namespace pelage
