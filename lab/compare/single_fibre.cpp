// SPDX-License-Identifier: Apache-2.0
#include "lab/compare/single_fibre.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lab/report/canvas.h"
#include "render/sampling/warp.h"

namespace pelage {
namespace {

constexpr int kPaths = 200000;

constexpr Canvas::Color kWhite = {255, 255, 255}, kDarkInk = {30, 30, 30}, kPale = {205, 205, 205},
                        kModelInk = {31, 95, 180}, kTracedInk = {214, 96, 20};

constexpr int kCellSize = 5, kLeft = 150, kTop = 44, kPanelGap = 16, kPolar = 232;
constexpr int kMapWidth = kCellSize * FibreHistogram::kAzimuths,
              kMapHeight = kCellSize * FibreHistogram::kSines;
constexpr int kRow = kPolar + kPanelGap;
constexpr double kTitleSize = 16, kSmallSize = 12;  // font sizes

/// Black through blue, red and yellow to white, with uniformly increasing lightness.
Canvas::Color heat(double x) {
  constexpr std::array<std::array<double, 3>, 6> kKnots = {
      {{0, 0, 0}, {40, 20, 110}, {140, 30, 125}, {225, 80, 70}, {250, 180, 60}, {255, 255, 220}}};
  const double place = std::clamp(x, 0.0, 1.0) * (kKnots.size() - 1);
  const auto i = std::min(static_cast<size_t>(place), kKnots.size() - 2);
  Canvas::Color color;
  for (size_t c = 0; c < 3; ++c) {
    const double value = kKnots[i][c] + (place - static_cast<double>(i)) * (kKnots[i + 1][c] - kKnots[i][c]);
    color[c] = static_cast<unsigned char>(std::lround(value));
  }
  return color;
}

/// Energies of cells, over four decades below the total energy distributed evenly over thirty cells.
void draw_map(Canvas& canvas, int x, int y, const FibreHistogram& histogram) {
  constexpr double kMax = 1.0 / 30, kDecades = 4;
  for (int i = 0; i < FibreHistogram::kSines; ++i) {
    for (int j = 0; j < FibreHistogram::kAzimuths; ++j) {
      const double value = histogram.cell(i, j) / kMax;
      const double shade = value > 0 ? 1 + std::log10(value) / kDecades : 0;
      canvas.fill(x + j * kCellSize, y + (FibreHistogram::kSines - 1 - i) * kCellSize, kCellSize, kCellSize,
                  heat(shade));
    }
  }
}

void draw_polar(Canvas& canvas, int x, int y, const SingleFibre& fibre) {
  const std::vector<double> a = fibre.by_model.by_azimuth(), b = fibre.traced.by_azimuth();
  const double max = std::max(*std::max_element(a.begin(), a.end()), *std::max_element(b.begin(), b.end()));
  const double radius = 0.5 * kPolar - 4, cx = x + 0.5 * kPolar, cy = y + 0.5 * kPolar;
  constexpr int kCorners = 72;
  for (int k = 0; k < kCorners; ++k) {
    const double from = 2 * kPi * k / kCorners, to = 2 * kPi * (k + 1) / kCorners;
    canvas.line(cx + radius * std::cos(from), cy + radius * std::sin(from), cx + radius * std::cos(to),
                cy + radius * std::sin(to), kPale);
  }
  canvas.line(cx - radius, cy, cx + radius, cy, kPale);
  canvas.line(cx, cy - radius, cx, cy + radius, kPale);
  const auto draw = [&](const std::vector<double>& values, Canvas::Color color) {
    // Square roots, so that weak lobes are visible beside the bright one behind the fibre.
    const auto point = [&](size_t k) {
      const size_t i = k % values.size();
      const double phi =
          2 * kPi * ((static_cast<double>(i) + 0.5) / static_cast<double>(values.size()) - 0.5);
      const double r = max > 0 ? radius * std::sqrt(values[i] / max) : 0;
      return std::pair(cx + r * std::cos(phi), cy - r * std::sin(phi));
    };
    for (size_t k = 0; k < values.size(); ++k) {
      const auto [x0, y0] = point(k);
      const auto [x1, y1] = point(k + 1);
      canvas.line(x0, y0, x1, y1, color);
    }
  };
  draw(b, kTracedInk);
  draw(a, kModelInk);
}

void center(Canvas& canvas, int x, int width, int y, const std::string& text, Canvas::Color color) {
  canvas.label({x + 0.5 * width, y + 13.0, text, TextAnchor::kMiddle, color, kTitleSize});
}

}  // namespace

double SingleFibre::azimuth_distance() const {
  return total_variation(by_model.by_azimuth(), traced.by_azimuth());
}
double SingleFibre::inclination_distance() const {
  return total_variation(by_model.by_sine(), traced.by_sine());
}

SingleFibre compare_single_fibre(const std::string& model, const MaterialParams& material, const Job& job) {
  SingleFibre fibre;
  fibre.model = model;
  const FibreOracle oracle = fibre_oracle(material, SingleFibre::kAbsorption),
                    white = fibre_oracle(material, 0);
  fibre.opaque = oracle.opaque;
  const auto look = [&] { job.check_stop(); };
  job.for_each(4, 1, [&](const WorkRange& range) {
    for (size_t i = range.begin; i < range.end; ++i) {
      if (i == 0) fibre.by_model = oracle.model(SingleFibre::kInclination, kPaths, look);
      if (i == 1) fibre.traced = oracle.trace(SingleFibre::kInclination, kPaths, look);
      if (i == 2) fibre.white_across = white.model(0, kPaths, look).total();
      if (i == 3) fibre.white_slanted = white.model(1, kPaths, look).total();
    }
  });
  return fibre;
}

Picture single_fibre_sheet(const std::vector<SingleFibre>& fibres) {
  const int map2 = kLeft + kMapWidth + kPanelGap, polar = map2 + kMapWidth + kPanelGap;
  Canvas canvas(polar + kPolar + kPanelGap, kTop + kRow * static_cast<int>(fibres.size()) + 30, kWhite);
  center(canvas, kLeft, kMapWidth, 14, "the model", kModelInk);
  center(canvas, map2, kMapWidth, 14, "light traced through the fibre", kTracedInk);
  center(canvas, polar, kPolar, 14, "around the fibre", kDarkInk);
  int y = kTop;
  for (const SingleFibre& fibre : fibres) {
    const int map_y = y + (kPolar - kMapHeight) / 2;
    const double middle = y + kPolar / 2;
    canvas.label({10, middle - 18, fibre.model, TextAnchor::kStart, kDarkInk, kTitleSize});
    canvas.label({10, middle + 2, fmt::format("energy {:.3f}", fibre.by_model.total()), TextAnchor::kStart,
                  kModelInk, kSmallSize});
    canvas.label({10, middle + 18, fmt::format("traced {:.3f}", fibre.traced.total()), TextAnchor::kStart,
                  kTracedInk, kSmallSize});
    draw_map(canvas, kLeft, map_y, fibre.by_model);
    draw_map(canvas, map2, map_y, fibre.traced);
    draw_polar(canvas, polar, y, fibre);
    y += kRow;
  }
  for (const int x : {kLeft, map2}) {
    center(canvas, x, kMapWidth, y, "phi: through | back | through", kDarkInk);
  }
  center(canvas, polar, kPolar, y, "through | back", kDarkInk);
  return canvas.picture();
}

}  // namespace pelage
