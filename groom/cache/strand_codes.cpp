// SPDX-License-Identifier: Apache-2.0
#include "groom/cache/strand_codes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

#include "base/hash.h"
#include "base/release.h"
#include "groom/cache/small_float.h"

namespace pelage {
namespace {

constexpr float kWidthsPerError = 20.0f;  // max error of a point, as a fraction of the strand's width

template <class T>
void append(std::vector<std::byte>& bytes, const T& value) {
  const auto from = std::as_bytes(std::span(&value, 1));
  bytes.insert(bytes.end(), from.begin(), from.end());
}

/// The number at index `i` of those written by `append`.
template <class T>
T at(const std::vector<std::byte>& bytes, size_t i) {
  T value;
  std::memcpy(&value, &bytes[i * sizeof(T)], sizeof(T));
  return value;
}

/// `part` of `whole` as an integer up to `max`.
float levels(float part, float whole, float max) { return whole > 0 ? std::round(part / whole * max) : 0.0f; }

}  // namespace

StrandCodes::StrandCodes(const StrandBatch& batch, const CodeOptions& options)
    : count(batch.count), points(batch.points.size()), color_rows(batch.colors.size()) {
  take_floats(batch);
  for (size_t s = 0; s < count; ++s) {
    append(columns[kClump], codes::clump_code(batch.clump[s]));
    clumped |= batch.clump[s] != unit_float(hash64(batch.ids[s], random_use("no clump")));
    for (size_t axis = 0; axis < 3; ++axis) has_base |= shape_row(axis)[s] != 0;
  }
  steps.resize(count);
  shape.resize(points * 3 * count);
  std::vector<bool> fits(count);
  for (size_t s = 0; s < count; ++s) {
    const bool widths = code_widths(s, options), colors = code_colors(s);
    fits[s] = code_shape(s) && widths && colors;
    plain |= !fits[s];
  }
  if (!plain) {
    release(floats);
    return;
  }
  for (size_t s = 0; s < count; ++s) {
    if (fits[s]) decode(s, options);
  }
  for (size_t i = kClump + 1; i < kColumns; ++i) columns[i] = {};
  release(steps);
  release(shape);
}

void StrandCodes::take_floats(const StrandBatch& batch) {
  floats.resize((points * 4 + color_rows * 3) * count);
  const std::array<const VectorRow*, 3> axes{&batch.rest.tangent, &batch.rest.bitangent, &batch.rest.normal};
  for (size_t p = 0; p < points; ++p) {
    const VectorRow& offset = batch.points[p].offset;
    for (size_t axis = 0; axis < 3; ++axis) {
      float* out = shape_row(p * 3 + axis);
      const VectorRow& along = *axes[axis];
      for (size_t s = 0; s < count; ++s)
        out[s] = offset[0][s] * along[0][s] + offset[1][s] * along[1][s] + offset[2][s] * along[2][s] + 0.0f;
    }
    std::copy_n(batch.points[p].radius.data(), count, radius_row(p));
  }
  for (size_t r = 0; r < color_rows * 3; ++r)
    std::copy_n(batch.colors[r / 3][r % 3].data(), count, color_row(r));
}

bool StrandCodes::code_shape(size_t s) {
  float width = 0, longest = 0, furthest = 0;
  for (size_t p = 0; p < points; ++p) width = std::max(width, 2.0f * radius_row(p)[s]);
  for (size_t r = 0; r < points * 3; ++r) {
    const float value = shape_row(r)[s], before = r >= 3 ? shape_row(r - 3)[s] : 0.0f;
    if (!std::isfinite(value)) return false;
    longest = std::max(longest, std::fabs(value - before));
    furthest = std::max(furthest, std::fabs(value));
  }
  const std::optional<uint16_t> code = small_float::not_below(longest / codes::kLargestStep);
  if (!code) return false;
  const float step = small_float::decode(*code);
  // Half a step along each axis, and the rounding of the sums.
  const float error = 0.8661f * step + 4e-7f * furthest;
  if (width > 0 && error * kWidthsPerError > width) return false;
  steps[s] = *code;
  float decoded[3] = {0, 0, 0};
  for (size_t r = 0; r < points * 3; ++r) {
    float& at = decoded[r % 3];
    const float rounded = step > 0 ? std::round((shape_row(r)[s] - at) / step) : 0.0f;
    const auto q = static_cast<int16_t>(std::clamp(rounded, -32767.0f, 32767.0f));
    shape[r * count + s] = q;
    at += static_cast<float>(q) * step;  // as the reader does
  }
  return true;
}

bool StrandCodes::code_widths(size_t s, const CodeOptions& options) {
  bool good = true;
  float widest = 0;
  for (size_t p = 0; p < points; ++p) {
    good &= radius_row(p)[s] >= 0;
    widest = std::max(widest, radius_row(p)[s]);
  }
  const std::optional<uint16_t> scale = small_float::nearest(widest);
  good &= scale.has_value();
  append(columns[kWidthScale], scale.value_or(0));
  for (size_t p = 0; p < points; ++p) {
    const float radius = good ? radius_row(p)[s] : 0.0f;
    if (options.one_width_profile) {
      append(columns[kWidthProfile], static_cast<uint16_t>(levels(radius, widest, 65535.0f)));
    } else {
      append(columns[kWidthProfile], static_cast<uint8_t>(levels(radius, widest, 255.0f)));
    }
  }
  return good;
}

bool StrandCodes::code_colors(size_t s) {
  if (color_rows == 0) return true;
  bool good = true;
  float largest[3] = {0, 0, 0};
  for (size_t r = 0; r < color_rows * 3; ++r) {
    good &= std::isfinite(color_row(r)[s]);
    largest[r % 3] = std::max(largest[r % 3], std::fabs(color_row(r)[s]));
  }
  const float max = std::max({largest[0], largest[1], largest[2]});
  const std::optional<uint16_t> scale = small_float::nearest(max);
  good &= scale.has_value();
  append(columns[kColorScale], scale.value_or(0));
  uint32_t hue = 0;
  for (int c = 0; c < 3 && good && max > 0; ++c)
    hue |= static_cast<uint32_t>(std::round(std::sqrt(largest[c] / max) * 1023.0f)) << (10 * c);
  append(columns[kColorHue], hue);
  for (size_t r = 0; r < color_rows * 3; ++r) {
    const float value = good ? color_row(r)[s] : 0.0f;
    append(columns[kColorProfile], static_cast<int16_t>(levels(value, largest[r % 3], 32767.0f)));
  }
  return good;
}

void StrandCodes::decode(size_t s, const CodeOptions& options) {
  const float step = small_float::decode(steps[s]);
  float point[3] = {0, 0, 0};
  for (size_t r = 0; r < points * 3; ++r) {
    point[r % 3] += static_cast<float>(shape[r * count + s]) * step;
    shape_row(r)[s] = point[r % 3];
  }
  for (size_t p = 0; p < points; ++p) {
    const size_t i = s * points + p;
    const float ratio = options.one_width_profile
                            ? codes::width_ratio(at<uint16_t>(columns[kWidthProfile], i))
                            : codes::width_ratio(at<uint8_t>(columns[kWidthProfile], i));
    radius_row(p)[s] = small_float::decode(at<uint16_t>(columns[kWidthScale], s)) * ratio;
  }
  for (size_t r = 0; r < color_rows * 3; ++r) {
    const float largest = small_float::decode(at<uint16_t>(columns[kColorScale], s)) *
                          codes::hue(at<uint32_t>(columns[kColorHue], s), static_cast<int>(r % 3));
    color_row(r)[s] =
        largest * codes::color_ratio(at<int16_t>(columns[kColorProfile], s * color_rows * 3 + r));
  }
}

}  // namespace pelage
