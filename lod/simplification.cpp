// SPDX-License-Identifier: Apache-2.0
#include "lod/simplification.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lod/depth_of_field.h"
#include "lod/motion_blur.h"
#include "lod/size.h"
#include "lod/turned_away.h"

namespace pelage {
namespace {

// Of the size at which half of the strands are kept, relative to that where thinning begins, by area.
constexpr float kHalf = 0.4f;
constexpr float kMostFade = 0.1f;
constexpr float kLeastFade = 1e-3f;  // what is thinner than this part of itself does not exist
constexpr float kLeastAreaShare = 1e-7f;
constexpr float kTolerancePixels = 0.1f;
// Least distance of roots from each other on a line through them, times the root of their density: of the
// progressive order of follicles.
constexpr double kRoom = 0.6;
// How far light starts from the strand that was hit, relative to the disc of skin that the strand stands for:
// far enough that what the line of sight found clear does not count for the light too. And in widths.
constexpr float kSpread = 1.5f;
constexpr float kMostSpread = 4;
// Strands turned away: all of them down to the first cosine, kLeastTurned from the second one on. What is
// between them is seen past the edge of an animal, at a grazing angle, where many strands lie over each
// other.
constexpr float kTurnsAway = -0.1f, kTurnedAway = -0.5f;
constexpr float kLeastTurned = 0.2f;
// How wide a strand may be relative to the blur across it. What a blurred pixel collects varies by
// s^2 / (lambda N) however it is blurred: with more, fur looks streaked.
constexpr float kHidden = 0.1f;
constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kMeanSine = 2 / kPi;  // of lines in all directions

/// How many times as many strands contribute to a pixel as without blur: ratio of the areas of a strand of
/// `length` pixels swept by what a pixel collects, a disc of 1 pixel that moves by `motion`, by `across`
/// across the strand, or a disc of confusion.
float blur_ratio(float length, float motion, float across, float confusion) {
  const float still = kPi / 4 + length;
  const float moving = still + motion + length * across;
  const float disc = std::sqrt(1 + confusion * confusion);
  const float blurred = kPi / 4 * disc * disc + length * disc;
  return (moving / still) * (blurred / still);
}

/// What is left of a share where skin faces the camera like this.
float still_seen(float facing) {
  const float t = std::clamp((facing - kTurnedAway) / (kTurnsAway - kTurnedAway), 0.0f, 1.0f);
  return kLeastTurned + (1 - kLeastTurned) * t * t * (3 - 2 * t);
}

/// Minus the logarithm of what is bare, of a coat of which `depth` strands stand over a point on average and
/// keep a distance, of the part `room` of the line along which they do.
double covering_depth(double depth, double room) {
  room = std::min(room, 0.98);
  if (depth <= room) return -std::log1p(-depth);  // never two
  return (depth - room) / (1 - room) - std::log1p(-room);
}

}  // namespace

Simplification::Simplification(const SimplificationParams& params, const LodView& view,
                               const StrandNature& nature, float budget)
    : params_(params), view_(view), nature_(nature), budget_(budget) {
  tabulate_area();
}

void Simplification::tabulate_area() {
  area_.fill(1);
  if (!nature_.even || !(nature_.density > 0)) return;
  const double depth = double(nature_.density) * nature_.width * nature_.length;
  const double room = kRoom * nature_.width * std::sqrt(double(nature_.density));
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

float Simplification::share(float pixels, float motion, float across, float confusion) const {
  const float width = nature_.width * pixels, length = nature_.length * pixels;
  if (!(width > 0) || !(length > 0)) return 1;  // nothing is seen of them: nothing is to be gained
  float share = 1;
  if (params_.size && width < 1) share = std::pow(width, 2 * std::log(0.5f) / std::log(kHalf));
  if (motion > 0 || confusion > 0)
    share *= std::pow(blur_ratio(length, motion, across, confusion), -params_.blur_strength);
  const float blur = kHidden * std::hypot(across, confusion);
  const float widest = std::min(std::hypot(1.0f, blur), length / 4);
  return std::min(std::max(share * budget_, least_kept(width / widest)), 1.0f);
}

float Simplification::least_kept(float share) const {
  return std::max(share, params_.least_share) * std::max(budget_, 1.0f);
}

float Simplification::share(const RootPlace& root) const {
  const float pixels = params_.quality * pixels_per_unit(view_, root.open);
  float motion = 0, across = 0, confusion = 0;
  if (params_.motion_blur) {
    motion = motion_across(view_, root.open, root.close);
    across = root.lie.length2() > 0 ? motion_across_line(view_, root.open, root.close, root.lie)
                                    : motion * kMeanSine;
  }
  if (params_.depth_of_field) confusion = confusion_diameter(view_, root.open);
  const float seen = share(pixels, motion * pixels, across * pixels, confusion * pixels);
  if (!params_.turned_away) return seen;
  return std::min(1.0f, std::max(seen * still_seen(facing(view_, root.open, root.normal)), least_kept(0)));
}

float Simplification::most_share(float distance) const {
  // Shares grow with the size and shrink with every blur. Roots may be off by some rounding.
  const float pixels = params_.quality * pixels_per_unit(view_, distance);
  return std::min(1.0f, share(pixels, 0, 0, 0) * (1 + 1e-4f));
}

float Simplification::fade_half_width(float share) { return std::min({kMostFade, share / 4, 1 - share}); }

float Simplification::fade(float share, float priority) {
  const float t = fade_half_width(share);
  if (t <= 0) return priority < share ? 1.0f : 0.0f;
  return std::clamp((share + t - priority) / (2 * t), 0.0f, 1.0f);
}

float Simplification::gain(float share) const {
  if (!params_.width_gain || share >= 1) return 1;
  const double r = std::clamp(nature_.area_share, kLeastAreaShare, 0.5f);
  const float at = std::sqrt(share) * kAreaSteps;
  const auto before = std::min(static_cast<size_t>(at), kAreaSteps - 1);
  const float t = at - static_cast<float>(before);
  const float area = area_[before] * (1 - t) + area_[before + 1] * t;
  return area * static_cast<float>(-std::expm1(std::log1p(-r) / share) / r);
}

float Simplification::spread(float share) const {
  if (share >= 1 || !(nature_.density > 0)) return 0;
  const float disc = std::sqrt((1 / share - 1) / (kPi * nature_.density));
  return std::min(kSpread * disc, kMostSpread * nature_.width * gain(share));
}

float Simplification::own_shadow(float share) const {
  const float most = spread(share);
  if (!nature_.even || !params_.width_gain || !(most > 0)) return 0;
  // In a disc of skin of which the strand is the only one, light that starts anywhere meets it with
  // probability width / (pi radius); those strands have such a disc too that full detail leaves in place.
  const float disc = std::sqrt((1 / share - 1) / (kPi * nature_.density));
  return std::max(0.0f, 1 - kSpread * std::sqrt(share)) * std::sqrt(1 - share) * (most / (kSpread * disc));
}

float Simplification::width_factor(float share, float priority) const {
  if (share >= 1) return 1;
  const float faded = fade(share, priority);
  return faded < kLeastFade ? 0.0f : faded * gain(share);
}

float Simplification::most_width_factor(float distance) const {
  const float pixels = params_.quality * pixels_per_unit(view_, distance);
  const float width = nature_.width * pixels, length = nature_.length * pixels;
  if (!(width > 0) || !(length > 0)) return 1;
  // What the share is at least, whatever the blur; without blur, what it is at this distance.
  float least = least_kept(4 * width / length);
  if (!params_.motion_blur && !params_.depth_of_field) least = std::max(least, share(pixels, 0, 0, 0));
  least = std::min(least, 1.0f) * (params_.turned_away ? kLeastTurned : 1.0f);
  least = std::max(least, least_kept(0));
  return gain(std::min(least, 1.0f)) * (1 + 1e-4f);
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
  add(p.quality, p.size, p.motion_blur, p.depth_of_field, p.turned_away, p.width_gain, p.contrast,
      p.fewer_points, p.blur_strength, p.least_share, budget_, nature_.width, nature_.length,
      nature_.area_share, nature_.density, static_cast<uint32_t>(nature_.even));
  for (const LodPose* pose : {&view_.open, &view_.close}) {
    for (const V3f* v : {&pose->position, &pose->right, &pose->up, &pose->forward}) add(v->x, v->y, v->z);
    add(pose->focal_pixels);
  }
  add(view_.near_distance, view_.lens_diameter, view_.focus_distance);
  return hasher.digest();
}

}  // namespace pelage
