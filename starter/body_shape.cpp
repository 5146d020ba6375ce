// SPDX-License-Identifier: Apache-2.0
#include "starter/body_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "starter/cage_faces.h"

namespace pelage {
namespace {

constexpr size_t kMaxCompared = 8000, kMaxMirrored = 600;  // vertices, which bounds the time to 10 ms
constexpr float kSlab = 0.06f;                             // an end of the body, as a fraction of its length
constexpr float kClearly = 0.6f;  // an asymmetry smaller than this fraction of another one decides

struct UsedVertices {
  std::vector<V3f> points;
  Box3f box;
};

UsedVertices used_vertices(const ControlMesh& mesh) {
  std::vector<char> used(mesh.positions.size());
  for (const uint32_t vertex : mesh.face_vertices) used[vertex] = 1;
  UsedVertices result;
  for (size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    result.points.push_back(mesh.positions[i]);
    result.box.extendBy(mesh.positions[i]);
  }
  return result;
}

double cage_area(const ControlMesh& mesh) {
  double area = 0;
  for_each_cage_face(mesh, [&](const CageFace& face) { area += face.area; });
  return area;
}

std::vector<V3f> every_nth(const std::vector<V3f>& points, size_t max) {
  const size_t step = (points.size() + max - 1) / max;
  std::vector<V3f> some;
  for (size_t i = 0; i < points.size(); i += step) some.push_back(points[i]);
  return some;
}

/// Mean distance from the vertices, mirrored along an axis, to the nearest vertex.
std::array<float, 3> asymmetries(const UsedVertices& used) {
  const std::vector<V3f> all = every_nth(used.points, kMaxCompared), some = every_nth(all, kMaxMirrored);
  const V3f middle = used.box.center();
  std::array<float, 3> result{};
  for (int axis = 0; axis < 3; ++axis) {
    double sum = 0;
    for (V3f mirrored : some) {
      mirrored[axis] = 2 * middle[axis] - mirrored[axis];
      float nearest = std::numeric_limits<float>::infinity();
      for (const V3f& other : all) nearest = std::min(nearest, (other - mirrored).length2());
      sum += std::sqrt(nearest);
    }
    result[axis] = static_cast<float>(sum / static_cast<double>(some.size()));
  }
  return result;
}

/// How much of the floor plan the lower end along an axis takes.
float footing(const UsedVertices& used, int axis) {
  const V3f size = used.box.size();
  Box3f feet;
  for (const V3f& point : used.points)
    if (point[axis] <= used.box.min[axis] + kSlab * size[axis]) feet.extendBy(point);
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  const float plan = size[a] * size[b];
  return plan > 0 ? feet.size()[a] * feet.size()[b] / plan : 0;
}

AxisDirection guess_up(const UsedVertices& used, const std::array<float, 3>& asymmetry) {
  const bool y_mirrors = asymmetry[1] < kClearly * std::min(asymmetry[0], asymmetry[2]);
  const bool stands_on_z = footing(used, 2) > 2 * footing(used, 1) && asymmetry[0] < kClearly * asymmetry[2];
  return y_mirrors || stands_on_z ? AxisDirection{2, 1} : AxisDirection{1, 1};
}

int guess_length_axis(const UsedVertices& used, const std::array<float, 3>& asymmetry, int up) {
  const int a = up == 2 ? 1 : 2, b = up == 0 ? 1 : 0;  // the usual one first
  if (asymmetry[b] < kClearly * asymmetry[a]) return a;
  if (asymmetry[a] < kClearly * asymmetry[b]) return b;
  const V3f size = used.box.size();
  return size[b] > 1.05f * size[a] ? b : a;
}

float guess_sign(const UsedVertices& used, int length, AxisDirection up) {
  const V3f size = used.box.size(), middle = used.box.center();
  if (!(size[length] > 0 && size[up.axis] > 0)) return 1;  // flat
  double height[2] = {}, at_end[2] = {}, count[2] = {1, 1};
  for (const V3f& point : used.points) {
    const float along = (point[length] - middle[length]) / size[length];  // -0.5 .. 0.5
    const int end = along > 0;
    if (std::abs(along) > 0.1f) ++count[end];
    if (std::abs(along) < 0.5f - kSlab) continue;
    height[end] += up.sign * (point[up.axis] - middle[up.axis]) / size[up.axis];
    ++at_end[end];
  }
  const double higher = height[1] / std::max(at_end[1], 1.0) - height[0] / std::max(at_end[0], 1.0);
  const double denser = (count[1] - count[0]) / (count[1] + count[0]);
  const bool upright = size[up.axis] > 1.2f * size[length];  // then the ends are a face and a back
  return (upright ? 0.2 : 1) * higher + denser < -0.01 ? -1.0f : 1.0f;
}

SubdivisionScheme scheme_for(const ControlMesh& mesh, const std::string& source) {
  const auto triangles = static_cast<size_t>(std::count(mesh.face_sizes.begin(), mesh.face_sizes.end(), 3u));
  const bool scanned = 2 * triangles > mesh.face_count() && mesh.face_count() > 1000;
  if (scanned || mesh.face_count() > SurfaceTopology::kDenseFaces) return SubdivisionScheme::kNone;
  try {
    SurfaceTopology::create(mesh, SubdivisionScheme::kCatmullClark, BoundaryRule::kEdgeAndCorner, source);
  } catch (const Error&) {
    return SubdivisionScheme::kNone;  // it has parts without a limit surface
  }
  return SubdivisionScheme::kCatmullClark;
}

float unit_for(float length) {
  float best = 1;
  for (const float unit : {1.0f, 0.01f, 0.001f}) {
    const auto distance = [&](float u) { return std::abs(std::log(u * length / 0.6f)); };
    if (distance(unit) < distance(best)) best = unit;
  }
  return best;
}

}  // namespace

V3f AxisDirection::vector() const {
  V3f result(0);
  result[axis] = sign;
  return result;
}

std::string AxisDirection::name() const { return (sign < 0 ? "-" : "") + std::string(1, "xyz"[axis]); }

std::optional<AxisDirection> parse_axis(std::string_view text) {
  AxisDirection result;
  if (text.size() == 2 && (text[0] == '-' || text[0] == '+')) {
    result.sign = text[0] == '-' ? -1.0f : 1.0f;
    text.remove_prefix(1);
  }
  if (text.size() != 1 || text[0] < 'x' || text[0] > 'z') return {};
  result.axis = text[0] - 'x';
  return result;
}

BodyShape body_shape(ControlMesh mesh, const std::string& source, std::optional<AxisDirection> up,
                     std::optional<AxisDirection> facing) {
  BodyShape shape;
  shape.doubled_faces = merge_equal_faces(mesh);
  const UsedVertices used = used_vertices(mesh);
  shape.box = used.box;
  shape.area = static_cast<float>(cage_area(mesh));
  if (!(shape.area > 0) || !std::isfinite(shape.area))
    throw Error(ErrorKind::kInput, {source, 0, 0}, "its faces have no area");
  const std::array<float, 3> asymmetry = asymmetries(used);
  shape.up = up.value_or(guess_up(used, asymmetry));
  if (!up && facing && facing->axis == shape.up.axis) shape.up = {facing->axis == 1 ? 2 : 1, 1};
  if (facing) {
    shape.facing = *facing;
  } else {
    const int length = guess_length_axis(used, asymmetry, shape.up.axis);
    shape.facing = {length, guess_sign(used, length, shape.up)};
  }
  shape.scalp = guess_scalp(mesh, shape.box, shape.up.vector(), shape.facing.vector());
  shape.scheme = scheme_for(mesh, source);
  shape.meters_per_unit = unit_for(max_component(shape.box.size()));
  return shape;
}

}  // namespace pelage
