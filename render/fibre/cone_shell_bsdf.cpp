// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/cone_shell_bsdf.h"

#include "base/hash.h"
#include "render/sampling/warp.h"

namespace pelage {

namespace {

constexpr float kDiffuseScale = 1.0f / (kPi * kPi);
/// Added to the luminance of each lobe that scatters at all when lobes are selected, so that none is starved.
constexpr float kChoiceFloor = 1e-3f;

/// Unit vector perpendicular to `tangent` on the side of `wo`; any when they are parallel.
V3f perpendicular_toward(const V3f& wo, const V3f& tangent) {
  const V3f side = wo - wo.dot(tangent) * tangent;
  const float length = std::sqrt(side.dot(side));
  if (length > 1e-6f) return side * (1.0f / length);
  V3f first, second;
  complete_frame(tangent, first, second);
  return first;
}

}  // namespace

ConeShellMaterial::ConeShellMaterial(const ConeShellParams& params)
    : diffuse(params.diffuse.value_or(
          std::max(0.0f, 1 - max_component(params.primary) - max_component(params.secondary)))),
      balance(params.balance),
      primary(params.primary),
      secondary(params.secondary),
      variant(params.variant),
      primary_shape(params.primary_width, params.primary_tilt),
      secondary_shape(params.secondary_width, params.secondary_tilt),
      shift{0.0f, params.primary_shift, params.secondary_shift},
      jitter{0.0f, params.primary_jitter, params.secondary_jitter} {}

float ConeShellMaterial::tangent_place(LobeGroup lobe, float v, uint64_t strand_id, uint64_t seed) const {
  const int l = static_cast<int>(lobe);
  float place = v + shift[l];
  if (jitter[l] != 0.0f)
    place += jitter[l] * signed_float(hash64(seed, random_use("lobe jitter"), strand_id, l));
  return std::clamp(place, 0.0f, 1.0f);
}

ConeShellBsdf::ConeShellBsdf(const ConeShellMaterial& material, const Rgb& color,
                             const LobeTangents& tangents, const V3f& wo)
    : tangents_(tangents),
      toward_viewer_(perpendicular_toward(wo, tangents[0])),
      balance_(material.balance),
      shells_{ConeShell(material.primary_shape, material.variant, wo.dot(tangents[1])),
              ConeShell(material.secondary_shape, material.variant, wo.dot(tangents[2]))},
      albedos_{color * material.diffuse, material.primary, color * material.secondary} {
  const Rgb sum = albedo();
  const float max = max_component(sum);
  if (max > 1.0f) {
    for (Rgb& lobe : albedos_) lobe *= 1.0f / max;
  }
  float total = 0;
  for (int l = 0; l < kLobeGroups; ++l) {
    const float weight = luminance(albedos_[l]);
    choice_[l] = weight > 0.0f ? weight + kChoiceFloor : 0.0f;
    total += choice_[l];
  }
  if (total > 0.0f) {
    for (float& p : choice_) p /= total;
  }
}

FibreValue ConeShellBsdf::eval(const V3f& wi) const {
  const float z = wi.dot(tangents_[0]);
  const float cos_theta = std::sqrt(std::max(0.0f, (1.0f - z) * (1.0f + z)));
  const float diffuse = kDiffuseScale * std::max(0.0f, cos_theta + balance_ * wi.dot(toward_viewer_));
  const float primary = shells_[0].density(wi.dot(tangents_[1]));
  const float secondary = shells_[1].density(wi.dot(tangents_[2]));
  return {{albedos_[0] * diffuse, albedos_[1] * primary, albedos_[2] * secondary},
          choice_[0] * diffuse + choice_[1] * primary + choice_[2] * secondary};
}

std::optional<FibreSample> ConeShellBsdf::sample(const V3f& u) const {
  int lobe = 0;
  float rest = u.x;
  // The last lobe with a probability gets the rounding remainder.
  const int last = choice_[2] > 0 ? 2 : choice_[1] > 0 ? 1 : 0;
  while (lobe < last && rest >= choice_[lobe]) rest -= choice_[lobe++];
  if (!(choice_[lobe] > 0.0f)) return std::nullopt;
  const float xi = std::min(rest / choice_[lobe], kBelowOne);

  const V3f& tangent = tangents_[lobe];
  const float phi = 2.0f * kPi * u.y;
  float c = std::cos(phi), s = std::sin(phi);
  V3f across, beside;
  float z;
  if (lobe == 0) {
    z = WignerTable::instance().sample(xi);
    across = toward_viewer_;
    beside = across.cross(tangent);
    // Reversing directions on the weak side with this probability gives 1 + balance cos(phi) exactly, and
    // leaves a uniform azimuth and its stratification unchanged.
    if (u.z < -balance_ * c) {
      c = -c;
      s = -s;
    }
  } else {
    z = shells_[lobe - 1].sample(xi);
    complete_frame(tangent, across, beside);
  }
  const float r = std::sqrt(std::max(0.0f, (1.0f - z) * (1.0f + z)));
  FibreSample sample;
  sample.wi = z * tangent + (r * c) * across + (r * s) * beside;
  sample.value = eval(sample.wi);
  if (!(sample.value.pdf > 0.0f)) return std::nullopt;
  return sample;
}

}  // namespace pelage
