// SPDX-License-Identifier: Apache-2.0
#include "image/field_nodes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <fmt/format.h>

#include "base/check.h"

namespace pelage {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct RampNode final : Field::Node {
  explicit RampNode(Ramp r) : ramp(std::move(r)) {}

  float position(const FieldPoint& p) const {
    switch (ramp.along) {
      case RampAxis::kStrand:
        return p.along;
      case RampAxis::kX:
        return p.rest.x;
      case RampAxis::kY:
        return p.rest.y;
      case RampAxis::kZ:
        return p.rest.z;
      case RampAxis::kU:
        return p.u;
      case RampAxis::kV:
        return p.v;
    }
    return 0;
  }
  Rgb color(const FieldPoint& p) const override { return on_curve(ramp.knots, position(p)); }
  float value(const FieldPoint& p) const override { return color(p).x; }
  FieldDependence dependence() const override {
    const bool strand = ramp.along == RampAxis::kStrand;
    const bool rest = !strand && ramp.along != RampAxis::kU && ramp.along != RampAxis::kV;
    return {.along = strand, .surface = !strand, .attributes = false, .rest = rest};
  }
  std::pair<float, float> range() const override {
    const auto less = [](const RampKnot& a, const RampKnot& b) { return a.value.x < b.value.x; };
    const auto [low, high] = std::minmax_element(ramp.knots.begin(), ramp.knots.end(), less);
    return {low->value.x, high->value.x};
  }
  std::string print() const override {
    return fmt::format("{{ramp: {{along: {}, knots: {}}}}}", ValueReader<RampAxis>::print(ramp.along),
                       ValueReader<std::vector<RampKnot>>::print(ramp.knots));
  }

  Ramp ramp;
};

struct NoiseNode final : Field::Node {
  explicit NoiseNode(NoiseShape n) : noise(n) {}
  float value(const FieldPoint& p) const override {
    return noise.offset +
           noise.amplitude * perlin_noise(p.rest * noise.frequency, static_cast<uint32_t>(noise.seed));
  }
  Rgb color(const FieldPoint& p) const override { return Rgb(value(p)); }
  FieldDependence dependence() const override {
    return {.along = false, .surface = true, .attributes = false, .rest = true};
  }
  std::pair<float, float> range() const override {
    return {noise.offset - std::abs(noise.amplitude), noise.offset + std::abs(noise.amplitude)};
  }
  std::string print() const override {
    return fmt::format("{{noise: {{frequency: {}, amplitude: {}, offset: {}, seed: {}}}}}",
                       print_number(noise.frequency), print_number(noise.amplitude),
                       print_number(noise.offset), noise.seed);
  }

  NoiseShape noise;
};

struct AttributeNode final : Field::Node {
  AttributeNode(std::string n, SourcePosition p) : name(std::move(n)), place(std::move(p)) {}
  float value(const FieldPoint& p) const override { return color(p).x; }
  Rgb color(const FieldPoint& p) const override {
    for (const FieldAttribute& attribute : p.attributes) {
      if (attribute.name == name) return attribute.value;
    }
    return Rgb(0);
  }
  FieldDependence dependence() const override { return {.attributes = true}; }
  std::pair<float, float> range() const override {
    if (name == "random" || name == "clump") return {0.0f, 1.0f};
    return {-kInfinity, kInfinity};
  }
  std::string print() const override { return fmt::format("{{attribute: {}}}", name); }
  void collect_attributes(std::vector<std::string>& names) const override {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  const SourcePosition* place_of_attribute(std::string_view asked) const override {
    return asked == name ? &place : nullptr;
  }

  std::string name;
  SourcePosition place;
};

}  // namespace

std::string print_number(float v) { return ValueReader<float>::print(v); }

Rgb on_curve(std::span<const RampKnot> knots, float x) {
  const auto after = std::upper_bound(knots.begin(), knots.end(), x,
                                      [](float at, const RampKnot& knot) { return at < knot.at; });
  if (after == knots.begin()) return after->value;
  if (after == knots.end()) return knots.back().value;
  const RampKnot& a = *(after - 1);
  const float t = (x - a.at) / (after->at - a.at);
  return a.value * (1.0f - t) + after->value * t;
}

Field ramp_field(Ramp ramp) { return Field(std::make_shared<RampNode>(std::move(ramp))); }
Field noise_field(NoiseShape noise) { return Field(std::make_shared<NoiseNode>(noise)); }
Field attribute_field(std::string name, SourcePosition named_at) {
  return Field(std::make_shared<AttributeNode>(std::move(name), std::move(named_at)));
}
}  // namespace pelage
