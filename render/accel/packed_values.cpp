// SPDX-License-Identifier: Apache-2.0
#include "render/accel/packed_values.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace pelage {
namespace {

constexpr float kPackedSteps = 65535.0f;

bool is_unit(float x) { return x >= 0.0f && x <= 1.0f; }
uint32_t step_of(float x) { return static_cast<uint32_t>(std::lround(x * kPackedSteps)); }

}  // namespace

float packed_value(float x) { return is_unit(x) ? static_cast<float>(step_of(x)) / kPackedSteps : x; }

Precision coarsest_precision(std::span<const float> values) {
  Precision precision = Precision::kUnorm8;
  for (float x : values) {
    // Compared bitwise, because -0 must differ from 0.
    if (!is_unit(x) || std::bit_cast<uint32_t>(packed_value(x)) != std::bit_cast<uint32_t>(x)) {
      return Precision::kFloat;
    }
    if (step_of(x) % 257 != 0) precision = Precision::kUnorm16;
  }
  return precision;
}

void pack_values(std::span<const float> values, Precision precision, std::byte* out) {
  switch (precision) {
    case Precision::kFloat:
      std::copy(values.begin(), values.end(), reinterpret_cast<float*>(out));
      break;
    case Precision::kUnorm16:
      for (float x : values) *reinterpret_cast<uint16_t*>(out) = static_cast<uint16_t>(step_of(x)), out += 2;
      break;
    case Precision::kUnorm8:
      for (float x : values) *reinterpret_cast<uint8_t*>(out++) = static_cast<uint8_t>(step_of(x) / 257);
      break;
  }
}

}  // namespace pelage
