// SPDX-License-Identifier: Apache-2.0
#include "lod/fewer_points.h"

#include <algorithm>
#include <map>

#include "lod/point_fit.h"

namespace pelage {
namespace {

// From the fewest on.
constexpr uint32_t kFewerPoints[] = {4, 5};

bool stays_within(const PointFit& fit, const Strands& strands, size_t strand, float tolerance) {
  const float limit = tolerance * tolerance;
  for (int key = 0; key < strands.motion_keys(); ++key) {
    const float* points = &strands.points(key)[size_t(strands.first_point(strand)) * 4];
    for (size_t row = 0; row < fit.error_rows(); ++row) {
      const std::span<const float> weights = fit.error(row);
      float off[3] = {};
      for (size_t p = 0; p < weights.size(); ++p) {
        for (size_t axis = 0; axis < 3; ++axis) off[axis] += weights[p] * points[4 * p + axis];
      }
      if (!(off[0] * off[0] + off[1] * off[1] + off[2] * off[2] <= limit)) return false;
    }
  }
  return true;
}

/// Which number of points each strand gets.
class Choice {
 public:
  const PointFit* fit(const Strands& strands, size_t strand, float tolerance) {
    const uint32_t from = strands.strand_points(strand);
    for (const uint32_t to : kFewerPoints) {
      if (to >= from || !(tolerance > 0)) break;
      auto found = fits_.find({from, to});
      if (found == fits_.end()) found = fits_.try_emplace({from, to}, from, to).first;
      if (stays_within(found->second, strands, strand, tolerance)) return &found->second;
    }
    return nullptr;
  }

 private:
  std::map<std::pair<uint32_t, uint32_t>, PointFit> fits_;
};

/// Weighted sums of rows of `width` floats.
void combine(std::span<const float> weights, const float* rows, size_t width, float* out) {
  std::fill_n(out, width, 0.0f);
  for (size_t p = 0; p < weights.size(); ++p) {
    for (size_t c = 0; c < width; ++c) out[c] += weights[p] * rows[p * width + c];
  }
}

}  // namespace

Strands with_fewer_points(Strands strands, std::span<const float> tolerance) {
  if (strands.basis() != CurveBasis::kPinnedBSpline) return strands;
  Choice choice;
  std::vector<const PointFit*> fits(strands.strand_count());
  StrandArrays fewer;
  fewer.first_point.reserve(fits.size() + 1);
  fewer.first_point.push_back(0);
  for (size_t s = 0; s < fits.size(); ++s) {
    fits[s] = choice.fit(strands, s, tolerance[s]);
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
        const auto [low, high] = std::minmax_element(from, from + strands.strand_points(s) * width);
        for (size_t row = 0; row < fits[s]->to(); ++row, to += width) {
          combine(fits[s]->values(row), from, width, to);
          for (size_t c = 0; c < width; ++c) to[c] = std::clamp(to[c], *low, *high);
        }
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
