// SPDX-License-Identifier: Apache-2.0
#include "lod/simplification.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lod/lod_view.h"

namespace pelage {
namespace {

// Size at which half of the strands are kept, relative to the size where thinning begins, by area.
constexpr float kHalf = 0.4f;
constexpr float kMaxFade = 0.1f;
constexpr float kMinFade = 1e-3f;  // strands thinner than this fraction of their width are omitted
constexpr float kMinAreaShare = 1e-7f;
constexpr float kTolerancePixels = 0.1f;
// Min distance of roots along a line through them, times the square root of their density, for the
// progressive order of follicles.
constexpr double kMinRootDistance = 0.6;
// Distance from the strand that was hit at which light starts, relative to the disc of skin that the strand
// represents: far enough that the free line of sight does not imply a free path for the light. Also in
// widths.
constexpr float kSpread = 1.5f;
constexpr float kMaxSpread = 4;
// Back-facing strands: all are kept up to the first cosine, kMinBackFacing of them beyond the second one.
// Those in between are seen at a grazing angle beyond the silhouette, where many strands overlap.
constexpr float kBackFacingBegin = -0.1f, kBackFacingEnd = -0.5f;
constexpr float kMinBackFacing = 0.2f;
// Max width of a strand relative to the blur across it. The variance of a blurred pixel is s^2 / (lambda N)
// for any blur: with wider strands, fur looks streaked.
constexpr float kHidden = 0.1f;
constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kMeanSine = 2 / kPi;  // of lines in random directions

/// Factor by which blur increases the number of strands that contribute to a pixel: the ratio of the areas of
/// a strand of `length` pixels, swept by the footprint of a pixel: a disc of 1 pixel that moves by `motion`,
/// by `across` across the strand, or a disc of confusion.
float blur_ratio(float length, float motion, float across, float confusion) {
  const float still = kPi / 4 + length;
  const float moving = still + motion + length * across;
  const float disc = std::sqrt(1 + confusion * confusion);
  const float blurred = kPi / 4 * disc * disc + length * disc;
  return (moving / still) * (blurred / still);
}

/// Factor on a share where skin faces the camera with this cosine.
float back_facing_share(float facing) {
  const float t = std::clamp((facing - kBackFacingEnd) / (kBackFacingBegin - kBackFacingEnd), 0.0f, 1.0f);
  return kMinBackFacing + (1 - kMinBackFacing) * t * t * (3 - 2 * t);
}

/// Minus the logarithm of the uncovered fraction of a coat with `depth` strands over a point on average,
/// whose minimum distances take up the fraction `room` of the line.
double covering_depth(double depth, double room) {
  room = std::min(room, 0.98);
  if (depth <= room) return -std::log1p(-depth);  // never two
  return (depth - room) / (1 - room) - std::log1p(-room);
}

}  // namespace

Simplification::Simplification(const SimplificationParams& params, const LodView& view,
                               const CoatStats& stats, float budget)
    : params_(params), view_(view), stats_(stats), budget_(budget) {
  tabulate_area();
}

void Simplification::tabulate_area() {
  area_.fill(1);
  if (!stats_.even || !(stats_.density > 0)) return;
  const double depth = double(stats_.density) * stats_.width * stats_.length;
  const double room = kMinRootDistance * stats_.width * std::sqrt(double(stats_.density));
  const double covered = covering_depth(depth, room);
  for (size_t i = 1; i < kAreaSteps; ++i) {
    const double root = static_cast<double>(i) / kAreaSteps;
    double low = 0, high = 1;
    for (int step = 0; step < 24; ++step) {
      const double area = 0.5 * (low + high);
      (covering_depth(depth * area, room * area / root) < covered ? low : high) = area;
    }
    area_[i] = static_cast<float>(high);
  }
  area_[0] = area_[1];
}

float Simplification::size_share(float width) const {
  return params_.size && width < 1 ? std::pow(width, 2 * std::log(0.5f) / std::log(kHalf)) : 1.0f;
}

float Simplification::share(float pixels, float motion, float across, float confusion) const {
  const float width = stats_.width * pixels, length = stats_.length * pixels;
  if (!(width > 0) || !(length > 0)) return 1;  // nothing of them is visible, so nothing can be saved
  float share = size_share(width);
  if (motion > 0 || confusion > 0)
    share *= std::pow(blur_ratio(length, motion, across, confusion), -params_.blur_strength);
  const float blur = kHidden * std::hypot(across, confusion);
  const float widest = std::min(std::hypot(1.0f, blur), length / 4);
  return std::min(std::max(share * budget_, min_kept(width / widest)), 1.0f);
}

float Simplification::min_kept(float share) const {
  return std::max(share, params_.min_share) * std::max(budget_, 1.0f);
}

Simplification::Blur Simplification::blur(const RootPlace& root) const {
  Blur blur;
  if (params_.motion_blur) {
    blur.motion = motion_across(view_, root.open, root.close);
    blur.across = root.direction.length2() > 0
                      ? motion_across_line(view_, root.open, root.close, root.direction)
                      : blur.motion * kMeanSine;
  }
  if (params_.depth_of_field) blur.confusion = confusion_diameter(view_, root.open);
  return blur;
}

float Simplification::share(const RootPlace& root) const {
  const float pixels = params_.quality * pixels_per_unit(view_, root.open);
  const auto [motion, across, confusion] = blur(root);
  const float seen = share(pixels, motion * pixels, across * pixels, confusion * pixels);
  if (!params_.back_facing) return seen;
  const float turned = seen * back_facing_share(facing(view_, root.open, root.normal));
  return std::min(1.0f, std::max(turned, min_kept(0)));
}

LodMeasures Simplification::measures(const RootPlace& root) const {
  const float pixels = params_.quality * pixels_per_unit(view_, root.open);
  const auto [motion, across, confusion] = blur(root);
  LodMeasures m;
  m.width = stats_.width * pixels;
  m.length = stats_.length * pixels;
  m.motion = motion * pixels;
  m.across = across * pixels;
  m.confusion = confusion * pixels;
  m.size_share = size_share(m.width);
  if (m.length > 0 && (m.motion > 0 || m.confusion > 0))
    m.blur_share = std::pow(blur_ratio(m.length, m.motion, m.across, m.confusion), -params_.blur_strength);
  m.facing = facing(view_, root.open, root.normal);
  if (params_.back_facing) m.facing_share = back_facing_share(m.facing);
  m.budget = budget_;
  m.share = share(root);
  return m;
}

float Simplification::max_share(float distance) const {
  // Shares increase with the size and decrease with every blur. Allow for rounding of the roots.
  const float pixels = params_.quality * pixels_per_unit(view_, distance);
  return std::min(1.0f, share(pixels, 0, 0, 0) * (1 + 1e-4f));
}

float Simplification::fade_half_width(float share) { return std::min({kMaxFade, share / 4, 1 - share}); }

float Simplification::fade(float share, float priority) {
  const float t = fade_half_width(share);
  if (t <= 0) return priority < share ? 1.0f : 0.0f;
  return std::clamp((share + t - priority) / (2 * t), 0.0f, 1.0f);
}

float Simplification::gain(float share) const {
  if (!params_.width_gain || share >= 1) return 1;
  const double r = std::clamp(stats_.area_share, kMinAreaShare, 0.5f);
  const float at = std::sqrt(share) * kAreaSteps;
  const auto before = std::min(static_cast<size_t>(at), kAreaSteps - 1);
  const float t = at - static_cast<float>(before);
  const float area = area_[before] * (1 - t) + area_[before + 1] * t;
  return area * static_cast<float>(-std::expm1(std::log1p(-r) / share) / r);
}

float Simplification::spread(float share) const {
  if (share >= 1 || !(stats_.density > 0)) return 0;
  const float disc = std::sqrt((1 / share - 1) / (kPi * stats_.density));
  return std::min(kSpread * disc, kMaxSpread * stats_.width * gain(share));
}

float Simplification::own_shadow(float share) const {
  const float max = spread(share);
  if (!stats_.even || !params_.width_gain || !(max > 0)) return 0;
  // In a disc of skin that contains only this strand, light from a random point hits it with probability
  // width / (pi radius); strands kept at full detail also have such a disc.
  const float disc = std::sqrt((1 / share - 1) / (kPi * stats_.density));
  return std::max(0.0f, 1 - kSpread * std::sqrt(share)) * std::sqrt(1 - share) * (max / (kSpread * disc));
}

float Simplification::width_factor(float share, float priority) const {
  if (share >= 1) return 1;
  const float faded = fade(share, priority);
  return faded < kMinFade ? 0.0f : faded * gain(share);
}

float Simplification::max_width_factor(float distance) const {
  const float pixels = params_.quality * pixels_per_unit(view_, distance);
  const float width = stats_.width * pixels, length = stats_.length * pixels;
  if (!(width > 0) || !(length > 0)) return 1;
  // Lower bound of the share for any blur; without blur, the share at this distance.
  float min = min_kept(4 * width / length);
  if (!params_.motion_blur && !params_.depth_of_field) min = std::max(min, share(pixels, 0, 0, 0));
  min = std::min(min, 1.0f) * (params_.back_facing ? kMinBackFacing : 1.0f);
  min = std::max(min, min_kept(0));
  return gain(std::min(min, 1.0f)) * (1 + 1e-4f);
}

float Simplification::contrast(float share) const {
  return params_.contrast && share < 1 ? std::sqrt(share) : 1.0f;
}

float Simplification::tolerance(const V3f& root_at_open) const {
  return params_.fewer_points ? kTolerancePixels / (params_.quality * pixels_per_unit(view_, root_at_open))
                              : 0.0f;
}

ContentHash Simplification::hash() const {
  ContentHasher hasher;
  hasher.add("simplification");
  const auto add = [&](const auto&... values) { (hasher.add(values), ...); };
  const SimplificationParams& p = params_;
  add(p.quality, p.size, p.motion_blur, p.depth_of_field, p.back_facing, p.width_gain, p.contrast,
      p.fewer_points, p.blur_strength, p.min_share, budget_, stats_.width, stats_.length, stats_.area_share,
      stats_.density, static_cast<uint32_t>(stats_.even));
  for (const LodPose* pose : {&view_.open, &view_.close}) {
    for (const V3f* v : {&pose->position, &pose->right, &pose->up, &pose->forward}) add(v->x, v->y, v->z);
    add(pose->focal_pixels);
  }
  add(view_.near_distance, view_.lens_diameter, view_.focus_distance);
  return hasher.digest();
}

}  // namespace pelage
