// SPDX-License-Identifier: Apache-2.0
#include "lod/fewer_points.h"

#include <algorithm>
#include <cmath>

namespace pelage {
namespace {

// From the fewest on.
constexpr uint32_t kFewerPoints[] = {4, 5};

bool stays_within(const PointFit& fit, const Strands& strands, size_t strand, float tolerance) {
  for (int key = 0; key < strands.motion_keys(); ++key) {
    if (!fit.stays_within(&strands.points(key)[size_t(strands.first_point(strand)) * 4], tolerance))
      return false;
  }
  return true;
}

/// Weighted sums of rows of `width` floats.
void combine(std::span<const float> weights, const float* rows, size_t width, float* out) {
  std::fill_n(out, width, 0.0f);
  for (size_t p = 0; p < weights.size(); ++p) {
    for (size_t c = 0; c < width; ++c) out[c] += weights[p] * rows[p * width + c];
  }
}

/// Limits overshoot of values fitted at the points of one strand, `width` per point: moves all of them
/// towards their mean over the strand, by a common factor, until each lies within the range of the values
/// they were fitted to. Colours keep their mean and hue; clamped one by one, bright bands would lose their
/// strongest channel.
void limit(std::span<float> values, std::span<const float> fitted_to, size_t width) {
  const size_t points = values.size() / width;
  std::vector<float> means(width, 0.0f);
  for (size_t p = 0; p < points; ++p) {
    const float part = (p == 0 || p + 1 == points ? 0.5f : 1.0f) / static_cast<float>(points - 1);
    for (size_t c = 0; c < width; ++c) means[c] += part * values[p * width + c];
  }
  std::vector<float> low(fitted_to.begin(), fitted_to.begin() + static_cast<std::ptrdiff_t>(width));
  std::vector<float> high = low;
  for (size_t i = 0; i < fitted_to.size(); ++i) {
    low[i % width] = std::min(low[i % width], fitted_to[i]);
    high[i % width] = std::max(high[i % width], fitted_to[i]);
  }
  float keep = 1;
  for (size_t i = 0; i < values.size(); ++i) {
    const float off = values[i] - means[i % width];
    const float room = off > 0 ? high[i % width] - means[i % width] : low[i % width] - means[i % width];
    if (std::abs(off) > std::abs(room)) keep = std::min(keep, std::max(0.0f, room / off));
  }
  for (size_t i = 0; i < values.size(); ++i) {
    const size_t c = i % width;
    values[i] = std::clamp(means[c] + keep * (values[i] - means[c]), low[c], high[c]);
  }
}

}  // namespace

const PointFit* FewerPoints::choose(const Strands& strands, size_t strand, float tolerance) {
  const uint32_t from = strands.strand_points(strand);
  for (const uint32_t to : kFewerPoints) {
    if (to >= from || !(tolerance > 0)) break;
    auto found = fits_.find({from, to});
    if (found == fits_.end()) found = fits_.try_emplace({from, to}, from, to).first;
    if (stays_within(found->second, strands, strand, tolerance)) return &found->second;
  }
  return nullptr;
}

Strands with_fewer_points(Strands strands, std::span<const float> tolerance) {
  return FewerPoints().refit(std::move(strands), tolerance);
}

Strands FewerPoints::refit(Strands strands, std::span<const float> tolerance) {
  if (strands.basis() != CurveBasis::kPinnedBSpline) return strands;
  std::vector<const PointFit*> fits(strands.strand_count());
  StrandArrays fewer;
  fewer.first_point.reserve(fits.size() + 1);
  fewer.first_point.push_back(0);
  for (size_t s = 0; s < fits.size(); ++s) {
    fits[s] = choose(strands, s, tolerance[s]);
    fewer.first_point.push_back(fewer.first_point.back() +
                                (fits[s] ? static_cast<uint32_t>(fits[s]->to()) : strands.strand_points(s)));
  }
  const size_t total = fewer.first_point.back();
  if (total == strands.point_count()) return strands;

  fewer.motion_keys = strands.motion_keys();
  fewer.points.resize(static_cast<size_t>(fewer.motion_keys) * total * 4);
  for (int key = 0; key < fewer.motion_keys; ++key) {
    for (size_t s = 0; s < fits.size(); ++s) {
      const float* from = &strands.points(key)[size_t(strands.first_point(s)) * 4];
      float* to = &fewer.points[(static_cast<size_t>(key) * total + fewer.first_point[s]) * 4];
      if (!fits[s]) {
        std::copy_n(from, size_t(strands.strand_points(s)) * 4, to);
        continue;
      }
      for (size_t row = 0; row < fits[s]->to(); ++row, to += 4) {
        combine(fits[s]->curve(row), from, 4, to);
        to[3] = std::max(to[3], 0.0f);
      }
    }
  }
  for (const StrandAttribute& old : strands.attributes()) {
    StrandAttribute attribute{old.name, old.frequency, old.components, {}};
    if (old.frequency != AttributeClass::kPerPoint) {
      attribute.values = old.values;
    } else {
      const auto width = static_cast<size_t>(old.components);
      attribute.values.resize(total * width);
      for (size_t s = 0; s < fits.size(); ++s) {
        const float* from = &old.values[strands.first_point(s) * width];
        float* to = &attribute.values[fewer.first_point[s] * width];
        if (!fits[s]) {
          std::copy_n(from, strands.strand_points(s) * width, to);
          continue;
        }
        for (size_t row = 0; row < fits[s]->to(); ++row)
          combine(fits[s]->values(row), from, width, to + row * width);
        limit({to, fits[s]->to() * width}, {from, strands.strand_points(s) * width}, width);
      }
    }
    fewer.attributes.push_back(std::move(attribute));
  }
  StrandArrays arrays = std::move(strands).release();
  fewer.ids = std::move(arrays.ids);
  fewer.roots = std::move(arrays.roots);
  fewer.root_uv = std::move(arrays.root_uv);
  return Strands(std::move(fewer));
}

}  // namespace pelage
