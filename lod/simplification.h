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
  float area_share = 0;  ///< mean of width * length of a strand / area of the whole skin; 0 when unknown
  float density = 0;     ///< strands per unit of skin area; 0 when unknown
  bool even = true;      ///< whether the roots of the first n strands are blue noise, for every n
};

/// Data of a strand's root, which determine the level of detail of the strand. World space.
struct RootPlace {
  V3f open{0}, close{0};  ///< position when the shutter opens and closes
  V3f normal{0};          ///< unit normal of the skin when the shutter opens; 0: unknown
  V3f direction{0};  ///< mean direction of the strands near the root when the shutter opens: a unit vector,
                     ///< shorter if directions vary widely, 0 if unknown
};

/// The quantities from which the share of a root follows. Lengths are in pixels of a picture with
/// SimplificationParams::quality times the resolution.
struct LodMeasures {
  float width = 0, length = 0;  ///< of an average strand
  float motion = 0;             ///< while the shutter is open; 0 if it is not taken into account
  float across = 0;             ///< the part of `motion` across the strand
  float confusion = 0;          ///< diameter of the disc of confusion; 0 if it is not taken into account
  float facing = 1;             ///< cosine between the skin's normal and the direction to the camera
  float size_share = 1;         ///< lambda_size
  float blur_share = 1;         ///< lambda_blur
  float facing_share = 1;       ///< factor where the skin faces away from the camera
  float budget = 1;             ///< factor of the role of the coat
  float share = 1;              ///< share(): the product of these factors within its limits
};

/// Stochastic simplification of one coat [Cook07, Ryu07]. Determines which fraction of the strands suffices
/// for a root, and by which factor the kept strands are widened.
///
/// Every strand has a fixed priority x, uniformly distributed over [0, 1) and independent of everything else.
/// The fraction of strands that suffices is called the share, lambda. With t = fade_half_width(lambda),
/// strands with x < lambda - t are kept at full width. From there to x = lambda + t, the width decreases
/// linearly to 0. Strands with a larger x are omitted. Therefore the strands kept at one share are a subset
/// of the strands kept at every larger share. Shares and widths are continuous functions of the root's
/// position, so strands do not pop, and boundaries between chunks are invisible.
///
/// Copyable. Thread safety: const members may be called from any thread.
class Simplification {
 public:
  /// `budget`: factor on the share that the role of the coat selects, such as SimplificationParams::guard; 1
  /// for no change.
  Simplification(const SimplificationParams& params, const LodView& view, const CoatStats& stats,
                 float budget);

  const LodView& view() const { return view_; }
  /// Returns the mean number of strands that cover a point of the skin at full detail; 0 when unknown.
  float depth() const { return stats_.density * stats_.width * stats_.length; }

  /// Returns the share lambda in (0, 1] for strands with this root.
  ///
  /// lambda = lambda_size * lambda_blur * budget [Cook07, eq. 1], but at most 1.
  /// - lambda_size = w^(2 ln(1/2) / ln h), with h = 0.4, for strands of a width of w < 1 pixels [Cook07, eq.
  ///   2]. lambda_size = 1 for wider strands.
  /// - lambda_blur = b^-blur_strength, where b is the factor by which blur increases the number of strands
  ///   that contribute to a pixel. With blur_strength = 1, this number is the same as without blur.
  ///
  /// lambda has a minimum at which a widened strand is no wider than hypot(1, 0.1 * blur across it) pixels,
  /// and no wider than a quarter of its length. Without this minimum, widths would have no bound for small
  /// coats. Back-facing skin keeps fewer strands, down to a fifth of lambda; these strands may exceed the max
  /// width.
  float share(const RootPlace& root) const;
  /// Returns how share() arrives at its result.
  LodMeasures measures(const RootPlace& root) const;
  /// Returns an upper bound of share() for roots at this distance from the camera or at a larger one.
  float max_share(float distance) const;
  /// Returns t = min(0.1, lambda / 4, 1 - lambda), half the range of priorities in which strands fade. With
  /// this t, the mean of fade() over all priorities is lambda.
  static float fade_half_width(float share);
  /// Returns the factor on the width with which a strand of this priority fades: 1 up to lambda - t, 0 from
  /// lambda + t on, linear between.
  static float fade(float share, float priority);

  /// Returns the factor on the width of a strand: fade() * gain(), or 0 if the strand is omitted. Returns 1
  /// at share 1. The wider strands cover the same fraction of the skin as the full coat.
  ///
  /// For strands at random positions, the gain is (1 - (1 - r)^(1 / lambda)) / r [Cook07, eq. 6], where r is
  /// CoatStats::area_share. If roots are evenly spread (CoatStats::even), wide strands overlap less than thin
  /// strands, so the gain is smaller. All strands that cover a point of the skin have their roots in a strip
  /// as wide and as long as one strand. If this strip is narrower than the distance between roots, the
  /// strands are modelled as intervals on a line with a minimum distance between them. Let mu be the mean
  /// number of intervals that cover a point, and x the fraction of the line that the minimum distances take
  /// up. The point is uncovered with probability (1 - x) exp(-(mu - x) / (1 - x)). x increases with the width
  /// of the strands, so the same probability needs a smaller mu.
  float width_factor(float share, float priority) const;
  /// Returns the factor on the width of strands that do not fade; 1 at share 1.
  float gain(float share) const;
  /// Returns an upper bound of width_factor() for roots at this distance from the camera or at a smaller one.
  float max_width_factor(float distance) const;
  /// A kept strand represents omitted strands around it. Light that hits the kept strand continues from one
  /// of the represented strands, at the same position along the strand. Returns the max distance on the skin,
  /// in scene units, between the roots of these two strands; 0 at share 1.
  float spread(float share) const;
  /// Returns the probability that light from a represented strand is allowed to hit the kept strand that
  /// represents it; 0 at share 1. Around each of the evenly spread kept strands is free space, in which
  /// omitted strands would have blocked light. The fewer strands are kept, the larger this space is.
  float own_shadow(float share) const;
  /// Returns the factor on the difference between the colour of a strand and the mean colour; 1 at share 1
  /// [Cook07, eq. 22].
  float contrast(float share) const;
  /// Returns the max distance by which a refit with fewer control points may move a strand, in scene units.
  /// This is a tenth of a pixel of a picture with SimplificationParams::quality times the resolution. Returns
  /// 0 if no refit is allowed.
  float tolerance(const V3f& root_at_open) const;

  /// Returns a hash of everything that affects the results of all members.
  ContentHash hash() const;

 private:
  /// Lengths at a root in scene units.
  struct Blur {
    float motion = 0, across = 0, confusion = 0;
  };
  Blur blur(const RootPlace& root) const;
  float size_share(float width) const;
  float share(float pixels, float motion, float across, float confusion) const;
  /// Returns the minimum share: `share`, which the max width requires, or min_share if larger. A budget above
  /// 1 increases the minimum; a budget below 1 does not decrease it.
  float min_kept(float share) const;
  void tabulate_area();

  static constexpr size_t kAreaSteps = 32;
  SimplificationParams params_;
  LodView view_;
  CoatStats stats_;
  float budget_;
  std::array<float, kAreaSteps + 1>
      area_;  // factor by which even spacing reduces gain(); index: sqrt(share) * kAreaSteps
};

}  // namespace pelage
