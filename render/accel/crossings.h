// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
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
  float through = 1;  ///< fraction of light that meets no strand
};

/// Collects the reports of crossings of one ray, in any order: of those with semi-transparent strands, or, to
/// count strands, of all.
class Crossings {
 public:
  /// Counts opaque strands too, up to `max_counted` of them. 0: an opaque strand ends the ray.
  explicit Crossings(uint32_t max_counted = 0) : max_counted_(max_counted) {}

  /// Whether opaque strands are counted.
  bool counts() const { return max_counted_ > 0; }
  /// Adds a crossing that is counted. Returns false when there are more opaque ones than the maximum.
  bool count(const CrossingPlace& place, float opacity) {
    const bool seen =
        std::any_of(few_.begin(), few_.begin() + static_cast<ptrdiff_t>(count_),
                    [&](const Report& report) { return report.place == place; }) ||
        std::any_of(many_.begin(), many_.end(), [&](const Report& report) { return report.place == place; });
    if (opacity >= 1 && !seen) ++opaque_;
    add(place, opacity);
    return opaque_ <= max_counted_;
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
  float transmittance() { return total().through; }
  /// Returns the sum of the opacities of the crossings and the product of 1 - opacity, by the same rules.
  StrandCount total() {
    if (many_.empty()) return total(std::span(few_).first(count_));
    many_.insert(many_.end(), few_.begin(), few_.begin() + static_cast<ptrdiff_t>(count_));
    return total(many_);
  }

 private:
  struct Report {
    CrossingPlace place;
    float opacity = 0;
    friend auto operator<=>(const Report&, const Report&) = default;
  };

  static StrandCount total(std::span<Report> reports) {
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

  uint32_t max_counted_;
  uint32_t opaque_ = 0;  // crossings of opaque strands
  std::array<Report, 24> few_;
  size_t count_ = 0;
  std::vector<Report> many_;
};

}  // namespace pelage
