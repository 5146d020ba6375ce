// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "base/vector.h"

namespace pelage {

/// Scattering of a glossy surface, rho = f cos(theta_i) per solid angle, with the cosine to the normal.
struct GlossyValue {
  Rgb diffuse{0};
  float specular = 0;  ///< reflection by the clear coat, without the base colour
  float pdf = 0;       ///< density of sample(), per solid angle
};

struct GlossySample {
  V3f wi{0};
  GlossyValue value;
};

/// A diffuse base under a smooth clear coat, for eyes, noses, wet ground. The coat is a GGX microfacet
/// dielectric [Walter07] with height-correlated shadowing [Heitz14], sampled by visible normals [Heitz18],
/// with Fresnel by [Schlick94]; the base scatters the light that the coat transmits. Reciprocal; never gains
/// energy. World space; directions point away from the surface; `normal` and `wo` are on one side. A plain
/// value, cheap to construct.
class GlossyBsdf {
 public:
  /// `roughness` in [0, 1]: its square is the width of the microfacet distribution. `ior` > 1.
  GlossyBsdf(const Rgb& albedo, float roughness, float ior, const V3f& normal, const V3f& wo);

  GlossyValue eval(const V3f& wi) const;
  /// u.x, u.y: direction; u.z: coat or base.
  std::optional<GlossySample> sample(const V3f& u) const;

 private:
  float fresnel(float cosine) const;
  GlossyValue eval_local(const V3f& wi) const;
  float visible_normal_density(const V3f& half) const;
  V3f draw_visible_normal(const V2f& u) const;

  Rgb albedo_;
  float alpha_;
  float facing_reflectance_;
  Frame frame_;
  V3f wo_;             // local: z along the normal
  float base_share_;   // fraction of light that the coat transmits on the way to the viewer
  float coat_choice_;  // probability of sampling the coat
};

}  // namespace pelage
