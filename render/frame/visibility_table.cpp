// SPDX-License-Identifier: Apache-2.0
#include "render/frame/visibility_table.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "lod/lod_view.h"

namespace pelage {
namespace {

// So that the cells of distant and near points have sides that floats can hold.
constexpr int kMinExponent = -60, kMaxExponent = 60;
/// Number of pilot rays as which the expected fraction counts.
constexpr float kPriorShots = 2;
constexpr size_t kStrata = LearnedVisibility::kStrata;
constexpr size_t kMaxBytes = size_t{32} << 20, kMinCells = 1024;

}  // namespace

uint64_t VisibilityTable::key(const V3f& position, bool on_strand) const {
  const float side = kPixels / pixels_per_unit(view_, position);
  const int exponent = std::clamp(std::ilogb(side), kMinExponent, kMaxExponent);
  uint64_t key = hash64(random_use("cell of visibility"), on_strand, static_cast<uint32_t>(exponent));
  for (int axis = 0; axis < 3; ++axis) {
    const double at = std::floor(std::ldexp(double{position[axis]}, -exponent));
    key = hash64(key, static_cast<uint64_t>(static_cast<int64_t>(std::clamp(at, -1e18, 1e18))));
  }
  return key;
}

void VisibilityTable::add(uint64_t cell, size_t light, uint32_t stratum, float through) {
  auto found = cells_.find(cell);
  if (found == cells_.end()) {
    if (cells_.size() >= max_cells(lights_)) return;
    found = cells_.emplace(cell, static_cast<uint32_t>(cells_.size())).first;
  }
  const uint32_t index = found->second;
  if (tallies_.size() < cells_.size() * row()) tallies_.resize(cells_.size() * row());
  Tally& tally = tallies_[index * row() + light * kStrata + stratum];
  tally.shots += 1;
  tally.arrived += through;
}

void VisibilityTable::freeze(LearnedUse use) {
  std::vector<Tally> of_light(lights_);
  for (size_t i = 0; i < tallies_.size(); ++i) {
    Tally& sum = of_light[i / kStrata % lights_];
    sum.shots += tallies_[i].shots;
    sum.arrived += tallies_[i].arrived;
  }
  const auto fraction = [](const Tally& tally, float expected) {
    return (tally.arrived + kPriorShots * expected) / (tally.shots + kPriorShots);
  };
  factors_.resize(tallies_.size());
  for (size_t first = 0; first < tallies_.size(); first += kStrata) {
    Tally of_cell;
    for (size_t i = 0; i < kStrata; ++i) {
      of_cell.shots += tallies_[first + i].shots;
      of_cell.arrived += tallies_[first + i].arrived;
    }
    const float expected = fraction(of_cell, fraction(of_light[first / kStrata % lights_], 0.5f));
    for (size_t i = first; i < first + kStrata; ++i) {
      const Tally& own = tallies_[i];
      float factor = kDefensive + (1 - kDefensive) * std::sqrt(fraction(own, expected));
      if (use == LearnedUse::kReject) factor = own.shots > 0 && !(own.arrived > 0) ? 0.0f : 1.0f;
      factors_[i] = static_cast<uint8_t>(std::lround(255 * std::min(factor, 1.0f)));
    }
  }
  std::vector<Tally>().swap(tallies_);
}

LearnedVisibility VisibilityTable::find(const V3f& position, bool on_strand) const {
  const auto cell = cells_.find(key(position, on_strand));
  if (cell == cells_.end()) return {};
  return {&factors_[cell->second * row()]};
}

size_t VisibilityTable::bytes_per_cell(size_t lights, bool learning) {
  constexpr size_t kEntry = 2 * sizeof(void*) + sizeof(std::pair<uint64_t, uint32_t>) + 16;  // of the map
  // A vector that doubles its size holds up to three times its contents meanwhile.
  return kEntry + lights * kStrata * (sizeof(uint8_t) + (learning ? 3 * sizeof(Tally) : 0));
}

size_t VisibilityTable::max_cells(size_t lights) {
  return std::max(kMinCells, kMaxBytes / bytes_per_cell(lights, true));
}

}  // namespace pelage
