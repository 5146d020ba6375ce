// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "render/fibre/dual_scattering.h"
#include "render/fibre/fibre_bsdf.h"
#include "render/light/exit_circle.h"
#include "render/light/magnet_set.h"
#include "render/light/skin_shadow.h"
#include "render/sampling/warp.h"
#include "render/surface/glossy.h"
#include "render/surface/lambert.h"

namespace pelage {

/// A vertex of a path: position and scattering, with the same interface for fibres and skins. As in
/// FibreBsdf, there is one value rho = f cos(theta_i) per lobe group.
class ScatterPoint {
 public:
  /// Makes a point of a fibre. `axis`: point of the centre line. `tangent`: unit tangent of the centre line
  /// there. `hit`: point of the surface. `h`: offset of the ray across the fibre, -1 to 1, as passed to the
  /// fibre's model. `farther`: distance from `axis` along the tangent to where most light leaves.
  ScatterPoint(const V3f& axis, const V3f& tangent, float radius, const V3f& hit, float h,
               const FibreBsdf& bsdf, float farther = 0)
      : position_(axis), surface_(hit), exit_{axis + farther * tangent, tangent, radius, h}, bsdf_(bsdf) {}
  /// Makes a point of a strand that represents several strands because of level of detail. Light leaves from
  /// one of the represented strands, at the offset `away` from `axis`. `can_hit_own_strand`: whether the
  /// representing strand itself may block that light.
  ScatterPoint(const V3f& axis, const V3f& tangent, float radius, const V3f& away, bool can_hit_own_strand,
               float h, const FibreBsdf& bsdf)
      : ScatterPoint(axis + away, tangent, radius, axis + away, h, bsdf) {
    can_hit_own_strand_ = can_hit_own_strand;
  }
  /// Makes a point of a skin. Rays that leave the skin start at `start`.
  ScatterPoint(const V3f& position, const V3f& start, const LambertBsdf& bsdf)
      : position_(position), surface_(start), exit_{position}, bsdf_(bsdf) {}
  ScatterPoint(const V3f& position, const V3f& start, const GlossyBsdf& bsdf)
      : position_(position), surface_(start), exit_{position}, bsdf_(bsdf) {}

  /// Returns the point from which lights are sampled. ExitCircle::toward() of exit() then converts the
  /// samples to lines that start where light leaves the fibre.
  const V3f& position() const { return exit_.center; }
  /// Returns the unit tangent of a fibre, or the zero vector for a skin.
  const V3f& tangent() const { return exit_.tangent; }
  /// Returns the positions at which light leaves: a circle for a fibre, a single point for a skin.
  const ExitCircle& exit() const { return exit_; }

  /// Returns whether a ray that starts here may hit its own strand, even near this point. Otherwise, the
  /// caller sets Ray::start so that it cannot.
  bool can_hit_own_strand() const { return can_hit_own_strand_; }

  FibreValue eval(const V3f& wi) const {
    FibreValue value = eval_lobes(wi);
    if (magnet_share_ > 0) attract(wi, value);
    return value;
  }

  /// Estimates the light that the surroundings of a fibre scatter to this point; null: paths find it.
  const DualScattering* dual() const { return dual_ ? &*dual_ : nullptr; }
  void set_dual(const DualScattering& dual) { dual_ = dual; }
  /// Returns the scattering that light from `wi` may meet, to choose among lights; `value`: eval(wi).
  Rgb likely(const V3f& wi, const FibreValue& value) const {
    return dual_ ? value.total() + dual_->likely(wi) : value.total();
  }

  /// Samples a direction from the lobes or, where there are magnets, towards one of them.
  std::optional<FibreSample> sample(const V3f& u) const {
    if (!(magnet_share_ > 0)) return sample_lobes(u);
    if (u.z < magnet_share_) {
      const auto wi = magnets_->sample(position(), {u.x, u.y, std::min(u.z / magnet_share_, kBelowOne)});
      if (!wi) return std::nullopt;
      const FibreSample sample{*wi, eval(*wi)};
      return sample.value.pdf > 0 ? std::optional(sample) : std::nullopt;
    }
    const float rest = std::min((u.z - magnet_share_) / (1 - magnet_share_), kBelowOne);
    std::optional<FibreSample> sample = sample_lobes({u.x, u.y, rest});
    if (sample) attract(sample->wi, sample->value);
    return sample;
  }
  /// `magnets` must outlive the point.
  void set_magnets(const MagnetSet& magnets) {
    magnets_ = &magnets;
    magnet_share_ = magnets.share(position());
  }

  /// The coat or skin of the point, for lights that do not illuminate all; empty: every light illuminates it.
  void set_part(const FramePart& part) { part_ = part; }
  bool receives(const Light& light) const { return !part_ || light.illuminates(*part_); }

  /// Stores the ball inside the skin below this point.
  void set_shadow(const SkinShadow& shadow) { shadow_ = shadow; }
  /// Sets the plane of the skin at the root of a fibre, for points near the root: start() is not below it.
  void set_skin(const V3f& root, const V3f& normal) {
    skin_normal_ = normal;
    skin_height_ = normal.dot(root - position_);
  }
  /// Returns whether the skin blocks a ray from start(wi) for certain (SkinShadow::blocks()).
  bool is_shadowed(const V3f& wi, float far) const {
    return shadow_.ball.radius > 0 && shadow_.blocks(start(wi), wi, far);
  }

  /// Returns the origin of a ray towards `wi`. For a fibre, the origin is on the circle where light leaves
  /// (see ExitCircle), slightly outside the surface so that the fibre does not shadow itself. Light that
  /// arrives uniformly across the width of a fibre also leaves uniformly. Unlike the circle of exit(), this
  /// circle is centred at the hit's own position along the fibre, so that a bent fibre does not cover the
  /// origin. Where the circle is below the skin, the origin is on the axis, so that the skin blocks the ray.
  V3f start(const V3f& wi) const {
    const float radius = exit_.radius;
    if (radius == 0) return surface_;
    const V3f side = wi - wi.dot(tangent()) * tangent();
    const float length2 = side.length2();
    if (length2 < 1e-6f) return surface_;
    const V3f from_axis = exit_.outside(side / std::sqrt(length2));
    // Far from the origin, a few units in the last place exceed a thousandth of a thin fibre.
    const float largest = std::max({std::abs(position_.x), std::abs(position_.y), std::abs(position_.z)});
    const V3f outward = (kJustOutside * radius + 0x1p-21f * largest) * from_axis;
    if (skin_height_ <= 0 && skin_normal_.dot(outward) < skin_height_) return position_;
    return position_ + outward;
  }

 private:
  /// Distance of start() from the axis, in radii.
  static constexpr float kJustOutside = 1.001f;

  /// Adds the density of sampling the magnets to that of sampling the lobes.
  void attract(const V3f& wi, FibreValue& value) const {
    const float lobes = value.pdf;
    value.pdf = (1 - magnet_share_) * lobes + magnets_->pdf(position(), wi);
    if (lobes > 0) value.attraction = value.pdf / lobes;
  }
  FibreValue eval_lobes(const V3f& wi) const {
    if (const auto* fibre = std::get_if<FibreBsdf>(&bsdf_)) return fibre->eval(wi);
    if (const auto* skin = std::get_if<LambertBsdf>(&bsdf_)) return as_fibre(skin->eval(wi));
    return as_fibre(std::get_if<GlossyBsdf>(&bsdf_)->eval(wi));
  }
  std::optional<FibreSample> sample_lobes(const V3f& u) const {
    if (const auto* fibre = std::get_if<FibreBsdf>(&bsdf_)) return fibre->sample(u);
    if (const auto* skin = std::get_if<LambertBsdf>(&bsdf_)) return as_fibre(skin->sample({u.x, u.y}));
    return as_fibre(std::get_if<GlossyBsdf>(&bsdf_)->sample(u));
  }

  /// Converts the scattering of a skin to the lobe groups of fibres: a clear coat is the primary highlight,
  /// everything else is diffuse.
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
  V3f skin_normal_{0};     // zero: far from the root
  float skin_height_ = 1;  // of the skin above the axis, along the normal
  SkinShadow shadow_;
  std::optional<FramePart> part_;
  std::optional<DualScattering> dual_;
  const MagnetSet* magnets_ = nullptr;
  float magnet_share_ = 0;  // MagnetSet::share()
  std::variant<FibreBsdf, LambertBsdf, GlossyBsdf> bsdf_;
};

}  // namespace pelage
