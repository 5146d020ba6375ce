// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "geom/usd/usd_stage.h"
#include "geom/usd/usd_values.h"

namespace pelage {
namespace {

using Imath::M44d;

M44d rotation_about(int axis, double degrees) {
  const double angle = degrees * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  M44d m;
  m[a][a] = c, m[a][b] = s, m[b][a] = -s, m[b][b] = c;
  return m;
}

M44d rotation_of_quaternion(const std::vector<double>& q) {
  M44d m;
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(length > 0)) return m;
  const double w = q[0] / length, x = q[1] / length, y = q[2] / length, z = q[3] / length;
  m[0][0] = 1 - 2 * (y * y + z * z), m[0][1] = 2 * (x * y + w * z), m[0][2] = 2 * (x * z - w * y);
  m[1][0] = 2 * (x * y - w * z), m[1][1] = 1 - 2 * (x * x + z * z), m[1][2] = 2 * (y * z + w * x);
  m[2][0] = 2 * (x * z + w * y), m[2][1] = 2 * (y * z - w * x), m[2][2] = 1 - 2 * (x * x + y * y);
  return m;
}

/// The kind of an operation: "rotateXYZ" of "xformOp:rotateXYZ:pivot".
std::string kind_of(const std::string& op) {
  const size_t begin = std::string("xformOp:").size();
  if (!op.starts_with("xformOp:")) return {};
  return op.substr(begin, op.find(':', begin) - begin);
}

bool is_rotation_order(const std::string& axes) {
  if (axes.size() != 3) return false;
  int seen = 0;
  for (const char axis : axes) {
    if (axis >= 'X' && axis <= 'Z') seen |= 1 << (axis - 'X');
  }
  return seen == 7;
}

/// The matrix of one operation. Sets `known` to false for an unknown kind.
M44d matrix_of(const std::string& kind, const std::vector<double>& v, bool& known) {
  M44d m;
  if (kind == "translate" && v.size() == 3) return m.setTranslation(Imath::V3d(v[0], v[1], v[2]));
  if (kind == "scale" && v.size() == 3) return m.setScale(Imath::V3d(v[0], v[1], v[2]));
  if (kind == "orient" && v.size() == 4) return rotation_of_quaternion(v);
  if (kind == "transform" && v.size() == 16) {
    for (size_t i = 0; i < 16; ++i) m[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = v[i];
    return m;
  }
  if (kind.starts_with("rotate")) {
    const std::string axes = kind.substr(6);
    if (axes.size() == 1 && axes[0] >= 'X' && axes[0] <= 'Z' && v.size() == 1)
      return rotation_about(axes[0] - 'X', v[0]);
    if (is_rotation_order(axes) && v.size() == 3) {
      for (const char axis : axes) m = m * rotation_about(axis - 'X', v[static_cast<size_t>(axis - 'X')]);
      return m;
    }
  }
  known = false;
  return m;
}

}  // namespace

M44f usd_local_transform(const UsdPrim& prim, bool& resets, ReadWarnings& warnings) {
  resets = false;
  const std::optional<UsdValue> order = prim.find("xformOpOrder");
  M44d matrix;
  if (order) {
    for (std::string op : usd_texts(*order->layer, order->text)) {
      if (op == "!resetXformStack!") {
        resets = true;
        matrix.makeIdentity();
        continue;
      }
      const bool inverse = op.starts_with("!invert!");
      if (inverse) op = op.substr(std::string("!invert!").size());
      const std::optional<UsdValue> value = prim.find(op);
      if (!value) prim.fail("xformOpOrder names '" + op + "', which has no value");
      const size_t components = usd_components(value->attribute->type);
      bool known = components > 0;
      const std::vector<double> numbers =
          known ? usd_doubles(*value->layer, value->text, components) : std::vector<double>();
      M44d one = matrix_of(kind_of(op), numbers, known);
      if (!known) {
        warnings.add("operations '" + kind_of(op) + "' of transforms are skipped", prim.position());
        continue;
      }
      // The last operation of the list applies to points first.
      matrix = (inverse ? one.inverse() : one) * matrix;
    }
  }
  M44f result;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) result[i][j] = static_cast<float>(matrix[i][j]);
  }
  return result;
}

}  // namespace pelage
