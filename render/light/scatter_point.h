// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "render/fibre/fibre_bsdf.h"
#include "render/light/exit_circle.h"
#include "render/surface/glossy.h"
#include "render/surface/lambert.h"

namespace pelage {

/// A vertex of a path: position and scattering, with one interface for fibres and skins. As in FibreBsdf,
/// values are rho = f cos(theta_i), one per lobe group.
class ScatterPoint {
 public:
  /// A point of a fibre: `axis` on its centre line, `tangent` there, `hit` on its surface. `h`: offset of the
  /// ray across the fibre, -1 to 1, as passed to the fibre's model. `farther`: distance along the tangent
  /// from `axis` to where most light leaves.
  ScatterPoint(const V3f& axis, const V3f& tangent, float radius, const V3f& hit, float h,
               const FibreBsdf& bsdf, float farther = 0)
      : position_(axis), surface_(hit), exit_{axis + farther * tangent, tangent, radius, h}, bsdf_(bsdf) {}
  /// The same for a strand that represents many strands with level of detail. Light leaves from one of the
  /// represented strands, at the offset `away` from `axis`. If `can_hit_own_strand`, the representing strand
  /// may block that light.
  ScatterPoint(const V3f& axis, const V3f& tangent, float radius, const V3f& away, bool can_hit_own_strand,
               float h, const FibreBsdf& bsdf)
      : ScatterPoint(axis + away, tangent, radius, axis + away, h, bsdf) {
    can_hit_own_strand_ = can_hit_own_strand;
  }
  /// A point of a skin: rays that leave it start at `start`.
  ScatterPoint(const V3f& position, const V3f& start, const LambertBsdf& bsdf)
      : position_(position), surface_(start), exit_{position}, bsdf_(bsdf) {}
  ScatterPoint(const V3f& position, const V3f& start, const GlossyBsdf& bsdf)
      : position_(position), surface_(start), exit_{position}, bsdf_(bsdf) {}

  /// Point for which lights are sampled. exit() then converts the samples to lines that start where light
  /// leaves the fibre.
  const V3f& position() const { return exit_.center; }
  /// Unit tangent of a fibre, the null vector for a skin.
  const V3f& tangent() const { return exit_.tangent; }
  /// The positions at which light leaves; for a skin, a single point.
  const ExitCircle& exit() const { return exit_; }

  /// Whether rays that start here may hit the strand itself again, even near this point.
  bool can_hit_own_strand() const { return can_hit_own_strand_; }

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

  /// Origin of a ray towards `wi`: on the circle where light leaves a fibre (see ExitCircle), and never below
  /// the fibre's surface, so that the fibre does not shadow itself. Light that arrives uniformly across the
  /// width of a fibre leaves uniformly. The circle is centred at the hit's own position along the fibre, so
  /// that a bent fibre does not cover it.
  V3f start(const V3f& wi) const {
    const float radius = exit_.radius;
    if (radius == 0) return surface_;
    const V3f side = wi - wi.dot(tangent()) * tangent();
    const float length2 = side.length2();
    if (length2 < 1e-6f) return surface_;
    const V3f from_axis = exit_.outside(side / std::sqrt(length2));
    // Far from the origin, a few units in the last place exceed a thousandth of a thin fibre.
    const float largest = std::max({std::abs(position_.x), std::abs(position_.y), std::abs(position_.z)});
    return position_ + (kJustOutside * radius + 0x1p-21f * largest) * from_axis;
  }

 private:
  static constexpr float kJustOutside = 1.001f;

  /// Maps surfaces to the lobe groups of fibres: scattering by skin is diffuse, its coat the primary
  /// highlight.
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
  V3f surface_;
  ExitCircle exit_;
  bool can_hit_own_strand_ = false;
  std::variant<FibreBsdf, LambertBsdf, GlossyBsdf> bsdf_;
};

}  // namespace pelage
