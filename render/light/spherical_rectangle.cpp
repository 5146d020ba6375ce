// SPDX-License-Identifier: Apache-2.0
#include "render/light/spherical_rectangle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pelage {

namespace {

/// A complex number, not normalised, whose argument is an angle: adds angles without trigonometry.
struct Phase {
  double re, im;
  Phase operator*(const Phase& b) const { return {re * b.re - im * b.im, re * b.im + im * b.re}; }
};

}  // namespace

SphericalRectangle::SphericalRectangle(double center_x, double center_y, double z, double half_width,
                                       double half_height)
    : x0_(center_x - half_width),
      x1_(center_x + half_width),
      y0_(center_y - half_height),
      y1_(center_y + half_height),
      z_(z) {
  // The interior angle at a corner (x, y) is pi/2 plus an angle whose tangent is +-x y / (|z| distance): the
  // solid angle, the sum of the interior angles minus 2 pi, is the sum of these angles.
  const double depth = std::abs(z);
  const auto corner = [&](double x, double y, double sign) {
    return Phase{depth * std::sqrt(x * x + y * y + z * z), sign * x * y};
  };
  const Phase start = corner(x0_, y1_, -1) * corner(x0_, y0_, 1);
  const Phase whole = start * corner(x1_, y0_, -1) * corner(x1_, y1_, 1);
  solid_angle_ = depth > 0 ? std::atan2(whole.im, whole.re) : 0.0;
  if (solid_angle_ < 0) {
    // A sum beyond half a turn is possible only for a point directly in front of the rectangle; elsewhere a
    // negative sum is rounding.
    const bool in_front = x0_ < 0 && x1_ > 0 && y0_ < 0 && y1_ > 0;
    solid_angle_ = in_front ? solid_angle_ + 2 * std::numbers::pi : 0.0;
  }
  small_ = solid_angle_ < kSmall;
  const double length = std::sqrt(start.re * start.re + start.im * start.im);
  cos_start_ = length > 0 ? -start.re / length : -1;
  sin_start_ = length > 0 ? start.im / length : 0;
}

V3d SphericalRectangle::sample(double u, double v) const {
  if (small_) return {x0_ + u * (x1_ - x0_), y0_ + v * (y1_ - y0_), z_};
  const double depth = std::abs(z_);
  const double step_cos = std::cos(u * solid_angle_), step_sin = std::sin(u * solid_angle_);
  const double cos_a = step_cos * cos_start_ - step_sin * sin_start_;
  const double sin_a = step_sin * cos_start_ + step_cos * sin_start_;
  const double b0 = -y0_ / std::sqrt(y0_ * y0_ + z_ * z_);
  const double b2 = y1_ / std::sqrt(y1_ * y1_ + z_ * z_);
  const double f = (cos_a * b0 - b2) / sin_a;
  const double cu = std::copysign(std::min(1.0, 1 / std::sqrt(f * f + b0 * b0)), f);
  const double xu = std::clamp(cu * depth / std::sqrt(std::max((1 - cu) * (1 + cu), 1e-300)), x0_, x1_);
  const double d = std::sqrt(xu * xu + z_ * z_);
  const double h0 = y0_ / std::sqrt(d * d + y0_ * y0_);
  const double h1 = y1_ / std::sqrt(d * d + y1_ * y1_);
  const double hv = h0 + v * (h1 - h0);
  const double rest = (1 - hv) * (1 + hv);
  const double yv = rest > 1e-12 ? std::clamp(hv * d / std::sqrt(rest), y0_, y1_) : (hv > 0 ? y1_ : y0_);
  return {xu, yv, z_};
}

double SphericalRectangle::pdf(double distance) const {
  if (!(solid_angle_ > 0)) return 0;
  if (!small_) return 1 / solid_angle_;
  const double area = (x1_ - x0_) * (y1_ - y0_);
  return distance * distance * distance / (std::abs(z_) * area);
}

}  // namespace pelage
