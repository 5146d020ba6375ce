// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "image/field_node.h"

// The kinds of fields (see image/field.h).

namespace pelage {

enum class RampAxis { kStrand, kX, kY, kZ, kU, kV };
template <>
struct EnumNames<RampAxis> {
  static constexpr const char* names[] = {"strand", "x", "y", "z", "u", "v"};
};

struct RampKnot {
  float at = 0;
  Rgb value{0};
};
template <>
struct ValueReader<RampKnot> {
  static bool read(const Value&, const KeyOptions&, RampKnot& out, Problems&);
  static std::string type_name() { return "[number, number or colour]"; }
  static std::string print(const RampKnot& knot);
};

struct Ramp {
  RampAxis along = RampAxis::kStrand;
  std::vector<RampKnot> knots;  ///< by increasing `at`; two knots with the same `at` make a step
  static const Schema<Ramp>& schema();
};

/// Returns the value of a curve through knots, linear between them and constant outside.
Rgb on_curve(std::span<const RampKnot> knots, float x);

struct NoiseShape {
  float frequency = 1;
  float amplitude = 1;
  float offset = 0;
  int seed = 0;
  static const Schema<NoiseShape>& schema();
};

Field ramp_field(Ramp ramp);
Field noise_field(NoiseShape noise);
Field attribute_field(std::string name, SourcePosition named_at = {});

/// Returns the number as a scene writes it.
std::string print_number(float v);

}  // namespace pelage
