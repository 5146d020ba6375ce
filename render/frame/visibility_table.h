// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "base/ledger.h"
#include "lod/lod_view.h"
#include "render/light/learned_visibility.h"
#include "render/scene/render_params.h"

namespace pelage {

/// The fraction of light that pilot rays found to arrive, by cell of space, light and stratum, and the
/// factors that shadow rays use.
///
/// A cell is a cube whose side is a power of two, about kPixels pixels long in the picture, with the strands
/// in it or with the skin in it. First, add() the pilot rays; then, freeze() computes the factors once; from
/// then on, find() returns them. So a shadow ray never depends on another shadow ray of the picture. The
/// result depends on the order of add(). A table has at most max_cells() cells, and ignores
/// pilot rays in further cells.
///
/// Let v be the fraction of a stratum's pilot rays that arrived. With few rays, v is pulled towards the
/// fraction of its cell and light, and this one towards the fraction of the light. The factor is
/// kDefensive + (1 - kDefensive) sqrt(v): a ray with the probability v of arriving has a standard deviation
/// proportional to sqrt(v), and a factor above 0 keeps the estimate unbiased. With
/// `reject`, the factor is 0 if no pilot ray of the stratum arrived, and 1 otherwise ["Rendering Fur in Life
/// of Pi", adaptive importance sampling]. This is biased: light that all pilot rays have missed is lost.
///
/// Thread safety: find() may be called from any thread, after freeze().
class VisibilityTable {
 public:
  static constexpr float kPixels = 16, kDefensive = 0.15f;

  VisibilityTable(const LodView& view, size_t lights) : view_(view), lights_(lights) {}

  /// Returns the key of the cell of a point.
  uint64_t key(const V3f& position, bool on_strand) const;
  /// Adds a pilot ray. `through`: the fraction of light that arrived, in [0, 1].
  void add(uint64_t cell, size_t light, uint32_t stratum, float through);
  /// Computes the factors and forgets the rays.
  void freeze(LearnedUse use);
  /// Returns the factors at a point.
  LearnedVisibility find(const V3f& position, bool on_strand) const;

  /// Charges the memory of the table to a ledger until the table is destroyed. Call after freeze().
  void charge(MemoryLedger& ledger) {
    charge_ = MemoryCharge(ledger, MemoryTag::kReflectionCache, static_cast<int64_t>(bytes()));
  }
  size_t cells() const { return cells_.size(); }
  size_t bytes() const { return cells_.size() * bytes_per_cell(lights_, false); }
  /// Returns the max memory of a cell, in bytes. `learning`: before freeze().
  static size_t bytes_per_cell(size_t lights, bool learning);
  /// Returns how many cells fit in 32 MiB before freeze(), but at least 1024.
  static size_t max_cells(size_t lights);

 private:
  struct Tally {
    float shots = 0, arrived = 0;
  };
  size_t row() const { return lights_ * LearnedVisibility::kStrata; }

  LodView view_;
  size_t lights_;
  std::unordered_map<uint64_t, uint32_t> cells_;  // index of a cell, by its key
  std::vector<Tally> tallies_;                    // by cell, light and stratum
  std::vector<uint8_t> factors_;                  // the same
  MemoryCharge charge_;
};

}  // namespace pelage
