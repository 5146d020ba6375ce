// SPDX-License-Identifier: Apache-2.0
#include "groom/follicles/octave_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/hash.h"
#include "base/release.h"

namespace pelage {
namespace {

/// For a candidate nearer than this to a follicle, in radii, the exact distance does not matter: it waits for
/// many levels anyway.
constexpr float kNearEnough = 0.6f;

int32_t cell_of(float coordinate) {
  return static_cast<int32_t>(std::floor(std::clamp(coordinate, -1e9f, 1e9f)));
}

}  // namespace

void OctaveGrid::rebuild(size_t expected, float radius) {
  cell_ = 2.0f * radius * smallest_;
  release(heads_);  // frees the old ones before making new ones
  heads_.assign(head_count(expected), kNone);
  for (uint32_t i = 0; i < items_.size(); ++i) link(i);
}

void OctaveGrid::insert(const FollicleCandidate& follicle) {
  items_.push_back({follicle.x, follicle.y, follicle.z, follicle.normal, follicle.spacing, kNone});
  link(static_cast<uint32_t>(items_.size() - 1));
}

void OctaveGrid::link(uint32_t index) {
  Item& item = items_[index];
  const int octave = octave_of(item.spacing);
  octaves_ |= 1u << octave;
  const float inverse = inverse_cell(octave);
  const int32_t x = cell_of(item.x * inverse);
  uint32_t& head = heads_[row(x, cell_of(item.y * inverse), cell_of(item.z * inverse), octave) +
                          static_cast<size_t>(x & 15)];
  item.next = head;
  head = index;
}

float OctaveGrid::nearest(const FollicleCandidate& candidate, float radius, uint32_t skipped) const {
  float best = radius;
  const V3f normal = unpack_normal(candidate.normal);
  for (unsigned left = octaves_; left != 0; left &= left - 1) {
    const int octave = std::countr_zero(left);
    const float inverse = inverse_cell(octave);
    // Everything in this octave has less than its upper spacing.
    const float reach =
        radius * std::min(candidate.spacing, smallest_ * static_cast<float>(uint64_t(2) << octave));
    const int32_t x0 = cell_of((candidate.x - reach) * inverse),
                  x1 = cell_of((candidate.x + reach) * inverse);
    const int32_t y0 = cell_of((candidate.y - reach) * inverse),
                  y1 = cell_of((candidate.y + reach) * inverse);
    const int32_t z0 = cell_of((candidate.z - reach) * inverse),
                  z1 = cell_of((candidate.z + reach) * inverse);
    for (int32_t z = z0; z <= z1; ++z) {
      for (int32_t y = y0; y <= y1; ++y) {
        size_t heads = row(x0, y, z, octave);
        for (int32_t x = x0; x <= x1; ++x) {
          if (x != x0 && (x & 15) == 0) heads = row(x, y, z, octave);
          best = nearest_in(heads_[heads + static_cast<size_t>(x & 15)], skipped, candidate, normal, best);
          if (best < kNearEnough * radius) return best;
        }
      }
    }
  }
  return best;
}

float OctaveGrid::nearest_in(uint32_t item, uint32_t skipped, const FollicleCandidate& candidate,
                             const V3f& normal, float best) const {
  for (; item != kNone && item >= skipped; item = items_[item].next) {
    const Item& other = items_[item];
    const float dx = candidate.x - other.x, dy = candidate.y - other.y, dz = candidate.z - other.z;
    const float spacing = std::min(candidate.spacing, other.spacing);
    const float limit = best * spacing;
    const float distance2 = dx * dx + dy * dy + dz * dz;
    if (distance2 >= limit * limit || unpack_normal(other.normal).dot(normal) < 0.5f) continue;
    best = std::sqrt(distance2) / spacing;
  }
  return best;
}

int OctaveGrid::octave_of(float spacing) const { return std::clamp(std::ilogb(spacing / smallest_), 0, 30); }

size_t OctaveGrid::row(int32_t x, int32_t y, int32_t z, int octave) const {
  const uint64_t key = static_cast<uint64_t>(static_cast<uint32_t>(x >> 4)) * 0x9e3779b97f4a7c15ull ^
                       static_cast<uint64_t>(static_cast<uint32_t>(y)) * 0xc2b2ae3d27d4eb4full ^
                       static_cast<uint64_t>(static_cast<uint32_t>(z)) * 0x165667b19e3779f9ull ^
                       static_cast<uint64_t>(octave) << 60;
  return (mix64(key) & (heads_.size() / 16 - 1)) * 16;
}

}  // namespace pelage
