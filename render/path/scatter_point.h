// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "render/fibre/fibre_bsdf.h"
#include "render/surface/glossy.h"
#include "render/surface/lambert.h"

namespace pelage {

/// A vertex of a path: where light is scattered, and how. Fibres and skins alike, in terms of lobe groups and
/// of rho = f cos(theta_i) as FibreBsdf has it.
class ScatterPoint {
 public:
  /// A point of a fibre: `axis` on its centre line, `tangent` there, `hit` on its surface; `h` across it, as
  /// the fibre's model was told.
  ScatterPoint(const V3f& axis, const V3f& tangent, float radius, const V3f& hit, float h,
               const FibreBsdf& bsdf)
      : position_(axis), tangent_(tangent), surface_(hit), radius_(radius), h_(h), bsdf_(bsdf) {}
  /// The same of a strand that stands for many: light leaves one of them, which is `away` from it; the strand
  /// itself may be in its way (`meets_own`).
  ScatterPoint(const V3f& axis, const V3f& tangent, float radius, const V3f& away, bool meets_own, float h,
               const FibreBsdf& bsdf)
      : ScatterPoint(axis + away, tangent, radius, axis + away, h, bsdf) {
    meets_own_ = meets_own;
  }
  /// A point of a skin: `start` is where rays that leave it begin.
  ScatterPoint(const V3f& position, const V3f& start, const LambertBsdf& bsdf)
      : position_(position), surface_(start), bsdf_(bsdf) {}
  ScatterPoint(const V3f& position, const V3f& start, const GlossyBsdf& bsdf)
      : position_(position), surface_(start), bsdf_(bsdf) {}

  /// Where light sampling looks from.
  const V3f& position() const { return position_; }
  /// Unit tangent of a fibre, the null vector on a skin.
  const V3f& tangent() const { return tangent_; }

  /// Whether rays that start here may meet the strand that was hit, near this place too.
  bool meets_own() const { return meets_own_; }

  FibreValue eval(const V3f& wi) const {
    if (const auto* fibre = std::get_if<FibreBsdf>(&bsdf_)) return fibre->eval(wi);
    if (const auto* skin = std::get_if<LambertBsdf>(&bsdf_)) return as_fibre(skin->eval(wi));
    return as_fibre(std::get_if<GlossyBsdf>(&bsdf_)->eval(wi));
  }

  std::optional<FibreSample> sample(const V3f& u) const {
    if (const auto* fibre = std::get_if<FibreBsdf>(&bsdf_)) return fibre->sample(u);
    if (const auto* skin = std::get_if<LambertBsdf>(&bsdf_)) return as_fibre(skin->sample({u.x, u.y}));
    return as_fibre(std::get_if<GlossyBsdf>(&bsdf_)->sample(u));
  }

  /// Origin of a ray towards `wi`. Light enters a fibre at one place of its circle and leaves it at another:
  /// a smooth cylinder keeps the distance h at which light passes its axis, whatever the number of
  /// reflections inside. So the ray begins where a line along `wi` at that distance leaves the circle: at the
  /// hit for the mirror image in its normal, on the far side for light that goes through, and never under the
  /// surface of the fibre, which does not shadow itself. Light that meets a fibre evenly across its width
  /// leaves it so.
  V3f start(const V3f& wi) const {
    if (radius_ == 0) return surface_;
    const V3f side = wi - wi.dot(tangent_) * tangent_;
    const float length2 = side.length2();
    if (length2 < 1e-6f) return surface_;
    const V3f out = side / std::sqrt(length2);
    const V3f from_axis = std::sqrt(std::max(0.0f, 1 - h_ * h_)) * out + h_ * tangent_.cross(out);
    // Far from the origin a few units in the last place are more than a thousandth of a thin fibre.
    const float largest = std::max({std::abs(position_.x), std::abs(position_.y), std::abs(position_.z)});
    return position_ + (kJustOutside * radius_ + 0x1p-21f * largest) * from_axis;
  }

 private:
  static constexpr float kJustOutside = 1.001f;

  /// Surfaces in the groups of fibres: what skin scatters is diffuse, its coat the primary highlight.
  static FibreValue as_fibre(const SurfaceValue& value) { return {{value.rho, Rgb(0), Rgb(0)}, value.pdf}; }
  static FibreValue as_fibre(const GlossyValue& value) {
    return {{value.diffuse, Rgb(value.specular), Rgb(0)}, value.pdf};
  }
  template <class Sample>
  static std::optional<FibreSample> as_fibre(const std::optional<Sample>& sample) {
    if (!sample) return std::nullopt;
    return FibreSample{sample->wi, as_fibre(sample->value)};
  }

  V3f position_;
  V3f tangent_{0};
  V3f surface_;
  float radius_ = 0;
  float h_ = 0;
  bool meets_own_ = false;
  std::variant<FibreBsdf, LambertBsdf, GlossyBsdf> bsdf_;
};

}  // namespace pelage
