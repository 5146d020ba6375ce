// SPDX-License-Identifier: Apache-2.0
#include "procedurals/crowd/ground_area.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pelage {

const Schema<RectangleAreaParams>& RectangleAreaParams::schema() {
  static const Schema<RectangleAreaParams> table = [] {
    Schema<RectangleAreaParams> s("rectangle area", "A level rectangle of ground.");
    s.set_example(R"(crowds:
  herd:
    of: [rat]
    count: 200
    area: {type: rectangle, size: [200, 120], rotate: 30})");
    s.key("center", &RectangleAreaParams::center,
          {.unit = "scene units", .help = "Centre; y is the height of the ground"});
    s.key("size", &RectangleAreaParams::size,
          {.unit = "scene units", .help = "Size along x and z", .min = 0, .above_min = true});
    s.key("rotate", &RectangleAreaParams::rotate, {.unit = "degrees", .help = "Rotation about y"});
    return s;
  }();
  return table;
}

const Schema<DiscAreaParams>& DiscAreaParams::schema() {
  static const Schema<DiscAreaParams> table = [] {
    Schema<DiscAreaParams> s("disc area", "A level disc of ground.");
    s.set_example(R"(crowds:
  herd:
    of: [rat]
    count: 200
    area: {type: disc, center: [0, 0, -40], radius: 80})");
    s.key("center", &DiscAreaParams::center,
          {.unit = "scene units", .help = "Centre; y is the height of the ground"});
    s.key("radius", &DiscAreaParams::radius,
          {.unit = "scene units", .help = "Radius of the disc", .min = 0, .above_min = true});
    return s;
  }();
  return table;
}

const Schema<PolygonAreaParams>& PolygonAreaParams::schema() {
  static const Schema<PolygonAreaParams> table = [] {
    Schema<PolygonAreaParams> s("polygon area", "Level ground inside a polygon without self-intersections.");
    s.set_example(R"(crowds:
  herd:
    of: [rat]
    count: 200
    area: {type: polygon, points: [[-80, 0], [80, 0], [0, 120]]})");
    s.key("points", &PolygonAreaParams::points,
          {.unit = "scene units", .help = "Corners [x, z] in order, at least three", .required = true});
    s.key("height", &PolygonAreaParams::height, {.unit = "scene units", .help = "Height (y) of the ground"});
    return s;
  }();
  return table;
}

namespace {

std::vector<V2f> corners(const RectangleAreaParams& params) {
  const float angle = params.rotate * std::numbers::pi_v<float> / 180;
  const float s = std::sin(angle), c = std::cos(angle);
  std::vector<V2f> result;
  for (const V2f& corner : {V2f(-1, -1), V2f(1, -1), V2f(1, 1), V2f(-1, 1)}) {
    const float x = 0.5f * corner.x * params.size.x, z = 0.5f * corner.y * params.size.y;
    result.emplace_back(params.center.x + c * x + s * z, params.center.z - s * x + c * z);
  }
  return result;
}

V2f nearest_on_line(const V2f& a, const V2f& b, const V2f& point) {
  const V2f along = b - a;
  const float length2 = along.length2();
  const float t = length2 > 0 ? std::clamp((point - a).dot(along) / length2, 0.0f, 1.0f) : 0;
  return a + along * t;
}

}  // namespace

GroundArea::GroundArea(const AreaParams& params) {
  if (const auto* disc = std::get_if<DiscAreaParams>(&params)) {
    center_ = V2f(disc->center.x, disc->center.z);
    radius_ = disc->radius;
    height_ = disc->center.y;
    min_ = center_ - V2f(radius_);
    max_ = center_ + V2f(radius_);
    surface_ = std::numbers::pi * radius_ * radius_;
    border_ = 2 * std::numbers::pi * radius_;
    return;
  }
  if (const auto* rectangle = std::get_if<RectangleAreaParams>(&params)) {
    outline_ = corners(*rectangle);
    height_ = rectangle->center.y;
  } else {
    outline_ = std::get<PolygonAreaParams>(params).points;
    height_ = std::get<PolygonAreaParams>(params).height;
  }
  min_ = max_ = outline_.at(0);
  for (size_t i = 0; i < outline_.size(); ++i) {
    const V2f &a = outline_[i], &b = outline_[(i + 1) % outline_.size()];
    min_ = V2f(std::min(min_.x, a.x), std::min(min_.y, a.y));
    max_ = V2f(std::max(max_.x, a.x), std::max(max_.y, a.y));
    surface_ += 0.5 * (double(a.x) * b.y - double(b.x) * a.y);
    border_ += (b - a).length();
  }
  surface_ = std::abs(surface_);
}

bool GroundArea::contains(const V2f& point) const {
  if (outline_.empty()) return (point - center_).length2() <= radius_ * radius_;
  bool inside = false;  // parity of the number of sides to the right of the point
  for (size_t i = 0; i < outline_.size(); ++i) {
    const V2f &a = outline_[i], &b = outline_[(i + 1) % outline_.size()];
    if ((a.y > point.y) != (b.y > point.y) && point.x < a.x + (b.x - a.x) * ((point.y - a.y) / (b.y - a.y))) {
      inside = !inside;
    }
  }
  return inside;
}

V2f GroundArea::nearest(const V2f& point) const {
  if (contains(point)) return point;
  if (outline_.empty()) return center_ + (point - center_) * (radius_ / (point - center_).length());
  V2f best = outline_[0];
  float min = std::numeric_limits<float>::infinity();
  for (size_t i = 0; i < outline_.size(); ++i) {
    const V2f here = nearest_on_line(outline_[i], outline_[(i + 1) % outline_.size()], point);
    if ((here - point).length2() < min) {
      min = (here - point).length2();
      best = here;
    }
  }
  return best;
}

}  // namespace pelage
