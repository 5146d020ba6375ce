// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/vector.h"
#include "render/light/far_light_samples.h"
#include "render/light/light_set.h"
#include "render/light/scatter_point.h"
#include "render/sampling/sample_stream.h"
#include "render/sampling/systematic_choice.h"

namespace pelage {

/// Returns the weight, by the balance heuristic, of a sample that one technique takes with density `pdf` and
/// another would take with density `other`. Both densities are per solid angle; each technique takes one
/// sample [Veach97, section 9.2.2]. Returns 0 when `pdf` is 0.
inline float balance_weight(float pdf, float other) { return pdf > 0 ? pdf / (pdf + other) : 0.0f; }

/// Returns the weight of such a sample by the power heuristic with exponent 2 [Veach97, section 9.2.3].
/// Squares the ratio of the densities instead of the densities, so that large densities do not overflow. If
/// the square of the ratio overflows, the weight is 0.
inline float power_weight(float pdf, float other) {
  if (!(pdf > 0)) return 0.0f;
  const float ratio = other / pdf;
  return 1.0f / (1.0f + ratio * ratio);
}

/// Techniques that estimate direct light: light sampling and lobe sampling, combined by the power heuristic
/// (kBoth), or one of them alone. Every choice converges to the same picture. One technique alone is for
/// tests and comparisons; lobe sampling does not find lights in which some parts cast no shadows
/// (Light::casters()).
enum class DirectTechniques { kBoth, kLightsOnly, kLobesOnly };

/// How lights are selected: by Light::importance() alone, which is solid angle * mean radiance ["Rendering
/// Fur in Life of Pi", stochastic light selection], or also by the scattering towards them
/// (LightSet::probabilities()). The probability is part of the density for MIS in both cases, so the mean is
/// the same. The first is for tests and comparisons.
enum class LightChoice { kImportance, kLobes };

/// A point on a light that a shadow ray may be traced to.
struct LightPoint {
  size_t light = 0;
  V3f direction{0};     ///< unit, from the scatter point
  float distance = 0;   ///< from the scatter point
  FibreValue value;     ///< scattering of light from this direction
  Rgb arriving{0};      ///< radiance * weight of the technique / density of one point
  float luminance = 0;  ///< of the light that is scattered to the viewer: value.total() * arriving
  const PartSet* casters = nullptr;  ///< Light::casters()
};

/// Memory of one thread, reused for each scatter point.
struct DirectLightScratch {
  LightChoices choices;                    ///< the current point's
  std::vector<float> selecting;            ///< random numbers that select the lights of the candidates
  std::vector<LightSet::Choice> selected;  ///< these lights
  std::vector<LightPoint> points;
  uint32_t proved = 0;  ///< count of candidates that the last propose() left out because the skin blocks them
};

/// Estimates direct light at a scatter point with two techniques, weighted by the power heuristic [Veach97,
/// section 9.2].
///
/// Light sampling selects lights by importance, and samples several candidate points on them. The targets of
/// shadow rays are resampled from the candidates, in proportion to the light that each candidate would
/// contribute if nothing blocked it. This pays because evaluating a fibre costs much less than tracing a ray
/// [Talbot05]. Lobe sampling samples a direction from the lobes, and finds the lights that a ray in this
/// direction hits. Lights do not block rays or each other.
///
/// At each point, call begin() first, then propose() and choose() for shadow rays, and find_lights() for a
/// ray sampled from the lobes. The caller traces the rays. Thread safety: const members may be called from
/// any thread, each with its own scratch.
class DirectLight {
 public:
  /// `lights` must outlive this object. `rays`: max count of shadow rays per scatter point. `far`: where
  /// points on lights come from; null: Light::sample().
  DirectLight(const LightSet& lights, int rays, DirectTechniques techniques,
              const FarLightSamples* far = nullptr, LightChoice choice = LightChoice::kLobes)
      : lights_(lights),
        far_(far),
        rays_(static_cast<uint32_t>(rays)),
        techniques_(techniques),
        choice_(choice) {}

  /// Length of a shadow ray / distance of the light: the ray ends slightly before the light, so that a
  /// surface touching the light does not block it.
  static constexpr float kJustBefore = 1 - 1e-4f;

  DirectTechniques techniques() const { return techniques_; }
  /// Returns the count of candidates that propose() samples.
  uint32_t candidates() const { return rays_ * kCandidates; }
  /// Returns the weight of one candidate: 1 / count of candidates, because direct light is their mean.
  float candidate_weight() const { return 1 / static_cast<float>(rays_ * kCandidates); }

  /// Computes the probability of selecting each light at a scatter point.
  void begin(const ScatterPoint& point, DirectLightScratch& scratch) const {
    constexpr float kUniform = 1 / (4 * kPi);
    lights_.prepare(
        point.position(),
        [&](const V3f& wi) { return choice_ == LightChoice::kLobes ? point.eval(wi).pdf : kUniform; },
        [&](const Light& light) { return point.receives(light); }, scratch.choices);
  }

  /// Samples candidate points into scratch.points, without those that ScatterPoint::is_shadowed(): they
  /// would contribute nothing, so leaving them out changes no expected value. `u`: two random numbers in [0,
  /// 1). `lobe_pdf(value)` must return the density with which lobe sampling finds a direction whose
  /// scattering is `value`.
  template <class LobePdf>
  void propose(const ScatterPoint& point, const V2f& u, const LobePdf& lobe_pdf,
               DirectLightScratch& scratch) const;

  /// Returns the count of shadow rays per scatter point, unless choose() is asked for more.
  uint32_t rays() const { return rays_; }
  /// Selects candidates as targets of shadow rays, `rays` on average, with repetitions; those with larger
  /// factors more often. Calls `shadow(target, factor)` for each of them. If nothing blocks the shadow ray,
  /// the light that arrives is target.arriving * factor. `u`: a random number in [0, 1).
  template <class Shadow>
  void choose(float rays, float u, const DirectLightScratch& scratch, const Shadow& shadow) const;

  /// Calls `found(light, hit, weight)` for each light that a ray in `direction` intersects before `distance`.
  /// The direction was sampled from the lobes with density `lobe_pdf`. `weight`: weight of this technique.
  template <class Found>
  void find_lights(const ScatterPoint& point, const V3f& direction, float distance, float lobe_pdf,
                   const DirectLightScratch& scratch, const Found& found) const;

 private:
  /// Count of candidate points per shadow ray.
  static constexpr uint32_t kCandidates = 4;
  static constexpr float kGolden = 0.6180339887f;

  /// Returns the density of light sampling that the power heuristic compares with the density of lobe
  /// sampling. `pdf`: density of one candidate point. For a light at a finite distance, it is `pdf` times the
  /// count of candidates, although only some candidates get a shadow ray. Otherwise, small bright lights
  /// would cause noise in long paths, because lobes rarely hit them. For an environment, it is `pdf` times
  /// the count of shadow rays, because every ray that leaves the scene hits the environment.
  float competing_pdf(float pdf, float distance) const {
    const float points = std::isfinite(distance) ? static_cast<float>(kCandidates) : 1.0f;
    return pdf * points * static_cast<float>(rays_);
  }
  template <class LobePdf>
  std::optional<LightPoint> light_point(const ScatterPoint& point, const LightSet::Choice& choice, float u,
                                        const LobePdf& lobe_pdf, DirectLightScratch& scratch) const;

  const LightSet& lights_;
  const FarLightSamples* const far_;
  const uint32_t rays_;
  const DirectTechniques techniques_;
  const LightChoice choice_;
};

template <class LobePdf>
void DirectLight::propose(const ScatterPoint& point, const V2f& u, const LobePdf& lobe_pdf,
                          DirectLightScratch& scratch) const {
  const uint32_t count = candidates();
  scratch.points.clear();
  scratch.proved = 0;
  // Each point alone is uniformly distributed; together they form a lattice that takes the lights in turn.
  scratch.selecting.resize(count);
  scratch.selected.resize(count);
  for (uint32_t k = 0; k < count; ++k)
    scratch.selecting[k] = std::min((u.x + static_cast<float>(k)) / static_cast<float>(count), kBelowOne);
  lights_.choose(scratch.choices, scratch.selecting, scratch.selected);
  for (uint32_t k = 0; k < count; ++k) {
    const float turn = u.y + static_cast<float>(k) * kGolden;
    const float at = std::min(turn - std::floor(turn), kBelowOne);
    if (const auto sample = light_point(point, scratch.selected[k], at, lobe_pdf, scratch))
      scratch.points.push_back(*sample);
  }
}

template <class LobePdf>
std::optional<LightPoint> DirectLight::light_point(const ScatterPoint& point, const LightSet::Choice& choice,
                                                   float u, const LobePdf& lobe_pdf,
                                                   DirectLightScratch& scratch) const {
  if (!(choice.probability > 0)) return std::nullopt;
  const Light& light = lights_.light(choice.light);
  if (!point.receives(light)) return std::nullopt;
  const V2f place(choice.remapped, u);
  const auto seen =
      far_ ? far_->sample(choice.light, point.position(), place) : light.sample(point.position(), place);
  if (!seen || !(seen->pdf > 0)) return std::nullopt;
  const auto sample = point.exit().toward(*seen);
  if (!sample) return std::nullopt;
  if (!light.casters() && point.is_shadowed(sample->direction, sample->distance * kJustBefore)) {
    ++scratch.proved;
    return std::nullopt;
  }
  LightPoint result;
  result.light = choice.light;
  result.casters = light.casters();
  result.direction = sample->direction;
  result.distance = sample->distance;
  result.value = point.eval(sample->direction);
  const float pdf = choice.probability * sample->pdf;
  const float weight = techniques_ == DirectTechniques::kBoth && !light.casters()
                           ? power_weight(competing_pdf(pdf, sample->distance), lobe_pdf(result.value))
                           : 1.0f;
  result.arriving = sample->radiance * (weight / pdf);
  result.luminance = luminance(point.likely(sample->direction, result.value) * result.arriving);
  if (!(result.luminance > 0)) return std::nullopt;
  return result;
}

template <class Shadow>
void DirectLight::choose(float rays, float u, const DirectLightScratch& scratch, const Shadow& shadow) const {
  // Points are chosen in proportion to the unoccluded light that they contribute.
  double all = 0;
  for (const LightPoint& point : scratch.points) all += double{point.luminance};
  if (!(all > 0)) return;
  SystematicChoice choice(all / double{rays}, u);
  const auto count = static_cast<float>(rays_ * kCandidates);
  for (const LightPoint& point : scratch.points) {
    const uint32_t chosen = choice.times(point.luminance);
    if (chosen > 0) shadow(point, static_cast<float>(chosen * choice.step() / (point.luminance * count)));
  }
}

template <class Found>
void DirectLight::find_lights(const ScatterPoint& point, const V3f& direction, float distance, float lobe_pdf,
                              const DirectLightScratch& scratch, const Found& found) const {
  const V3f from = point.exit().origin(direction);
  lights_.on_ray(from, direction, distance, [&](size_t i) {
    const Light& light = lights_.light(i);
    if (light.casters() || !point.receives(light)) return;
    const auto hit = light.intersect(from, direction);
    if (!hit || hit->distance > distance || !(max_component(hit->radiance) > 0)) return;
    float weight = 1;
    if (techniques_ == DirectTechniques::kBoth) {
      const float pdf = lights_.probability(scratch.choices, i) * point.exit().pdf(light, direction, *hit);
      weight = power_weight(lobe_pdf, competing_pdf(pdf, hit->distance));
    }
    found(i, *hit, weight);
  });
}

}  // namespace pelage
