// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "base/vector.h"

namespace pelage {

/// Scattering of a glossy surface for one pair of directions: rho = f cos(theta_i) per solid angle, where
/// theta_i is the angle to the normal.
struct GlossyValue {
  Rgb diffuse{0};
  float specular = 0;  ///< reflection by the clear coat, without the base colour
  float pdf = 0;       ///< density of sample(), per solid angle
};

struct GlossySample {
  V3f wi{0};
  GlossyValue value;
};

/// A diffuse base under a clear coat, for eyes, noses and wet ground. The coat is a GGX microfacet dielectric
/// [Walter07] with height-correlated shadowing [Heitz14] and Schlick's Fresnel term [Schlick94]. It is
/// sampled by visible normals [Heitz18]. The base scatters the light that the coat transmits. The surface is
/// reciprocal and never gains energy.
///
/// Directions are in world space and point away from the surface. `normal` and `wo` must be on the same side
/// of the surface. A plain value, cheap to construct.
class GlossyBsdf {
 public:
  /// `roughness` in [0, 1]: its square is the width of the microfacet distribution. `ior` > 1.
  GlossyBsdf(const Rgb& albedo, float roughness, float ior, const V3f& normal, const V3f& wo);

  GlossyValue eval(const V3f& wi) const;
  /// Samples a direction; empty if it points into the surface. `u`: three random numbers in [0, 1). u.z
  /// selects the coat or the base, u.x and u.y the direction.
  std::optional<GlossySample> sample(const V3f& u) const;

 private:
  float fresnel(float cosine) const;
  GlossyValue eval_local(const V3f& wi) const;
  float visible_normal_density(const V3f& half) const;
  V3f sample_visible_normal(const V2f& u) const;

  Rgb albedo_;
  float alpha_;
  float facing_reflectance_;
  Frame frame_;
  V3f wo_;             // in frame_: z along the normal
  float base_share_;   // fraction of light that the coat transmits on the way to the viewer
  float coat_choice_;  // probability of sampling the coat
};

}  // namespace pelage
