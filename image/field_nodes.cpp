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

std::string print_number(float v) { return ValueReader<float>::print(v); }

struct MapNode final : Field::Node {
  explicit MapNode(MapForm f) : form(std::move(f)) {}

  float map(float stored) const { return form.range.x + (form.range.y - form.range.x) * stored; }
  float value(const FieldPoint& p) const override {
    PELAGE_CHECK(texture != nullptr);
    return map(texture->channel(p.u, p.v, channel, form.wrap));
  }
  Rgb color(const FieldPoint& p) const override {
    if (form.channel) return Rgb(value(p));
    PELAGE_CHECK(texture != nullptr);
    const Rgb stored = texture->color(p.u, p.v, form.wrap);
    return {map(stored.x), map(stored.y), map(stored.z)};
  }
  FieldDependence dependence() const override { return {.surface = true}; }
  std::pair<float, float> range() const override {
    const float a = map(lowest), b = map(highest);
    return {std::min(a, b), std::max(a, b)};
  }
  std::string print() const override {
    std::string text = fmt::format("{{map: {}", form.map.path.string());
    if (form.channel) text += fmt::format(", channel: {}", ValueReader<MapChannel>::print(*form.channel));
    if (form.range != V2f(0, 1)) text += fmt::format(", range: {}", ValueReader<V2f>::print(form.range));
    if (form.space != ColorSpace::kAuto) text += ", space: " + ValueReader<ColorSpace>::print(form.space);
    if (form.wrap != TextureWrap::kClamp) text += ", wrap: " + ValueReader<TextureWrap>::print(form.wrap);
    return text + "}";
  }
  void collect_maps(std::vector<AssetPath>& maps) const override { maps.push_back(form.map); }
  std::shared_ptr<const Node> with_textures(TextureLibrary& textures) const override;

  MapForm form;
  std::shared_ptr<const Texture> texture;
  int channel = 0;
  float lowest = 0,
        highest = 1;  ///< of the stored values; until the map is loaded, of the values it should have
};

/// Index of a named channel in an image of `count` channels, -1 when there is none. Grey is used for r, g and
/// b.
int channel_index(MapChannel channel, int count) {
  const bool grey = count < 3;
  if (channel == MapChannel::kA) return count == 2 || count == 4 ? count - 1 : -1;
  return grey ? 0 : static_cast<int>(channel);
}

std::shared_ptr<const Field::Node> MapNode::with_textures(TextureLibrary& textures) const {
  auto loaded = std::make_shared<MapNode>(form);
  // A single channel is data (lengths, masks), which is not stored with a display's transfer curve.
  const bool is_data = form.channel && form.space == ColorSpace::kAuto;
  loaded->texture = textures.load(form.map, is_data ? ColorSpace::kLinear : form.space);
  const int channels = loaded->texture->channels();
  loaded->channel = channel_index(form.channel.value_or(MapChannel::kR), channels);
  if (loaded->channel < 0) {
    throw Error(ErrorKind::kInput, form.map.position,
                fmt::format("{}: has no channel 'a', only {}", form.map.path.string(), channels));
  }
  std::tie(loaded->lowest, loaded->highest) = loaded->texture->range(loaded->channel);
  return loaded;
}

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
  Rgb color(const FieldPoint& p) const override {
    const float x = position(p);
    const auto after = std::upper_bound(ramp.knots.begin(), ramp.knots.end(), x,
                                        [](float at, const RampKnot& knot) { return at < knot.at; });
    if (after == ramp.knots.begin()) return after->value;
    if (after == ramp.knots.end()) return ramp.knots.back().value;
    const RampKnot& a = *(after - 1);
    const float t = (x - a.at) / (after->at - a.at);
    return a.value * (1.0f - t) + after->value * t;
  }
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
  explicit NoiseNode(Noise n) : noise(n) {}
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

  Noise noise;
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

struct ProductNode final : Field::Node {
  explicit ProductNode(std::vector<Field> f) : factors(std::move(f)) {}
  float value(const FieldPoint& p) const override {
    float product = 1;
    for (const Field& factor : factors) product *= factor.value(p);
    return product;
  }
  Rgb color(const FieldPoint& p) const override {
    Rgb product(1);
    for (const Field& factor : factors) product *= factor.color(p);
    return product;
  }
  FieldDependence dependence() const override {
    FieldDependence all;
    for (const Field& factor : factors) {
      const FieldDependence d = factor.dependence();
      all = {all.along || d.along, all.surface || d.surface, all.attributes || d.attributes,
             all.rest || d.rest};
    }
    return all;
  }
  std::pair<float, float> range() const override {
    std::pair<float, float> all{1, 1};
    // An unlimited factor times one that is always 0 is 0.
    const auto times = [](float a, float b) { return a == 0 || b == 0 ? 0.0f : a * b; };
    for (const Field& factor : factors) {
      const auto [low, high] = factor.value_range();
      const auto ends = {times(all.first, low), times(all.first, high), times(all.second, low),
                         times(all.second, high)};
      all = std::minmax(ends);
    }
    return all;
  }
  std::string print() const override {
    return "{product: " + ValueReader<std::vector<Field>>::print(factors) + "}";
  }
  void collect_attributes(std::vector<std::string>& names) const override {
    for (const Field& factor : factors) factor.node().collect_attributes(names);
  }
  std::span<const Field> factors_of() const override { return factors; }
  void collect_maps(std::vector<AssetPath>& maps) const override {
    for (const Field& factor : factors) factor.node().collect_maps(maps);
  }
  std::shared_ptr<const Node> with_textures(TextureLibrary& textures) const override {
    auto loaded = std::make_shared<ProductNode>(factors);
    for (Field& factor : loaded->factors) factor = factor.with_textures(textures);
    return loaded;
  }

  std::vector<Field> factors;
};

struct ClampNode final : Field::Node {
  ClampNode(Field f, float l, float h) : field(std::move(f)), low(l), high(h) {}
  float limit(float v) const { return std::min(std::max(v, low), high); }
  float value(const FieldPoint& p) const override { return limit(field.value(p)); }
  Rgb color(const FieldPoint& p) const override {
    const Rgb c = field.color(p);
    return {limit(c.x), limit(c.y), limit(c.z)};
  }
  FieldDependence dependence() const override { return field.dependence(); }
  std::pair<float, float> range() const override {
    const auto [a, b] = field.value_range();
    return {limit(a), limit(b)};
  }
  std::string print() const override { return field.node().print(); }
  void collect_attributes(std::vector<std::string>& names) const override {
    field.node().collect_attributes(names);
  }
  void collect_maps(std::vector<AssetPath>& maps) const override { field.node().collect_maps(maps); }
  std::shared_ptr<const Node> with_textures(TextureLibrary& textures) const override {
    return std::make_shared<ClampNode>(field.with_textures(textures), low, high);
  }
  const SourcePosition* place_of_attribute(std::string_view asked) const override {
    return field.node().place_of_attribute(asked);
  }

  Field field;
  float low, high;
};

}  // namespace

Field map_field(MapForm form) { return Field(std::make_shared<MapNode>(std::move(form))); }
Field ramp_field(Ramp ramp) { return Field(std::make_shared<RampNode>(std::move(ramp))); }
Field noise_field(Noise noise) { return Field(std::make_shared<NoiseNode>(noise)); }
Field attribute_field(std::string name, SourcePosition named_at) {
  return Field(std::make_shared<AttributeNode>(std::move(name), std::move(named_at)));
}
Field product_field(std::vector<Field> factors) {
  return Field(std::make_shared<ProductNode>(std::move(factors)));
}
Field clamped_field(Field field, float low, float high) {
  return Field(std::make_shared<ClampNode>(std::move(field), low, high));
}

}  // namespace pelage
