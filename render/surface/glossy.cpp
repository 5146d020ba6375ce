// SPDX-License-Identifier: Apache-2.0
#include "render/surface/glossy.h"

#include <cmath>

#include "render/sampling/warp.h"

namespace pelage {

namespace {

// Narrower facets are a mirror that floats cannot represent.
constexpr float kSmoothest = 1e-3f;
constexpr float kGrazing = 1e-4f;

float microfacet_density(const V3f& half, float alpha) {
  // 1 - z^2 as x^2 + y^2, because narrow facets need the precision that the difference would lose.
  const float a2 = alpha * alpha;
  const float d = half.x * half.x + half.y * half.y + a2 * half.z * half.z;
  return a2 / (kPi * d * d);
}

// Smith's Lambda of GGX [Heitz14, equation 72].
float smith_lambda(const V3f& w, float alpha) {
  const float z2 = w.z * w.z;
  return 0.5f * (std::sqrt(1 + alpha * alpha * (1 - z2) / z2) - 1);
}

}  // namespace

GlossyBsdf::GlossyBsdf(const Rgb& albedo, float roughness, float ior, const V3f& normal, const V3f& wo)
    : albedo_(albedo), alpha_(std::max(kSmoothest, roughness * roughness)) {
  const float r = (ior - 1) / (ior + 1);
  facing_reflectance_ = r * r;
  frame_.normal = normal;
  complete_frame(normal, frame_.tangent, frame_.bitangent);
  wo_ = frame_.to_local(wo);
  wo_.z = std::max(wo_.z, kGrazing);
  wo_.normalize();
  const float reflected = fresnel(wo_.z);
  base_share_ = 1 - reflected;
  const float base = base_share_ * luminance(albedo_);
  coat_choice_ = reflected / (reflected + base);
}

float GlossyBsdf::fresnel(float cosine) const {
  const float c = 1 - std::clamp(cosine, 0.0f, 1.0f);
  return facing_reflectance_ + (1 - facing_reflectance_) * c * c * c * c * c;
}

float GlossyBsdf::visible_normal_density(const V3f& half) const {
  const float masking = 1 / (1 + smith_lambda(wo_, alpha_));
  return masking * std::max(0.0f, wo_.dot(half)) * microfacet_density(half, alpha_) / wo_.z;
}

// [Heitz18, listing 1]: a point of the visible half disk of a hemisphere seen along the stretched wo.
V3f GlossyBsdf::sample_visible_normal(const V2f& u) const {
  const V3f view = V3f(alpha_ * wo_.x, alpha_ * wo_.y, wo_.z).normalized();
  V3f x, y;
  complete_frame(view, x, y);
  const float horizontal = view.x * view.x + view.y * view.y;
  if (horizontal > 0) {
    x = V3f(-view.y, view.x, 0) / std::sqrt(horizontal);
    y = view.cross(x);
  }
  const float r = std::sqrt(u.x);
  const float phi = 2 * kPi * u.y;
  const float t1 = r * std::cos(phi);
  const float s = 0.5f * (1 + view.z);
  const float t2 = (1 - s) * std::sqrt(std::max(0.0f, 1 - t1 * t1)) + s * r * std::sin(phi);
  const V3f n = t1 * x + t2 * y + std::sqrt(std::max(0.0f, 1 - t1 * t1 - t2 * t2)) * view;
  return V3f(alpha_ * n.x, alpha_ * n.y, std::max(1e-6f, n.z)).normalized();
}

GlossyValue GlossyBsdf::eval_local(const V3f& wi) const {
  GlossyValue value;
  if (!(wi.z > 0)) return value;
  const float cosine_pdf = wi.z / kPi;
  value.diffuse = albedo_ * (base_share_ * (1 - fresnel(wi.z)) * cosine_pdf);
  value.pdf = (1 - coat_choice_) * cosine_pdf;
  const V3f half = (wo_ + wi).normalized();
  const float facet = wo_.dot(half);
  if (facet > 0) {
    const float shadowing = 1 / (1 + smith_lambda(wo_, alpha_) + smith_lambda(wi, alpha_));
    value.specular = fresnel(facet) * microfacet_density(half, alpha_) * shadowing / (4 * wo_.z);
    value.pdf += coat_choice_ * visible_normal_density(half) / (4 * facet);
  }
  return value;
}

GlossyValue GlossyBsdf::eval(const V3f& wi) const { return eval_local(frame_.to_local(wi)); }

std::optional<GlossySample> GlossyBsdf::sample(const V3f& u) const {
  V3f wi;
  if (u.z < coat_choice_) {
    const V3f half = sample_visible_normal({u.x, u.y});
    wi = 2 * wo_.dot(half) * half - wo_;
  } else {
    const V2f disk = concentric_disk({u.x, u.y});
    wi = {disk.x, disk.y, std::sqrt(std::max(0.0f, 1 - disk.length2()))};
  }
  if (!(wi.z > 0)) return std::nullopt;
  return GlossySample{frame_.to_world(wi), eval_local(wi)};
}

}  // namespace pelage
