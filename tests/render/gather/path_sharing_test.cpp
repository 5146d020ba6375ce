// SPDX-License-Identifier: Apache-2.0
#include "render/gather/path_sharing.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "render/sampling/pixel_moments.h"

namespace pelage {
namespace {

constexpr uint32_t kPoints = 120, kGatherPoints = 10;

uint32_t gather_point_of(uint32_t point) { return point % kGatherPoints; }

void weights_of(uint32_t point, Rgb* weights) {
  for (uint32_t g = 0; g < kLobeGroups; ++g) {
    for (uint32_t c = 0; c < 3; ++c) {
      weights[g][static_cast<int>(c)] = g == 2 ? 0.0f : unit_float(hash64(point, g, c));
    }
  }
}

/// What arrives from the two lights along the direction of a point: similar for all.
std::vector<Rgb> radiance_of(uint32_t point) {
  const float noise = 0.8f + 0.4f * unit_float(hash64(point, random_use("radiance")));
  return {Rgb(3, 2, 1) * noise, Rgb(0.1f, 0.2f, 0.3f) / noise};
}

/// The light that the points of a gather point scatter, by light and lobe.
std::vector<Rgb> light_of(const PathSharing& sharing, uint32_t gather_point) {
  std::vector<Rgb> result(2 * kLobeGroups, Rgb(0));
  for (uint32_t p = gather_point; p < kPoints; p += kGatherPoints) {
    Rgb weights[kLobeGroups];
    weights_of(p, weights);
    for (size_t light = 0; light < 2; ++light) {
      for (int g = 0; g < kLobeGroups; ++g) {
        result[light * kLobeGroups + static_cast<size_t>(g)] +=
            weights[g] * sharing.radiance(gather_point, light, g);
      }
    }
  }
  return result;
}

void add(PathSharing& sharing, bool guess, float part, uint64_t trial) {
  std::vector<uint32_t> zones(kGatherPoints);
  for (uint32_t k = 0; k < kGatherPoints; ++k) zones[k] = k % 2;
  sharing.begin(kGatherPoints, 2, 2, guess);
  for (uint32_t p = 0; p < kPoints; ++p) {
    Rgb weights[kLobeGroups];
    weights_of(p, weights);
    sharing.add_weights(gather_point_of(p), weights);
    if (unit_float(hash64(p, trial, random_use("choice"))) < part) {
      sharing.add_path(gather_point_of(p), weights, 1 / part, radiance_of(p));
    }
  }
  sharing.finish(zones);
}

std::vector<Rgb> truth_of(uint32_t gather_point) {
  std::vector<Rgb> result(2 * kLobeGroups, Rgb(0));
  for (uint32_t p = gather_point; p < kPoints; p += kGatherPoints) {
    Rgb weights[kLobeGroups];
    weights_of(p, weights);
    const std::vector<Rgb> radiance = radiance_of(p);
    for (size_t light = 0; light < 2; ++light) {
      for (size_t g = 0; g < kLobeGroups; ++g)
        result[light * kLobeGroups + g] += weights[g] * radiance[light];
    }
  }
  return result;
}

TEST(PathSharing, IsExactWhenEveryPointHasItsPath) {
  PathSharing sharing;
  add(sharing, true, 1, 0);
  for (uint32_t gather_point = 0; gather_point < kGatherPoints; ++gather_point) {
    const std::vector<Rgb> light = light_of(sharing, gather_point), truth = truth_of(gather_point);
    for (size_t i = 0; i < truth.size(); ++i) {
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(light[i][c], truth[i][c], 1e-4f * (1 + truth[i][c])) << gather_point;
    }
  }
}

TEST(PathSharing, IsRightOnAverageAndTheOtherGatherPointsOfItsZoneMakeItLessNoisy) {
  double variances[2] = {0, 0};
  for (const bool guess : {false, true}) {
    std::vector<PixelMoments> moments(kGatherPoints * 2 * kLobeGroups);
    PathSharing sharing;
    for (uint64_t trial = 0; trial < 4000; ++trial) {
      add(sharing, guess, 0.4f, trial);
      for (uint32_t gather_point = 0; gather_point < kGatherPoints; ++gather_point) {
        const std::vector<Rgb> light = light_of(sharing, gather_point);
        for (size_t i = 0; i < light.size(); ++i) moments[gather_point * light.size() + i].add(light[i].y);
      }
    }
    for (uint32_t gather_point = 0; gather_point < kGatherPoints; ++gather_point) {
      const std::vector<Rgb> truth = truth_of(gather_point);
      for (size_t i = 0; i < truth.size(); ++i) {
        const PixelMoments& of = moments[gather_point * truth.size() + i];
        EXPECT_NEAR(of.mean, truth[i].y, 4.5 * of.error() + 0.01 * truth[i].y) << gather_point << ", " << i;
        variances[guess ? 1 : 0] += of.variance();
      }
    }
  }
  EXPECT_LT(variances[1], 0.2 * variances[0]);
}

/// The light that the gather points of one of two patches scatter, by light and lobe. Gather point k belongs
/// to patch k % 2.
std::vector<Rgb> light_of_patch(const PathSharing& sharing, uint32_t patch) {
  std::vector<Rgb> result(2 * kLobeGroups, Rgb(0));
  for (uint32_t gather_point = patch; gather_point < kGatherPoints; gather_point += 2) {
    const std::vector<Rgb> light = light_of(sharing, gather_point);
    for (size_t i = 0; i < result.size(); ++i) result[i] += light[i];
  }
  return result;
}

std::vector<uint32_t> two_patches() {
  std::vector<uint32_t> result(kGatherPoints);
  for (uint32_t k = 0; k < kGatherPoints; ++k) result[k] = k % 2;
  return result;
}

TEST(PathSharing, BlendingKeepsTheLightOfAPatch) {
  for (uint64_t trial = 0; trial < 20; ++trial) {
    PathSharing sharing;
    add(sharing, true, 0.2f, trial);
    const std::vector<Rgb> before[] = {light_of_patch(sharing, 0), light_of_patch(sharing, 1)};
    sharing.blend(two_patches(), 2);
    for (uint32_t patch = 0; patch < 2; ++patch) {
      const std::vector<Rgb> after = light_of_patch(sharing, patch);
      for (size_t i = 0; i < after.size(); ++i) {
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(after[i][c], before[patch][i][c], 1e-4f * (1 + std::abs(before[patch][i][c])));
      }
    }
  }
}

TEST(PathSharing, BlendingTakesMostOfTheNoiseOfGatherPoints) {
  double variances[2] = {0, 0};
  for (const bool blended : {false, true}) {
    std::vector<PixelMoments> moments(kGatherPoints);
    PathSharing sharing;
    for (uint64_t trial = 0; trial < 2000; ++trial) {
      add(sharing, true, 0.2f, trial);
      if (blended) sharing.blend(two_patches(), 2);
      for (uint32_t gather_point = 0; gather_point < kGatherPoints; ++gather_point)
        moments[gather_point].add(luminance(sharing.radiance(gather_point, 0, 0)));
    }
    for (const PixelMoments& of : moments) variances[blended ? 1 : 0] += of.variance();
  }
  // The mean of a patch of five gather points has a fifth of their variance. Each gather point also keeps
  // some noise of its own.
  EXPECT_LT(variances[1], 0.4 * variances[0]);
  EXPECT_GT(variances[1], 0.1 * variances[0]);
}

TEST(PathSharing, TheMoreOfAPatchsPathsAGatherPointHasTheMoreItKeepsItsOwn) {
  const auto radiance_of_first = [](uint32_t paths) {
    const Rgb weights[kLobeGroups] = {Rgb(1), Rgb(0), Rgb(0)};
    PathSharing sharing;
    sharing.begin(2, 1, 1, false);
    for (uint32_t gather_point = 0; gather_point < 2; ++gather_point) {
      const Rgb light[] = {Rgb(gather_point == 0 ? 3.0f : 1.0f)};
      for (uint32_t i = 0; i < paths; ++i) {
        sharing.add_weights(gather_point, weights);
        sharing.add_path(gather_point, weights, 1, light);
      }
    }
    sharing.finish({0, 0});
    sharing.blend({0, 0}, 1);
    return sharing.radiance(0, 0, 0).x;
  };
  EXPECT_LT(radiance_of_first(1), 2.2f);
  EXPECT_FLOAT_EQ(radiance_of_first(8), 2.5f);
  EXPECT_GT(radiance_of_first(1000), 2.9f);
}

}  // namespace
}  // namespace pelage
