// SPDX-License-Identifier: Apache-2.0
#include "image/field_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace pelage {
namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();

std::string print_point(const V3f& v) { return ValueReader<V3f>::print(v); }

/// 1 at distance 0 and inside, 0 from the distance `soft` on.
float fade_out(float distance, float soft) {
  if (distance <= 0) return 1;
  if (distance >= soft) return 0;
  const float t = 1 - distance / soft;
  return t * t * (3 - 2 * t);
}

/// A field with equal channels that reads the rest position.
struct PlaceNode : Field::Node {
  Rgb color(const FieldPoint& p) const override { return Rgb(value(p)); }
  FieldDependence dependence() const override { return {.surface = true, .rest = true}; }
};

struct BoxNode final : PlaceNode {
  BoxNode(BoxShape b, SourcePosition p) : box(std::move(b)), position(std::move(p)) {}
  float value(const FieldPoint& p) const override {
    const V3f from = p.rest - middle;
    float outside2 = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float d = std::max(std::abs(from[axis]) - 0.5f * box.size[axis], 0.0f);
      outside2 += d * d;
    }
    return fade_out(std::sqrt(outside2), box.soft);
  }
  std::pair<float, float> range() const override { return {0, 1}; }
  std::string print() const override {
    return fmt::format("{{box: {}, center: {}, soft: {}}}", print_point(box.size),
                       ValueReader<std::optional<V3f>>::print(box.center), print_number(box.soft));
  }
  std::shared_ptr<const Node> with_textures(const FieldSources& sources) const override {
    auto node = std::make_shared<BoxNode>(box, position);
    node->middle =
        box.center ? *box.center : bounds_for("a box without `center`", position, sources).center();
    return node;
  }

  BoxShape box;
  SourcePosition position;
  V3f middle{0};
};

struct SphereNode final : PlaceNode {
  SphereNode(SphereShape s, SourcePosition p) : sphere(std::move(s)), position(std::move(p)) {}
  float value(const FieldPoint& p) const override {
    return fade_out((p.rest - middle).length() - sphere.radius, sphere.soft);
  }
  std::pair<float, float> range() const override { return {0, 1}; }
  std::string print() const override {
    return fmt::format("{{sphere: {}, center: {}, soft: {}}}", print_number(sphere.radius),
                       ValueReader<std::optional<V3f>>::print(sphere.center), print_number(sphere.soft));
  }
  std::shared_ptr<const Node> with_textures(const FieldSources& sources) const override {
    auto node = std::make_shared<SphereNode>(sphere, position);
    node->middle =
        sphere.center ? *sphere.center : bounds_for("a sphere without `center`", position, sources).center();
    return node;
  }

  SphereShape sphere;
  SourcePosition position;
  V3f middle{0};
};

struct HeightNode final : PlaceNode {
  HeightNode(FieldDirection u, SourcePosition p) : up(u), position(std::move(p)) {}
  float value(const FieldPoint& p) const override {
    const float h = (p.rest.dot(up.direction) - low) * scale;
    return std::min(std::max(h, 0.0f), 1.0f);
  }
  std::pair<float, float> range() const override { return {0, 1}; }
  std::string print() const override { return "{height: " + ValueReader<FieldDirection>::print(up) + "}"; }
  std::shared_ptr<const Node> with_textures(const FieldSources& sources) const override {
    auto node = std::make_shared<HeightNode>(up, position);
    const Box3f box = bounds_for("height", position, sources);
    float high = -kInfinite;
    node->low = kInfinite;
    for (int corner = 0; corner < 8; ++corner) {
      const V3f at(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                   corner & 4 ? box.max.z : box.min.z);
      node->low = std::min(node->low, at.dot(up.direction));
      high = std::max(high, at.dot(up.direction));
    }
    node->scale = high > node->low ? 1 / (high - node->low) : 0.0f;
    return node;
  }

  FieldDirection up;
  SourcePosition position;
  float low = 0, scale = 1;
};

struct SlopeNode final : Field::Node {
  explicit SlopeNode(FieldDirection u) : up(u) {}
  float value(const FieldPoint& p) const override { return p.normal.dot(up.direction); }
  Rgb color(const FieldPoint& p) const override { return Rgb(value(p)); }
  FieldDependence dependence() const override { return {.surface = true, .normal = true}; }
  std::pair<float, float> range() const override { return {-1.00001f, 1.00001f}; }
  std::string print() const override { return "{slope: " + ValueReader<FieldDirection>::print(up) + "}"; }

  FieldDirection up;
};

float distance_to_segment(const V3f& p, const V3f& a, const V3f& b) {
  const V3f ab = b - a;
  const float length2 = ab.dot(ab);
  const float t = length2 > 0 ? std::min(std::max((p - a).dot(ab) / length2, 0.0f), 1.0f) : 0.0f;
  return (p - a - ab * t).length();
}

struct DistanceNode final : PlaceNode {
  explicit DistanceNode(DistanceTarget t) : target(std::move(t)) {}
  float value(const FieldPoint& p) const override {
    if (target.plane) return (p.rest - *target.point).dot(target.plane->direction);
    if (target.point) return (p.rest - *target.point).length();
    float nearest = kInfinite;
    for (size_t i = 0; i + 1 < target.line.size(); ++i)
      nearest = std::min(nearest, distance_to_segment(p.rest, target.line[i], target.line[i + 1]));
    return nearest;
  }
  std::pair<float, float> range() const override { return {target.plane ? -reach : 0.0f, reach}; }
  std::string print() const override {
    if (!target.point) return "{distance: {line: " + ValueReader<std::vector<V3f>>::print(target.line) + "}}";
    return fmt::format("{{distance: {{point: {}, plane: {}}}}}", print_point(*target.point),
                       ValueReader<std::optional<FieldDirection>>::print(target.plane));
  }
  /// Finds an upper limit, which operators need to bound their strands.
  std::shared_ptr<const Node> with_textures(const FieldSources& sources) const override {
    if (!sources.skin) return nullptr;
    auto node = std::make_shared<DistanceNode>(target);
    const Box3f box = sources.skin->bounds();
    const V3f to = target.point ? *target.point : target.line.front();
    node->reach =
        box.isEmpty() ? 0.0f : ((box.center() - to).length() + 0.5f * box.size().length()) * 1.0001f;
    return node;
  }

  DistanceTarget target;
  float reach = kInfinite;
};

}  // namespace

bool ValueReader<FieldDirection>::read(const Value& value, const KeyOptions&, FieldDirection& out,
                                       Problems& problems) {
  if (value.is_scalar()) {
    for (int axis = 0; axis < 3; ++axis) {
      if (value.text() != std::string(1, static_cast<char>('x' + axis))) continue;
      out.direction = V3f(0);
      out.direction[axis] = 1;
      return true;
    }
    problems.add(value.position(), "expected x, y, z or 3 numbers, got " + value.describe());
    return false;
  }
  V3f direction;
  if (!ValueReader<V3f>::read(value, {}, direction, problems)) return false;
  const float length = direction.length();
  if (!(length > 0)) {
    problems.add(value.position(), "expected a direction, got one of length 0");
    return false;
  }
  out.direction = direction / length;
  return true;
}

std::string ValueReader<FieldDirection>::print(const FieldDirection& direction) {
  for (int axis = 0; axis < 3; ++axis) {
    if (direction.direction[axis] == 1) return std::string(1, static_cast<char>('x' + axis));
  }
  return print_point(direction.direction);
}

Field box_field(BoxShape box, SourcePosition position) {
  return Field(std::make_shared<BoxNode>(std::move(box), std::move(position)));
}
Field sphere_field(SphereShape sphere, SourcePosition position) {
  return Field(std::make_shared<SphereNode>(std::move(sphere), std::move(position)));
}
Field height_field(FieldDirection up, SourcePosition position) {
  return Field(std::make_shared<HeightNode>(up, std::move(position)));
}
Field slope_field(FieldDirection up) { return Field(std::make_shared<SlopeNode>(up)); }
Field distance_field(DistanceTarget target) {
  return Field(std::make_shared<DistanceNode>(std::move(target)));
}

const FieldSkin& skin_for(const std::string& what, const SourcePosition& position,
                          const FieldSources& sources) {
  if (sources.skin) return *sources.skin;
  throw Error(ErrorKind::kInput, position,
              what +
                  " needs one skin: strands without a skin have none, and neither has a material that "
                  "several skins or their coats share");
}

Box3f bounds_for(const std::string& what, const SourcePosition& position, const FieldSources& sources) {
  return skin_for(what, position, sources).bounds();
}

}  // namespace pelage
