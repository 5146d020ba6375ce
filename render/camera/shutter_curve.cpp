// SPDX-License-Identifier: Apache-2.0
#include "render/camera/shutter_curve.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/nearest_name.h"

namespace pelage {
namespace {

// Interior and boundary points of the curve from 0 to 1.
std::vector<V2f> extended(std::vector<V2f> points) {
  points.insert(points.begin(), V2f(0, points.front().y));
  points.push_back(V2f(1, points.back().y));
  return points;
}

double integral(const std::vector<V2f>& points) {
  double sum = 0;
  for (size_t i = 0; i + 1 < points.size(); ++i)
    sum += (double(points[i + 1].x) - points[i].x) * (double(points[i].y) + points[i + 1].y) / 2;
  return sum;
}

}  // namespace

ShutterCurve::ShutterCurve(std::vector<V2f> points) {
  points = extended(std::move(points));
  const double total = integral(points);
  PELAGE_CHECK(total > 0);
  double before = 0;
  for (size_t i = 0; i + 1 < points.size(); ++i) {
    const double width = double(points[i + 1].x) - points[i].x;
    const double a = points[i].y / total, b = points[i + 1].y / total;
    if (!(width * (a + b) > 0)) continue;  // no light
    segments_.push_back({points[i].x, width, a, (b - a) / width, before});
    before += width * (a + b) / 2;
  }
}

float ShutterCurve::time(float u) const {
  if (segments_.empty()) return u;
  const auto after = std::upper_bound(segments_.begin() + 1, segments_.end(), double(u),
                                      [](double part, const Segment& s) { return part < s.before; });
  const Segment& s = *(after - 1);
  // Solves at_begin * t + slope * t^2 / 2 = light, without a difference of nearly equal numbers.
  const double light = std::max(u - s.before, 0.0);
  const double root = std::sqrt(std::max(s.at_begin * s.at_begin + 2 * s.slope * light, 0.0));
  const double t = light > 0 ? 2 * light / (s.at_begin + root) : 0;
  return static_cast<float>(s.begin + std::min(t, s.width));
}

bool ValueReader<ShutterCurve>::read(const Value& value, const KeyOptions& options, ShutterCurve& out,
                                     Problems& problems) {
  if (value.is_scalar()) {
    if (value.text() == "box") {
      out = ShutterCurve();
    } else if (value.text() == "triangle") {
      out = ShutterCurve({{0, 0}, {0.5f, 1}, {1, 0}});
    } else if (value.text() == "trapezoid") {
      out = ShutterCurve({{0, 0}, {0.25f, 1}, {0.75f, 1}, {1, 0}});
    } else {
      problems.add(value.position(),
                   "expected box, triangle, trapezoid or points [time, weight], got " + value.describe() +
                       suggest(value.text(), std::vector<std::string>{"box", "triangle", "trapezoid"}));
      return false;
    }
    return true;
  }
  std::vector<V2f> points;
  if (!ValueReader<std::vector<V2f>>::read(value, options, points, problems)) return false;
  const auto refuse = [&](const char* why) {
    problems.add(value.position(), why);
    return false;
  };
  for (size_t i = 0; i < points.size(); ++i) {
    if (!(points[i].x >= 0 && points[i].x <= 1)) return refuse("shutter times are between 0 and 1");
    if (i > 0 && points[i].x < points[i - 1].x) return refuse("the times of the shutter curve decrease");
    if (!(points[i].y >= 0 && points[i].y < 1e6f)) return refuse("weights of the shutter are at least 0");
  }
  if (points.empty() || !(integral(extended(points)) > 0))
    return refuse("the shutter curve lets no light through");
  out = ShutterCurve(std::move(points));
  return true;
}

}  // namespace pelage
