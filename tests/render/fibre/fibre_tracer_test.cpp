// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/fibre_tracer.h"

#include <array>

#include <gtest/gtest.h>

#include "render/fibre/attenuation.h"
#include "render/fibre/core_walk.h"
#include "render/fibre/fibre_frame.h"
#include "tests/render/sphere_statistics.h"

namespace pelage {
namespace {

/// Energy by way, averaged over h, of paths weighted by what the cortex absorbs.
struct Energies {
  double r = 0, tt = 0, trt = 0, rest = 0, scattered = 0, total = 0;
};
Energies energies(const TracedFibre& fibre, float theta_o, double sigma, int paths) {
  Energies e;
  for (int i = 0; i < paths; ++i) {
    const float h = 2 * (static_cast<float>(i) + 0.5f) / static_cast<float>(paths) - 1;
    const FibrePath path = trace_fibre(fibre, std::sin(theta_o), h, 5, i);
    const double w = std::exp(-sigma * path.cortex) / paths;
    e.total += w;
    if (!path.entered) {
      e.r += w;
    } else if (path.scattered) {
      e.scattered += w;
    } else if (path.reflections == 0) {
      e.tt += w;
    } else if (path.reflections == 1) {
      e.trt += w;
    } else {
      e.rest += w;
    }
  }
  return e;
}

TEST(FibreTracer, EnergiesOfAClearFibre) {
  // Closed forms, averaged over h.
  struct Row {
    float theta;
    double sigma, r, tt, trt, rest;
  };
  for (const Row& row :
       {Row{0, 0, .07495, .86179, .05567, .00758}, Row{.6f, 0, .09093, .83469, .06389, .01049},
        Row{0, .5, .07495, .33998, .00933, .00052}}) {
    constexpr int kPaths = 100000;
    const Energies e = energies(TracedFibre{}, row.theta, row.sigma, kPaths);
    const auto error = [](double share) { return 4 * std::sqrt(share * (1 - share) / kPaths); };
    EXPECT_NEAR(e.r, row.r, error(row.r));
    EXPECT_NEAR(e.tt, row.tt, error(row.tt));
    EXPECT_NEAR(e.trt, row.trt, error(row.trt));
    EXPECT_NEAR(e.rest, row.rest, error(row.rest));
  }
}

TEST(FibreTracer, EnergiesOfAScatteringMedulla) {
  TracedFibre fibre;
  fibre.medulla = 0.8f;
  fibre.scattering = 2;
  fibre.anisotropy = 0.4f;
  const Energies e = energies(fibre, 0, 0, 100000);
  EXPECT_NEAR(e.r, .0748, 3e-3);
  EXPECT_NEAR(e.tt, .0531, 3e-3);
  EXPECT_NEAR(e.scattered, .8671 + .0046, 4e-3);
  EXPECT_NEAR(e.total, 1, 1e-9);
}

/// What the medulla scatters of light across a fibre: spread of sin(theta), mean cosine of the azimuth from
/// straight on, and lengths travelled in cortex and medulla, for four fibres.
TEST(FibreTracer, ScatteredLightOfTheReferenceFibres) {
  struct Row {
    float kappa, sigma_ms, g, eta;
    double spread, ahead, cortex, core;
  };
  for (const Row& row :
       {Row{.86f, 3.15f, .79f, 1.49f, .482, .223, .96, 3.52},
        Row{.88f, 1.69f, .44f, 1.55f, .490, .093, .97, 4.22}, Row{.8f, 2, .4f, 1.55f, .491, .076, 1.40, 3.47},
        Row{.5f, 1, 0, 1.55f, .529, .001, 2.84, 2.01}}) {
    TracedFibre fibre;
    fibre.eta = row.eta;
    fibre.medulla = row.kappa;
    fibre.scattering = row.sigma_ms;
    fibre.anisotropy = row.g;
    constexpr int kPaths = 60000;
    RunningMean sine2, ahead, cortex, core;
    for (int i = 0; i < kPaths; ++i) {
      const float h = 2 * (static_cast<float>(i) + 0.5f) / kPaths - 1;
      const FibrePath path = trace_fibre(fibre, 0, h, 12, i);
      if (!path.scattered) continue;
      sine2.add(path.wi.x * path.wi.x);
      ahead.add(-path.wi.y / std::max(1e-6f, std::hypot(path.wi.y, path.wi.z)));
      cortex.add(path.cortex);
      core.add(path.core);
    }
    EXPECT_NEAR(std::sqrt(sine2.mean()), row.spread, 5e-3) << row.kappa;
    EXPECT_NEAR(ahead.mean(), row.ahead, 2e-3 + 4.5 * ahead.standard_error()) << row.kappa;
    EXPECT_NEAR(cortex.mean(), row.cortex, 0.01 + 4.5 * cortex.standard_error()) << row.kappa;
    EXPECT_NEAR(core.mean(), row.core, 0.01 + 4.5 * core.standard_error()) << row.kappa;
  }
}

TEST(FibreTracer, AClearFibreSendsLightWhereGeometrySays) {
  for (float theta : {0.0f, 0.5f, -1.1f}) {
    for (float h : {-0.9f, -0.3f, 0.0f, 0.55f}) {
      const FibreCrossing crossing(1.55f, 0, std::sin(theta), std::cos(theta), h);
      for (int i = 0; i < 200; ++i) {
        const FibrePath path = trace_fibre(TracedFibre{}, std::sin(theta), h, 1, i);
        const int p = path.entered ? 1 + path.reflections : 0;
        EXPECT_NEAR(path.wi.x, -std::sin(theta), 1e-4);
        const float phi = std::atan2(path.wi.z, path.wi.y);
        EXPECT_NEAR(wrapped_angle(phi - crossing.exit_azimuth(p)), 0, 2e-3f * static_cast<float>(1 + p));
        EXPECT_NEAR(path.cortex, static_cast<float>(p) * crossing.leg(), 1e-3f * static_cast<float>(1 + p));
      }
    }
  }
}

TEST(FibreTracer, APathIsAFunctionOfSeedAndNumber) {
  TracedFibre fibre;
  fibre.medulla = 0.7f;
  fibre.scattering = 3;
  const FibrePath a = trace_fibre(fibre, 0.2f, 0.1f, 9, 4), b = trace_fibre(fibre, 0.2f, 0.1f, 9, 4);
  EXPECT_EQ(a.wi, b.wi);
  EXPECT_EQ(a.core, b.core);
  EXPECT_NE(trace_fibre(fibre, 0.2f, 0.1f, 9, 5).core, a.core);
}

/// The medulla alone, light across it at h: unscattered part, back-scattered fraction of the rest, its mean
/// path and mean cosine of the deflection.
TEST(CoreWalk, ReproducesTheReferenceTable) {
  struct Row {
    float sigma, g, h;
    double unscattered, back, path, cosine;
  };
  for (const Row& row :
       {Row{1, 0, 0, .1353, .576, 2.353, -.116}, Row{1, .8f, 0, .1353, .131, 2.182, .656},
        Row{2, .4f, 0, .0183, .540, 2.388, -.057}, Row{2, .4f, .6f, .0408, .469, 2.058, .046},
        Row{4, 0, 0, .0003, .806, 2.450, -.465}, Row{8, .8f, .6f, .0000, .502, 2.123, -.020}}) {
    constexpr int kPaths = 60000;
    int straight = 0, back = 0;
    RunningMean path, cosine;
    for (int i = 0; i < kPaths; ++i) {
      WalkRandom random(hash64(31, i));
      CoreWalk walk{{-std::sqrt(1 - row.h * row.h), row.h}, {0, 1, 0}};
      float length = 0;
      if (!walk.cross(1, row.sigma, row.g, random, length)) {
        ++straight;
        continue;
      }
      const float across = std::hypot(walk.direction.y, walk.direction.z);
      back += walk.direction.y < 0;
      path.add(length);
      cosine.add(walk.direction.y / across);
    }
    EXPECT_NEAR(straight / double(kPaths), row.unscattered, 6e-3);
    EXPECT_NEAR(back / double(kPaths - straight), row.back, 1e-2);
    EXPECT_NEAR(path.mean(), row.path, 2e-3 + 5 * path.standard_error());
    EXPECT_NEAR(cosine.mean(), row.cosine, 2e-3 + 5 * cosine.standard_error());
  }
}

}  // namespace
}  // namespace pelage
