// SPDX-License-Identifier: Apache-2.0
#include "render/light/environment_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "base/error.h"
#include "render/light/guided_cdf.h"
#include "render/sampling/warp.h"

namespace pelage {

namespace {

constexpr double kExactPi = std::numbers::pi;
/// Side length of the blocks of texels that are read at once: the largest cell, and a tile of tiled textures.
constexpr int kBlockTexels = 64;

int divided_up(int a, int b) { return (a + b - 1) / b; }

bool is_finite_texel(const Rgb& c) { return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z); }

/// One of a few entries, selected in proportion to their weights, which must not all be zero. `rest`: `u`
/// rescaled to [0, 1) within it.
struct DiscreteSample {
  int index = 0;
  float rest = 0;
};
DiscreteSample sample_discrete(const double* weights, int count, float u) {
  double total = 0;
  for (int i = 0; i < count; ++i) total += weights[i];
  double left = static_cast<double>(u) * total;
  DiscreteSample choice;
  for (int i = 0; i < count; ++i) {
    if (!(weights[i] > 0)) continue;
    choice = {i, std::clamp(static_cast<float>(left / weights[i]), 0.0f, kBelowOne)};
    if (left < weights[i]) break;
    left -= weights[i];  // the last one gets the rounding remainder
  }
  return choice;
}

}  // namespace

int EnvironmentMap::cell_side(int width, int height, int64_t max_cells) {
  int side = 1;
  while (side < kBlockTexels && int64_t(divided_up(width, side)) * divided_up(height, side) > max_cells)
    side *= 2;
  return side;
}

size_t EnvironmentMap::bytes(int width, int height, int cell) {
  const auto columns = static_cast<size_t>(divided_up(width, cell));
  const auto rows = static_cast<size_t>(divided_up(height, cell));
  return (static_cast<size_t>(height) + 1) * sizeof(double) + (rows + columns * rows) * sizeof(float) +
         (guide_size(rows) + guide_size(columns) * rows) * sizeof(uint32_t);
}

size_t EnvironmentMap::bytes_for(int width, int height, int64_t max_cells) {
  return bytes(width, height, cell_side(width, height, max_cells));
}

EnvironmentMap::EnvironmentMap(std::shared_ptr<const Texture> image, const Rgb& factor,
                               const std::function<void()>& check_stop, int64_t max_cells)
    : image_(std::move(image)), factor_(factor) {
  const int width = image_->width(), height = image_->height();
  if (width < 1 || height < 1 || image_->channels() < 1) {
    throw Error(ErrorKind::kInput, "the environment image is empty");
  }
  cell_ = cell_side(width, height, max_cells);
  columns_ = divided_up(width, cell_);
  rows_ = divided_up(height, cell_);
  row_cosine_.resize(static_cast<size_t>(height) + 1);
  for (size_t y = 0; y < row_cosine_.size(); ++y) {
    row_cosine_[y] = std::cos(kExactPi * static_cast<double>(y) / static_cast<double>(height));
  }
  const auto columns = static_cast<size_t>(columns_), rows = static_cast<size_t>(rows_);
  row_cdf_.resize(rows);
  row_guide_.resize(guide_size(rows));
  column_cdf_.resize(columns * rows);
  column_guide_size_ = guide_size(columns);
  column_guide_.resize(column_guide_size_ * rows);
  for (int y = 0; y < height; y += kBlockTexels) measure_band(y, check_stop);
  for (size_t y = 0; y < rows; ++y) {
    const double sum = make_guided_cdf({&column_cdf_[y * columns], columns},
                                       {&column_guide_[y * column_guide_size_], column_guide_size_});
    const int top = static_cast<int>(y) * cell_, bottom = std::min(top + cell_, height);
    double solid_angle = 0;  // of a column of texels in the cells
    for (int row = top; row < bottom; ++row) solid_angle += texel_solid_angle(row);
    const double power = sum * solid_angle;
    row_cdf_[y] = static_cast<float>(power);
    power_ += power;
  }
  make_guided_cdf(row_cdf_, row_guide_);
  inverse_power_ = power_ > 0 ? static_cast<float>(1 / power_) : 0.0f;
}

/// Stores in column_cdf_ the emission of each cell of kBlockTexels rows of texels: the sum over its columns
/// of the luminance, averaged over solid angle.
void EnvironmentMap::measure_band(int row, const std::function<void()>& check_stop) {
  const int height = std::min(kBlockTexels, image_->height() - row);
  std::vector<double> weights(static_cast<size_t>(height));  // of rows within their cells
  for (int y = 0; y < height; ++y) {
    const int top = (row + y) / cell_ * cell_, bottom = std::min(top + cell_, image_->height());
    double solid_angle = 0;
    for (int i = top; i < bottom; ++i) solid_angle += texel_solid_angle(i);
    weights[static_cast<size_t>(y)] = texel_solid_angle(row + y) / solid_angle;
  }
  std::vector<Rgb> block(size_t(kBlockTexels) * kBlockTexels);
  std::vector<double> sums;
  for (int x = 0; x < image_->width(); x += kBlockTexels) {
    if (check_stop) check_stop();
    const int width = std::min(kBlockTexels, image_->width() - x);
    image_->colors(x, row, width, height, block.data());
    const int across = divided_up(width, cell_);
    sums.assign(static_cast<size_t>(across) * static_cast<size_t>(divided_up(height, cell_)), 0);
    for (int i = 0; i < width * height; ++i) {
      const int tx = i % width, ty = i / width;
      const Rgb& color = block[static_cast<size_t>(i)];
      if (!is_finite_texel(color)) {
        throw Error(ErrorKind::kInput, "the environment image is not finite at pixel " +
                                           std::to_string(x + tx) + ", " + std::to_string(row + ty));
      }
      sums[static_cast<size_t>(ty / cell_ * across + tx / cell_)] +=
          static_cast<double>(luminance(shown(color))) * weights[static_cast<size_t>(ty)];
    }
    for (int i = 0; i < static_cast<int>(sums.size()); ++i) {
      const size_t at = static_cast<size_t>(row / cell_ + i / across) * static_cast<size_t>(columns_) +
                        static_cast<size_t>(x / cell_ + i % across);
      column_cdf_[at] = static_cast<float>(sums[static_cast<size_t>(i)]);
    }
  }
}

double EnvironmentMap::texel_solid_angle(int row) const {
  return 2 * kExactPi / image_->width() * (row_cosine_[row] - row_cosine_[row + 1]);
}

Rgb EnvironmentMap::shown(const Rgb& stored) const {
  const auto positive = [](float v) { return std::max(0.0f, v); };
  return factor_ * Rgb(positive(stored.x), positive(stored.y), positive(stored.z));
}

/// Selects a texel of a cell in proportion to its emission: first its row, then the texel.
EnvironmentMap::Place EnvironmentMap::place_in_cell(size_t column, size_t row, const V2f& rest) const {
  const int x = static_cast<int>(column) * cell_, y = static_cast<int>(row) * cell_;
  if (cell_ == 1) return {{x, y}, rest};
  const int width = std::min(cell_, image_->width() - x), height = std::min(cell_, image_->height() - y);
  std::array<Rgb, size_t(kBlockTexels) * kBlockTexels> colors;
  image_->colors(x, y, width, height, colors.data());
  std::array<double, kBlockTexels> by_row{}, in_row{};
  const auto weight = [&](int i, int j) {
    return static_cast<double>(luminance(shown(colors[static_cast<size_t>(j * width + i)])));
  };
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) by_row[static_cast<size_t>(j)] += weight(i, j);
    by_row[static_cast<size_t>(j)] *= texel_solid_angle(y + j);
  }
  const DiscreteSample drawn_row = sample_discrete(by_row.data(), height, rest.y);
  for (int i = 0; i < width; ++i) in_row[static_cast<size_t>(i)] = weight(i, drawn_row.index);
  const DiscreteSample drawn_column = sample_discrete(in_row.data(), width, rest.x);
  return {{x + drawn_column.index, y + drawn_row.index}, {drawn_column.rest, drawn_row.rest}};
}

EnvironmentMap::Sample EnvironmentMap::sample(const V2f& u) const {
  const GuidedSample row = sample_guided(row_cdf_, row_guide_, u.y);
  const auto columns = static_cast<size_t>(columns_);
  const GuidedSample column =
      sample_guided({&column_cdf_[row.index * columns], columns},
                    {&column_guide_[row.index * column_guide_size_], column_guide_size_}, u.x);
  const auto [texel, rest] = place_in_cell(column.index, row.index, {column.rest, row.rest});
  const double top = row_cosine_[texel.y], bottom = row_cosine_[texel.y + 1];
  const double cosine = top + rest.y * (bottom - top);
  const double sine = std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)));
  const double turn = (static_cast<double>(texel.x) + rest.x) / static_cast<double>(image_->width()) - 0.5;
  const double phi = 2 * kExactPi * turn;
  return {V3f(static_cast<float>(sine * std::sin(phi)), static_cast<float>(cosine),
              static_cast<float>(-sine * std::cos(phi))),
          texel};
}

V2f EnvironmentMap::place_of(const V3f& direction) const {
  const float turn = std::atan2(direction.x, -direction.z) / (2.0f * kPi) + 0.5f;
  const float sine = std::sqrt(direction.x * direction.x + direction.z * direction.z);
  const float polar = std::atan2(sine, direction.y) / kPi;
  return {turn * static_cast<float>(image_->width()), polar * static_cast<float>(image_->height())};
}

EnvironmentMap::Texel EnvironmentMap::texel_of(const V3f& direction) const {
  const V2f place = place_of(direction);
  return {std::clamp(static_cast<int>(place.x), 0, image_->width() - 1),
          std::clamp(static_cast<int>(place.y), 0, image_->height() - 1)};
}

Rgb EnvironmentMap::interpolated(const V3f& direction) const {
  const V2f place = place_of(direction) - V2f(0.5f);
  const int width = image_->width(), left = static_cast<int>(std::floor(place.x));
  const int top = static_cast<int>(std::floor(place.y));
  const float s = place.x - static_cast<float>(left), t = place.y - static_cast<float>(top);
  const auto row = [&](int y) {
    const int inside = std::clamp(y, 0, image_->height() - 1);
    return radiance({(left + width) % width, inside}) * (1 - s) + radiance({(left + 1) % width, inside}) * s;
  };
  return row(top) * (1 - t) + row(top + 1) * t;
}

}  // namespace pelage
