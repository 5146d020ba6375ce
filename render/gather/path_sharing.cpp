// SPDX-License-Identifier: Apache-2.0
#include "render/gather/path_sharing.h"

namespace pelage {
namespace {

/// The mean of a patch weighs as much as this number of a gather point's own paths. See docs/lab/GATHER.md.
constexpr float kPatchPaths = 8;

Rgb ratio(const Rgb& part, const Rgb& of, const Rgb& scale) {
  Rgb result(0);
  for (int c = 0; c < 3; ++c) {
    if (of[c] > 1e-6f * scale[c]) result[c] = part[c] / of[c];
  }
  return result;
}

}  // namespace

void PathSharing::begin(size_t gather_points, uint32_t zones, size_t lights, bool guess) {
  lights_ = lights;
  guess_ = guess;
  profile_.begin(1);
  weights_.assign(gather_points, {});
  arrived_.assign(gather_points * lights * kLobeGroups, Rgb(0));
  zone_traced_.assign(zones, Rgb(0));
  zone_arrived_.assign(zones * lights, Rgb(0));
}

void PathSharing::add_weights(uint32_t gather_point, const Rgb* weights) {
  for (int g = 0; g < kLobeGroups; ++g) weights_[gather_point].all[g] += weights[g];
}

void PathSharing::add_path(uint32_t gather_point, const Rgb* weights, float factor,
                           std::span<const Rgb> radiance) {
  ++weights_[gather_point].paths;
  for (int g = 0; g < kLobeGroups; ++g) weights_[gather_point].traced[g] += factor * weights[g];
  Rgb* arrived = &arrived_[gather_point * lights_ * kLobeGroups];
  for (const Rgb& light : radiance) {
    for (int g = 0; g < kLobeGroups; ++g) *arrived++ += factor * weights[g] * light;
  }
}

void PathSharing::finish(const std::vector<uint32_t>& zone_of_gather_point) {
  const auto traced = [&](size_t gather_point) {
    return weights_[gather_point].traced[0] + weights_[gather_point].traced[1] +
           weights_[gather_point].traced[2];
  };
  const auto arrived = [&](size_t gather_point, size_t light) {
    const Rgb* of = &arrived_[(gather_point * lights_ + light) * kLobeGroups];
    return of[0] + of[1] + of[2];
  };
  for (size_t gather_point = 0; guess_ && gather_point < zone_of_gather_point.size(); ++gather_point) {
    const uint32_t zone = zone_of_gather_point[gather_point];
    zone_traced_[zone] += traced(gather_point);
    for (size_t i = 0; i < lights_; ++i) zone_arrived_[zone * lights_ + i] += arrived(gather_point, i);
  }
  for (size_t gather_point = 0; gather_point < zone_of_gather_point.size(); ++gather_point) {
    const Weights& own = weights_[gather_point];
    const Rgb& zone = zone_traced_[zone_of_gather_point[gather_point]];
    for (size_t i = 0; i < lights_; ++i) {
      const Rgb& all = zone_arrived_[zone_of_gather_point[gather_point] * lights_ + i];
      const Rgb guess =
          guess_ ? ratio(all - arrived(gather_point, i), zone - traced(gather_point), zone) : Rgb(0);
      Rgb* of = &arrived_[(gather_point * lights_ + i) * kLobeGroups];
      for (int g = 0; g < kLobeGroups; ++g) {
        of[g] = guess + ratio(of[g] - guess * own.traced[g], own.all[g], Rgb(0));
      }
    }
  }
}

void PathSharing::blend(const std::vector<uint32_t>& patch_of_gather_point, uint32_t patches) {
  const auto part = [&](size_t gather_point) {
    return kPatchPaths / (kPatchPaths + static_cast<float>(weights_[gather_point].paths));
  };
  const size_t values = lights_ * kLobeGroups;  // of a gather point
  patch_weights_.assign(size_t{patches} * kLobeGroups, Rgb(0));
  patch_scattered_.assign(patches * values, Rgb(0));
  for (size_t gather_point = 0; gather_point < patch_of_gather_point.size(); ++gather_point) {
    const size_t patch = patch_of_gather_point[gather_point];
    const Rgb* radiance = &arrived_[gather_point * values];
    Rgb weights[kLobeGroups];
    for (size_t g = 0; g < kLobeGroups; ++g) {
      weights[g] = part(gather_point) * weights_[gather_point].all[g];
      patch_weights_[patch * kLobeGroups + g] += weights[g];
    }
    for (size_t i = 0; i < values; ++i)
      patch_scattered_[patch * values + i] += weights[i % kLobeGroups] * radiance[i];
  }
  for (size_t gather_point = 0; gather_point < patch_of_gather_point.size(); ++gather_point) {
    const size_t patch = patch_of_gather_point[gather_point];
    for (size_t i = 0; i < values; ++i) {
      Rgb& radiance = arrived_[gather_point * values + i];
      const Rgb& weights = patch_weights_[patch * kLobeGroups + i % kLobeGroups];
      radiance +=
          part(gather_point) * (ratio(patch_scattered_[patch * values + i], weights, Rgb(0)) - radiance);
    }
  }
}

}  // namespace pelage
