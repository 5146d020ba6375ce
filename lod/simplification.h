// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "base/hash.h"
#include "lod/lod_view.h"
#include "lod/simplification_params.h"

namespace pelage {

/// What the strands of a coat are like on average. Scene units of the coat where it stands.
struct CoatStats {
  float width = 0;
  float length = 0;
  float area_share = 0;  ///< width * length over the area of the skin that they cover; 0 when not known
  float density = 0;     ///< strands per unit of skin, where they stand; 0 when not known
  bool even = true;      ///< whether every prefix of their order is blue noise
};

/// Where a strand has its root, by which detail is decided. World space.
struct RootPlace {
  V3f open{0}, close{0};  ///< when the shutter opens and closes
  V3f normal{0};          ///< of the skin when the shutter opens; 0: not known
  V3f direction{0};       ///< how strands lie there then: unit, shorter where they lie anyhow
};

/// Stochastic simplification of one coat: how many strands are enough at a place, and how wide those must be
/// that stay [Cook07, Ryu07].
///
/// Every strand has a fixed priority x, evenly spread over [0, 1) and independent of everything else. At a
/// place where the share lambda of the strands is enough, those with x < lambda - t keep their place, those
/// up to lambda + t fade out by width, and the others do not exist: what stays at one share is among what
/// stays at every larger one. All is a continuous function of the root's place, so nothing pops and nothing
/// shows where one chunk ends and the next begins.
///
/// A value. Thread safety: const members may be called from any thread.
class Simplification {
 public:
  /// `budget`: factor on the share, of the role of the coat.
  Simplification(const SimplificationParams& params, const LodView& view, const CoatStats& stats,
                 float budget);

  const LodView& view() const { return view_; }
  /// Strands over a point of the skin, on average; 0 when not known.
  float depth() const { return stats_.density * stats_.width * stats_.length; }

  /// The share lambda in (0, 1] of the strands with their root here.
  ///
  /// lambda = lambda_size * lambda_blur [Cook07, eq. 1], but no less than what keeps a widened strand under
  /// hypot(1, a tenth of the blur across it) pixels, and under a quarter of its own
  /// length: else widths would grow without bound where a coat shrinks. lambda_size = w^(2 ln(1/2) / ln h)
  /// for a width of w < 1 pixels, h = 0.4 [Cook07, eq. 2]; lambda_blur keeps the number of strands that
  /// contribute to a pixel (to the power blur_strength). Where the skin is turned away, less, down to a fifth
  /// of that; there strands may be as much wider.
  float share(const RootPlace& root) const;
  /// No root at this distance from the camera, or further away, has a larger share.
  float max_share(float distance) const;
  /// Half the width of the fade: min(0.1, lambda / 4, 1 - lambda), so that the mean of fade() over all x is
  /// lambda.
  static float fade_half_width(float share);
  /// 1 before the fade, 0 behind it.
  static float fade(float share, float priority);

  /// What the width of a strand is multiplied by; 0: it does not exist. 1 at share 1. The part of the skin
  /// that a coat covers stays.
  ///
  /// For strands anywhere that is (1 - (1 - r)^(1 / lambda)) / r [Cook07, eq. 6], r the area_share. Where
  /// they stand evenly, wide ones overlap less than thin ones. What stands over a point of the skin are roots
  /// in a strip of one strand's width and length, and for strips narrower than the distance between roots
  /// these are intervals on a line that keep some distance: with mu of them on average and a part x of the
  /// line taken up by the distances, none is there with probability (1 - x) exp(-(mu - x) / (1 - x)). As x
  /// grows with the width, mu must shrink.
  float width_factor(float share, float priority) const;
  /// The same of strands that do not fade.
  float gain(float share) const;
  /// No width_factor() of roots up to this distance is larger.
  float max_width_factor(float distance) const;
  /// A strand that is kept stands for others beside it. Light leaves one of them: it is as far along its
  /// length, and its root is up to this distance away on the skin. 0 at share 1.
  float spread(float share) const;
  /// With which probability the strand itself counts among what light meets that leaves one of those that it
  /// stands for. Strands that stand evenly have room around them, the more the fewer there are; that light
  /// does not cross it unhindered is due to the others that are not there. 0 at share 1.
  float own_shadow(float share) const;
  /// What the deviation of a strand's colour from the mean is multiplied by [Cook07, eq. 22].
  float contrast(float share) const;
  /// How far fewer control points may move a strand, in scene units; 0: not at all.
  float tolerance(const V3f& root_at_open) const;

  /// Of all that decides.
  ContentHash hash() const;

 private:
  float share(float pixels, float motion, float across, float confusion) const;
  /// A share that widths or the scene ask for at least: more where a budget gives more, never less.
  float min_kept(float share) const;
  void tabulate_area();

  static constexpr size_t kAreaSteps = 32;
  SimplificationParams params_;
  LodView view_;
  CoatStats stats_;
  float budget_;
  std::array<float, kAreaSteps + 1> area_;  // that is left of the strands' area, by the root of the share
};

}  // namespace pelage
