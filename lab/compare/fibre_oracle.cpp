// SPDX-License-Identifier: Apache-2.0
#include "lab/compare/fibre_oracle.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/hash.h"
#include "render/fibre/core_walk.h"
#include "render/fibre/fibre_material.h"

namespace pelage {
namespace {

constexpr int kPathsPerCheck = 256;  // paths
constexpr float kDegree = kPi / 180;
/// About the default roughness of the physical models.
constexpr float kOpaqueBlur = 10 * kDegree;

float middle_offset(int i, int count) {
  return 2 * (static_cast<float>(i) + 0.5f) / static_cast<float>(count) - 1;
}

/// Albedo of a clear fibre for light perpendicular to it.
float clear_albedo(float absorption) {
  constexpr int kPaths = 4000;
  double sum = 0;
  for (int i = 0; i < kPaths; ++i) {
    const FibrePath path =
        trace_fibre(TracedFibre{}, 0, middle_offset(i, kPaths), 0, static_cast<uint64_t>(i));
    sum += std::exp(-absorption * path.cortex);
  }
  return static_cast<float>(sum / kPaths);
}

void complete(FibreOracle& oracle, ConeShellParams& p) {
  const Rgb albedo(clear_albedo(oracle.absorption));
  p.diffuse = std::max(0.0f, albedo.y - p.primary.y - p.secondary.y);
  p.color = Field(Rgb(1));
  p.primary_tilt = p.secondary_tilt = 0;
  oracle.opaque = true;
}
void complete(FibreOracle& oracle, LambertCylinderParams& p) {
  p.albedo = Rgb(clear_albedo(oracle.absorption));
  oracle.opaque = true;
}
void complete(FibreOracle& oracle, KajiyaKayParams& p) {
  p.diffuse = std::max(0.0f, clear_albedo(oracle.absorption) - p.specular.y);
  oracle.opaque = true;
}
template <class P>
void absorb(const FibreOracle& oracle, P& p) {
  p.absorption = Rgb(oracle.absorption);
  p.preset = HairPreset::kNone;
  p.melanin.reset();
  p.eumelanin.reset();
  p.pheomelanin.reset();
  p.alpha = 0;
}
void complete(FibreOracle& oracle, MarschnerParams& p) {
  absorb(oracle, p);
  oracle.traced.eta = p.eta;
  // Widths in theta_h are half of those in theta_i.
  const float beta = 2 * p.beta * kDegree;
  oracle.longitudinal = {beta, beta / 2, 2 * beta};
  oracle.azimuthal.fill(p.azimuthal_width * kDegree);
}
void complete(FibreOracle& oracle, DeonParams& p) {
  absorb(oracle, p);
  oracle.traced.eta = p.eta;
  const float beta = p.beta * kDegree;
  oracle.longitudinal = {beta, beta / 2, 2 * beta};
  oracle.azimuthal.fill(p.azimuthal_width * kDegree);
}
void complete(FibreOracle& oracle, ChiangParams& p) {
  absorb(oracle, p);
  oracle.traced.eta = p.eta;
  const float beta = std::sqrt(chiang_variance(p.beta_m));
  oracle.longitudinal = {beta, beta / 2, 2 * beta};
  // The deviation of a logistic distribution.
  oracle.azimuthal.fill(chiang_scale(p.beta_n) * kPi / std::sqrt(3.0f));
}
void complete(FibreOracle& oracle, MedullaParams& p) {
  p.sigma_ca = p.sigma_ma = Rgb(oracle.absorption);
  p.alpha = 0;
  const YanOptics o = p.optics();
  oracle.traced = {o.eta, o.layers, o.kappa, o.sigma_ms, o.g};
  const float m = o.beta_m * kDegree, n = o.beta_n * kDegree;
  oracle.longitudinal = {m, m, 1.5f * m};
  oracle.azimuthal = {n, std::sqrt(2.0f) * n, std::sqrt(3.0f) * n};
}
void not_a_fibre() { PELAGE_CHECK(!"a material for skins"); }
void complete(FibreOracle&, LambertParams&) { not_a_fibre(); }
void complete(FibreOracle&, GlossyParams&) { not_a_fibre(); }

}  // namespace

void FibreHistogram::add(const V3f& wi, double weight) {
  const float turn = std::atan2(wi.z, wi.y) / (2 * kPi) + 0.5f;
  const int sine = std::clamp(static_cast<int>((wi.x + 1) * 0.5f * kSines), 0, kSines - 1);
  const int azimuth = std::clamp(static_cast<int>(turn * kAzimuths), 0, kAzimuths - 1);
  cells_[index(sine, azimuth)] += weight;
}

double FibreHistogram::total() const {
  double sum = 0;
  for (double cell : cells_) sum += cell;
  return sum;
}

std::vector<double> FibreHistogram::by_azimuth() const {
  std::vector<double> sums(kAzimuths);
  for (int i = 0; i < kSines; ++i) {
    for (int j = 0; j < kAzimuths; ++j) sums[static_cast<size_t>(j)] += cell(i, j);
  }
  return sums;
}

std::vector<double> FibreHistogram::by_sine() const {
  std::vector<double> sums(kSines);
  for (int i = 0; i < kSines; ++i) {
    for (int j = 0; j < kAzimuths; ++j) sums[static_cast<size_t>(i)] += cell(i, j);
  }
  return sums;
}

double total_variation(const std::vector<double>& a, const std::vector<double>& b) {
  PELAGE_CHECK(a.size() == b.size());
  double total_a = 0, total_b = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    total_a += a[i];
    total_b += b[i];
  }
  if (!(total_a > 0) || !(total_b > 0)) return 1;
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] / total_a - b[i] / total_b);
  return 0.5 * sum;
}

FibreHistogram FibreOracle::model(float theta_o, int samples, const Look& look) const {
  const FibreMaterial material(params);
  FibrePoint point;
  point.tangents.fill(V3f(1, 0, 0));
  point.wo = V3f(std::sin(theta_o), std::cos(theta_o), 0);
  point.color = Rgb(1);
  FibreHistogram histogram;
  for (int i = 0; i < samples; ++i) {
    if (i % kPathsPerCheck == 0) look();
    WalkRandom random(hash64(random_use("model histogram"), static_cast<uint64_t>(i)));
    point.h = middle_offset(i, samples);
    const V3f u(random.unit(), random.unit(), random.unit());
    if (const std::optional<FibreSample> s = material.at(point).sample(u))
      histogram.add(s->wi, static_cast<double>(s->value.total().y / s->value.pdf) / samples);
  }
  return histogram;
}

FibreHistogram FibreOracle::trace(float theta_o, int paths, const Look& look) const {
  std::array<LongitudinalLobe, 3> lobes;
  for (size_t p = 0; p < 3; ++p) lobes[p] = LongitudinalLobe(longitudinal[p] * longitudinal[p]);
  FibreHistogram histogram;
  for (int i = 0; i < paths; ++i) {
    if (i % kPathsPerCheck == 0) look();
    FibrePath path =
        trace_fibre(traced, std::sin(theta_o), middle_offset(i, paths), 1, static_cast<uint64_t>(i));
    if (!path.scattered) {
      WalkRandom random(hash64(random_use("traced histogram"), static_cast<uint64_t>(i)));
      const size_t p = !path.entered ? 0 : path.reflections == 0 ? 1 : 2;
      const float across = std::hypot(path.wi.y, path.wi.z);
      const V2f u(random.unit(), random.unit());
      const float sine = lobes[p].sample(u, -path.wi.x, across);
      const float phi = std::atan2(path.wi.z, path.wi.y) + azimuthal[p] * normal_sample(random.unit());
      const float cosine = std::sqrt((1 - sine) * (1 + sine));
      path.wi = V3f(sine, cosine * std::cos(phi), cosine * std::sin(phi));
    }
    histogram.add(path.wi, std::exp(-absorption * (path.cortex + path.core)) / paths);
  }
  return histogram;
}

FibreOracle fibre_oracle(const MaterialParams& params, float absorption) {
  FibreOracle oracle;
  oracle.params = params;
  oracle.absorption = absorption;
  oracle.longitudinal.fill(kOpaqueBlur);
  oracle.azimuthal.fill(kOpaqueBlur);
  std::visit([&](auto& p) { complete(oracle, p); }, oracle.params);
  return oracle;
}

namespace {

template <class P>
MaterialParams of_model(const MaterialParams& other) {
  if (std::holds_alternative<P>(other)) return other;
  P params;
  const FibreParams* looks = fibre_params(other);
  params.color = looks->color;
  params.opacity = looks->opacity;
  return params;
}

struct Model {
  const char* name;
  MaterialParams (*make)(const MaterialParams&);
};
template <class... P>
std::vector<Model> models_of() {
  return {{P::kTypeName, of_model<P>}...};
}
const std::vector<Model>& models() {
  static const std::vector<Model> all =
      models_of<LambertCylinderParams, KajiyaKayParams, ConeShellParams, MarschnerParams, DeonParams,
                ChiangParams, YanFastParams, YanParams>();
  return all;
}

}  // namespace

const std::vector<std::string>& fibre_model_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Model& model : models()) all.emplace_back(model.name);
    return all;
  }();
  return names;
}

MaterialParams with_fibre_model(const MaterialParams& other, const std::string& model) {
  const auto found =
      std::find_if(models().begin(), models().end(), [&](const Model& m) { return m.name == model; });
  PELAGE_CHECK(found != models().end() && fibre_params(other));
  return found->make(other);
}

}  // namespace pelage
