// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/hash.h"

namespace pelage {

/// Identifies a crossing of a ray and a strand by the strand and a joint, which is an end of one or two
/// segments. The ray crosses one of the half segments beside this joint. An accelerator may report the same
/// crossing several times: for each of two segments that overlap at their joint, or both where the ray enters
/// a round strand and where it leaves. All reports with the same CrossingPlace are one crossing.
struct CrossingPlace {
  uint64_t strand_id = 0;
  uint32_t part = 0;
  uint32_t joint = 0;

  friend auto operator<=>(const CrossingPlace&, const CrossingPlace&) = default;
};

/// Whether a ray with the random number `random` stops at a crossing. The answer is the same for all reports
/// of a crossing that have the same opacity.
inline bool stops_at(uint32_t random, const CrossingPlace& place, float opacity) {
  return unit_float(hash64(random, place.strand_id, place.part, place.joint, random_use("opacity"))) <
         opacity;
}

/// The strands between the two ends of a ray.
struct StrandCount {
  /// Sum of the opacities of the crossings; infinity where a skin or too many strands lie between.
  float strands = 0;
  float through = 1;  ///< fraction of light that meets no strand; 0 where `strands` is infinite
};

/// Collects the reports of crossings of one ray, in any order: of those with semi-transparent strands, or, to
/// count strands, of all.
class Crossings {
 public:
  /// Counts opaque strands too, until the sum of the opacities exceeds `max_counted` and hardly any light
  /// gets through. 0: an opaque strand ends the ray.
  explicit Crossings(uint32_t max_counted = 0) : max_counted_(static_cast<float>(max_counted)) {}

  /// Whether opaque strands are counted.
  bool counts() const { return max_counted_ > 0; }
  /// Adds a crossing that is counted. Returns false only when total() is infinite, whatever is added later.
  bool count(const CrossingPlace& place, float opacity) {
    add(place, opacity);
    reported_ += opacity;
    if (!(reported_ > max_counted_) || reports() < next_check_) return true;
    const StrandCount so_far = sorted_total();
    reported_ = so_far.strands;
    // Most of these reports are repeated ones, or thin strands: waiting for some more keeps the cost of all
    // checks that of a sort.
    next_check_ = reports() + 1 + reports() / 8;
    return !is_too_many(so_far);
  }

  void add(const CrossingPlace& place, float opacity) {
    if (count_ < few_.size()) {
      few_[count_++] = {place, opacity};
    } else {
      many_.push_back({place, opacity});
    }
  }

  size_t reports() const { return count_ + many_.size(); }
  /// Returns the product of 1 - opacity over the crossings. A crossing with several reports counts once, with
  /// the max opacity of its reports. Factors are multiplied in ascending order of CrossingPlace, so the order
  /// of add() calls does not matter.
  float transmittance() { return sorted_total().through; }
  /// Returns the sum of the opacities of the crossings and the product of 1 - opacity, by the same rules. If
  /// crossings are counted and there are too many, the sum is infinite.
  StrandCount total() {
    const StrandCount all = sorted_total();
    return counts() && is_too_many(all) ? StrandCount{std::numeric_limits<float>::infinity(), 0} : all;
  }

 private:
  struct Report {
    CrossingPlace place;
    float opacity = 0;
    friend auto operator<=>(const Report&, const Report&) = default;
  };

  /// More reports never turn this to false: sums and products in ascending order of the places are monotonic
  /// also when rounded. So the ray may end at once, and the order of reports does not matter.
  bool is_too_many(const StrandCount& all) const {
    return all.strands > max_counted_ && all.through < kLittleLight;
  }

  /// Sorts the reports.
  StrandCount sorted_total() {
    if (many_.empty()) return total_of(std::span(few_).first(count_));
    many_.insert(many_.end(), few_.begin(), few_.begin() + static_cast<ptrdiff_t>(count_));
    count_ = 0;
    return total_of(many_);
  }

  static StrandCount total_of(std::span<Report> reports) {
    std::sort(reports.begin(), reports.end());
    StrandCount result;
    for (size_t i = 0; i < reports.size(); ++i) {
      const bool last_report = i + 1 == reports.size() || reports[i + 1].place != reports[i].place;
      if (!last_report) continue;
      result.strands += reports[i].opacity;
      result.through *= 1 - reports[i].opacity;
    }
    return result;
  }

  static constexpr float kLittleLight = 0.03f;  // fraction of light that is as good as none

  float max_counted_;
  float reported_ = 0;     // the sum of opacities, which counts repeated reports since the last check twice
  size_t next_check_ = 0;  // the number of reports from which on the sum is checked again
  std::array<Report, 24> few_;
  size_t count_ = 0;
  std::vector<Report> many_;
};

}  // namespace pelage
