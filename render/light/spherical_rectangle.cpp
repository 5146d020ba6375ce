// SPDX-License-Identifier: Apache-2.0
#include "render/light/spherical_rectangle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pelage {

SphericalRectangle::SphericalRectangle(double center_x, double center_y, double z, double half_width,
                                       double half_height)
    : x0_(center_x - half_width),
      x1_(center_x + half_width),
      y0_(center_y - half_height),
      y1_(center_y + half_height),
      z_(-std::abs(z)) {
  const double zz = z_ * z_;
  // z components of the inward normals of the four side planes; neighbours are perpendicular in x and y, so
  // that the interior angle between them is acos(-b b').
  b0_ = -y0_ / std::sqrt(y0_ * y0_ + zz);
  b1_ = x1_ / std::sqrt(x1_ * x1_ + zz);
  const double b2 = y1_ / std::sqrt(y1_ * y1_ + zz);
  const double b3 = -x0_ / std::sqrt(x0_ * x0_ + zz);
  // The sum of the interior angles minus 2 pi, with acos(-t) - pi/2 = asin(t).
  const auto angle = [](double t) { return std::asin(std::clamp(t, -1.0, 1.0)); };
  solid_angle_ =
      zz > 0 ? std::max(0.0, angle(b0_ * b1_) + angle(b1_ * b2) + angle(b2 * b3) + angle(b3 * b0_)) : 0;
  first_angles_ = std::numbers::pi - angle(b2 * b3) - angle(b3 * b0_);
  small_ = solid_angle_ < kSmall;
  // Keeps the sign of z for sample(): z_ was made negative for the formulas of the paper.
  z_ = z;
}

V3d SphericalRectangle::sample(double u, double v) const {
  if (small_) return {x0_ + u * (x1_ - x0_), y0_ + v * (y1_ - y0_), z_};
  const double depth = std::abs(z_);
  const double a = u * solid_angle_ + first_angles_;
  // [Urena13, section 3]; n0.z = b0, n2.z = b2. cot(a) comes in through f.
  const double b2 = y1_ / std::sqrt(y1_ * y1_ + z_ * z_);
  const double f = (std::cos(a) * b0_ - b2) / std::sin(a);
  const double cu = std::clamp(std::copysign(1.0, f) / std::sqrt(f * f + b0_ * b0_), -1.0, 1.0);
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
