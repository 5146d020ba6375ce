// SPDX-License-Identifier: Apache-2.0
#include "image/field_operations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace pelage {
namespace {

using Range = std::pair<float, float>;
using Values = std::span<const float>;
using Ranges = std::span<const Range>;

constexpr float kUnlimited = std::numeric_limits<float>::infinity();

std::string list_of(const char* name, const std::vector<Field>& inputs) {
  return fmt::format("{{{}: {}}}", name, ValueReader<std::vector<Field>>::print(inputs));
}
std::string print_field(const Field& field) { return field.node().print(); }

/// Arrays of one element per input, on the stack if there are few.
template <class T>
class PerInput {
 public:
  explicit PerInput(size_t count) : many_(count > few_.size() ? count : 0), count_(count) {}
  T* data() { return many_.empty() ? few_.data() : many_.data(); }
  std::span<const T> get() { return {data(), count_}; }

 private:
  std::array<T, 8> few_;
  std::vector<T> many_;
  size_t count_;
};

/// A field whose every channel is `Op` of that channel of the inputs. An Op has
///   float operator()(Values) const;      // the value for values of the inputs
/// or, if channels differ beyond their inputs,
///   float channel(Values, int channel) const;
/// and
///   Range range(Ranges) const;           // its min and max for those of the inputs
///   std::string print(const std::vector<Field>& inputs) const;
template <class Op>
struct OperationNode final : Field::Node {
  OperationNode(Op o, std::vector<Field> f) : op(std::move(o)), fields(std::move(f)) {}

  float apply(Values values, int channel) const {
    if constexpr (requires { op.channel(values, channel); })
      return op.channel(values, channel);
    else
      return op(values);
  }
  float value(const FieldPoint& p) const override {
    PerInput<float> values(fields.size());
    for (size_t i = 0; i < fields.size(); ++i) values.data()[i] = fields[i].value(p);
    return apply(values.get(), 0);
  }
  Rgb color(const FieldPoint& p) const override {
    PerInput<Rgb> colors(fields.size());
    for (size_t i = 0; i < fields.size(); ++i) colors.data()[i] = fields[i].color(p);
    PerInput<float> channel(fields.size());
    Rgb result;
    for (int c = 0; c < 3; ++c) {
      for (size_t i = 0; i < fields.size(); ++i) channel.data()[i] = colors.data()[i][c];
      result[c] = apply(channel.get(), c);
    }
    return result;
  }
  void combine(std::span<const float* const> rows, int channel, size_t count, float* out) const override {
    PerInput<float> values(rows.size());
    for (size_t s = 0; s < count; ++s) {
      for (size_t i = 0; i < rows.size(); ++i) values.data()[i] = rows[i][s];
      out[s] = apply(values.get(), channel);
    }
  }
  FieldDependence dependence() const override {
    FieldDependence all;
    for (const Field& field : fields) all = all | field.dependence();
    return all;
  }
  Range range() const override {
    PerInput<Range> ranges(fields.size());
    for (size_t i = 0; i < fields.size(); ++i) ranges.data()[i] = fields[i].value_range();
    return op.range(ranges.get());
  }
  std::string print() const override { return op.print(fields); }
  std::span<const Field> inputs() const override { return fields; }
  std::shared_ptr<const Node> with_textures(const FieldSources& sources) const override {
    std::vector<Field> loaded;
    for (const Field& field : fields) loaded.push_back(field.with_textures(sources));
    auto node = std::make_shared<OperationNode>(op, std::move(loaded));
    const FieldDependence needs = node->dependence();
    if (needs.along || needs.surface || needs.attributes) return node;
    return Field(node->color({})).shared_node();  // a constant
  }

  Op op;
  std::vector<Field> fields;
};

template <class Op>
Field operation(Op op, std::vector<Field> inputs) {
  return Field(std::make_shared<OperationNode<Op>>(std::move(op), std::move(inputs)));
}

struct Product {
  float operator()(Values v) const {
    float product = 1;
    for (const float x : v) product *= x;
    return product;
  }
  Range range(Ranges r) const {
    Range all{1, 1};
    // An unlimited factor times one that is always 0 is 0.
    const auto times = [](float a, float b) { return a == 0 || b == 0 ? 0.0f : a * b; };
    for (const auto& [low, high] : r) {
      const auto ends = {times(all.first, low), times(all.first, high), times(all.second, low),
                         times(all.second, high)};
      all = std::minmax(ends);
    }
    return all;
  }
  std::string print(const std::vector<Field>& fields) const { return list_of("product", fields); }
};

struct Sum {
  float operator()(Values v) const {
    float sum = 0;
    for (const float x : v) sum += x;
    return sum;
  }
  Range range(Ranges r) const {
    Range sum{0, 0};
    for (const auto& [low, high] : r) sum = {sum.first + low, sum.second + high};
    return sum;
  }
  std::string print(const std::vector<Field>& fields) const { return list_of("add", fields); }
};

struct Min {
  float operator()(Values v) const { return *std::min_element(v.begin(), v.end()); }
  Range range(Ranges r) const {
    Range all{kUnlimited, kUnlimited};
    for (const auto& [low, high] : r) all = {std::min(all.first, low), std::min(all.second, high)};
    return all;
  }
  std::string print(const std::vector<Field>& fields) const { return list_of("min", fields); }
};

struct Max {
  float operator()(Values v) const { return *std::max_element(v.begin(), v.end()); }
  Range range(Ranges r) const {
    Range all{-kUnlimited, -kUnlimited};
    for (const auto& [low, high] : r) all = {std::max(all.first, low), std::max(all.second, high)};
    return all;
  }
  std::string print(const std::vector<Field>& fields) const { return list_of("max", fields); }
};

struct Mix {
  float operator()(Values v) const { return v[0] * (1 - v[2]) + v[1] * v[2]; }
  Range range(Ranges r) const {
    const Range &a = r[0], &b = r[1], &by = r[2];
    if (by.first < 0 || by.second > 1) {
      // a + (b - a) * by, with an unlimited value wherever any of them is.
      const float widest = std::max(std::abs(b.second - a.first), std::abs(b.first - a.second)) *
                           std::max(std::abs(by.first), std::abs(by.second));
      return std::isfinite(widest) ? Range(a.first - widest, a.second + widest)
                                   : Range(-kUnlimited, kUnlimited);
    }
    return {std::min(a.first, b.first), std::max(a.second, b.second)};
  }
  std::string print(const std::vector<Field>& f) const {
    return fmt::format("{{mix: [{}, {}], by: {}}}", print_field(f[0]), print_field(f[1]), print_field(f[2]));
  }
};

struct Invert {
  float operator()(Values v) const { return 1 - v[0]; }
  Range range(Ranges r) const { return {1 - r[0].second, 1 - r[0].first}; }
  std::string print(const std::vector<Field>& f) const { return "{invert: " + print_field(f[0]) + "}"; }
};

struct Clamp {
  float low, high;
  bool is_block;  ///< whether the scene has a block for it; otherwise these are the limits of a key
  float operator()(Values v) const { return std::min(high, std::max(low, v[0])); }  // also of NaN
  Range range(Ranges r) const { return {(*this)({&r[0].first, 1}), (*this)({&r[0].second, 1})}; }
  std::string print(const std::vector<Field>& f) const {
    if (!is_block) return print_field(f[0]);
    return fmt::format("{{clamp: {}, low: {}, high: {}}}", print_field(f[0]), print_number(low),
                       print_number(high));
  }
};

struct Threshold {
  float at, width;
  float operator()(Values v) const {
    if (width <= 0) return v[0] < at ? 0.0f : 1.0f;
    const float t = std::min(std::max((v[0] - at) / width + 0.5f, 0.0f), 1.0f);
    return t * t * (3 - 2 * t);
  }
  Range range(Ranges) const { return {0, 1}; }
  std::string print(const std::vector<Field>& f) const {
    return fmt::format("{{threshold: {}, at: {}, width: {}}}", print_field(f[0]), print_number(at),
                       print_number(width));
  }
};

struct Step {
  float size;
  float operator()(Values v) const { return std::floor(v[0] / size) * size; }
  Range range(Ranges r) const { return {(*this)({&r[0].first, 1}), (*this)({&r[0].second, 1})}; }
  std::string print(const std::vector<Field>& f) const {
    return fmt::format("{{step: {}, size: {}}}", print_field(f[0]), print_number(size));
  }
};

struct Remap {
  std::vector<RampKnot> curve;
  float channel(Values v, int channel) const { return on_curve(curve, v[0])[channel]; }
  Range range(Ranges) const {
    Range all{kUnlimited, -kUnlimited};
    for (const RampKnot& knot : curve)
      all = {std::min(all.first, knot.value.x), std::max(all.second, knot.value.x)};
    return all;
  }
  std::string print(const std::vector<Field>& f) const {
    return fmt::format("{{remap: {}, knots: {}}}", print_field(f[0]),
                       ValueReader<std::vector<RampKnot>>::print(curve));
  }
};

}  // namespace

Field product_field(std::vector<Field> factors) { return operation(Product{}, std::move(factors)); }
Field sum_field(std::vector<Field> terms) { return operation(Sum{}, std::move(terms)); }
Field min_field(std::vector<Field> fields) { return operation(Min{}, std::move(fields)); }
Field max_field(std::vector<Field> fields) { return operation(Max{}, std::move(fields)); }
Field mix_field(Field a, Field b, Field by) {
  return operation(Mix{}, {std::move(a), std::move(b), std::move(by)});
}
Field inverted_field(Field field) { return operation(Invert{}, {std::move(field)}); }
Field clamped_field(Field field, float low, float high) {
  return operation(Clamp{low, high, false}, {std::move(field)});
}
Field clamp_block_field(Field field, float low, float high) {
  return operation(Clamp{low, high, true}, {std::move(field)});
}
Field threshold_field(Field field, float at, float width) {
  return operation(Threshold{at, width}, {std::move(field)});
}
Field step_field(Field field, float size) { return operation(Step{size}, {std::move(field)}); }
Field remapped_field(Field field, std::vector<RampKnot> curve) {
  return operation(Remap{std::move(curve)}, {std::move(field)});
}

}  // namespace pelage
