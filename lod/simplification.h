// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "base/hash.h"
#include "lod/lod_view.h"
#include "lod/simplification_params.h"

namespace pelage {

/// Average properties of the strands of a coat, in scene units of the posed coat.
struct CoatStats {
  float width = 0;
  float length = 0;
  float area_share = 0;  ///< mean width * length of a strand / area of the whole skin; 0 when unknown
  float density = 0;     ///< strands per unit of skin area; 0 when unknown
  bool even = true;      ///< whether every prefix of their order is blue noise
};

/// The root of a strand, which determines its level of detail. World space.
struct RootPlace {
  V3f open{0}, close{0};  ///< position when the shutter opens and closes
  V3f normal{0};          ///< unit normal of the skin when the shutter opens; 0: unknown
  V3f direction{0};       ///< mean direction of the strands at the root when the shutter opens: unit, shorter
                          ///< where directions vary
};

/// Stochastic simplification of one coat: determines the fraction of the strands that suffices at a place,
/// and the width of the kept strands [Cook07, Ryu07].
///
/// Every strand has a fixed priority x, uniformly distributed over [0, 1) and independent of everything else.
/// Where the fraction (share) lambda suffices, strands with x < lambda - t are kept, strands with x up to
/// lambda + t fade out by width, and all other strands do not exist. The strands kept at one share are
/// therefore a subset of the strands kept at every larger share. Everything is a continuous function of the
/// root's position, so nothing pops and no boundary between chunks is visible.
///
/// A value. Thread safety: const members may be called from any thread.
class Simplification {
 public:
  /// `budget`: factor on the share, from the role of the coat.
  Simplification(const SimplificationParams& params, const LodView& view, const CoatStats& stats,
                 float budget);

  const LodView& view() const { return view_; }
  /// Mean number of strands over a point of the skin; 0 when unknown.
  float depth() const { return stats_.density * stats_.width * stats_.length; }

  /// The share lambda in (0, 1] of the strands with this root.
  ///
  /// lambda = lambda_size * lambda_blur [Cook07, eq. 1], but at least large enough that a widened strand
  /// stays below hypot(1, a tenth of the blur across it) pixels and a quarter of its own length: otherwise
  /// widths would grow without bound where a coat becomes small. lambda_size = w^(2 ln(1/2) / ln h) for a
  /// width of w < 1 pixels, h = 0.4 [Cook07, eq. 2]; lambda_blur is raised to the power blur_strength; with
  /// the exponent 1, blur does not change the number of strands that contribute to a pixel. Back-facing skin
  /// keeps fewer strands, down to a fifth, and these may be wider accordingly.
  float share(const RootPlace& root) const;
  /// Upper bound of share() for roots at this distance from the camera or farther away.
  float max_share(float distance) const;
  /// Half the width of the fade: min(0.1, lambda / 4, 1 - lambda), so that the mean of fade() over all x is
  /// lambda.
  static float fade_half_width(float share);
  /// 1 before the fade, 0 after it.
  static float fade(float share, float priority);

  /// Factor on the width of a strand; 0: it does not exist. 1 at share 1. Preserves the fraction of the skin
  /// that a coat covers.
  ///
  /// For strands at random positions the factor is (1 - (1 - r)^(1 / lambda)) / r [Cook07, eq. 6], with r the
  /// area_share. When positions are evenly spread, wide strands overlap less than thin ones. The strands over
  /// a point of the skin have their roots in a strip of one strand's width and length. For strips narrower
  /// than the distance between roots, the strands are modelled as intervals on a line, with a minimum
  /// distance between them. Let mu be their mean number over a point, and x the fraction of the line that the
  /// minimum distances take up: the point is uncovered with probability (1 - x) exp(-(mu - x) / (1 - x)). As
  /// x grows with the width, mu must shrink.
  float width_factor(float share, float priority) const;
  /// The same for strands that do not fade.
  float gain(float share) const;
  /// Upper bound of width_factor() for roots up to this distance.
  float max_width_factor(float distance) const;
  /// A kept strand represents strands around it. Light continues from one of the represented strands: at the
  /// same position along its length, with a root up to this distance away on the skin. 0 at share 1.
  float spread(float share) const;
  /// Probability that light leaving a represented strand may hit the strand that represents it. Evenly spread
  /// strands have free space around them, in which the omitted strands would have blocked light. The fewer
  /// strands are kept, the larger this space is. 0 at share 1.
  float own_shadow(float share) const;
  /// Factor on the deviation of a strand's colour from the mean [Cook07, eq. 22].
  float contrast(float share) const;
  /// Max distance by which a refit with fewer control points may move a strand, in scene units; 0: no refit
  /// is allowed.
  float tolerance(const V3f& root_at_open) const;

  /// Hash of everything that affects the result.
  ContentHash hash() const;

 private:
  float share(float pixels, float motion, float across, float confusion) const;
  /// The minimum share that widths or the scene require. A budget may increase this share, but never decrease
  /// it.
  float min_kept(float share) const;
  void tabulate_area();

  static constexpr size_t kAreaSteps = 32;
  SimplificationParams params_;
  LodView view_;
  CoatStats stats_;
  float budget_;
  std::array<float, kAreaSteps + 1>
      area_;  // fraction of the strands' area that remains, by the square root of the share
};

}  // namespace pelage
