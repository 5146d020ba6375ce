// SPDX-License-Identifier: Apache-2.0
#include "render/raster/tile_hits.h"

#include <algorithm>
#include <tuple>

#include "base/hash.h"

namespace pelage {

void TileHits::start(size_t samples) {
  places_.assign(samples, Place());
  groups_.clear();
  groups_.reserve(samples);
  table_.assign(table_size(samples), kNone);
}

/// Adds a sample to the group of its segment.
void TileHits::add(const TileWinner& winner, size_t slot) {
  const size_t mask = table_.size() - 1;
  size_t at = mix64(uint64_t{winner.chunk} << 32 | winner.primitive) & mask;
  for (;; at = (at + 1) & mask) {
    uint32_t& number = table_[at];
    if (number == kNone) {
      number = static_cast<uint32_t>(groups_.size());
      groups_.push_back({winner.chunk, winner.primitive, number, 0, {}});
    }
    Group& group = groups_[number];
    if (group.chunk != winner.chunk || group.segment != winner.primitive) continue;
    ++group.count;
    places_[slot].group = number;
    return;
  }
}

/// Sorts the groups, and lists the samples of each.
void TileHits::sort() {
  std::sort(groups_.begin(), groups_.end(), [](const Group& a, const Group& b) {
    return std::tie(a.chunk, a.segment) < std::tie(b.chunk, b.segment);
  });
  ranks_.resize(groups_.size());
  uint32_t total = 0;
  for (size_t rank = 0; rank < groups_.size(); ++rank) {
    Group& group = groups_[rank];
    ranks_[group.first] = static_cast<uint32_t>(rank);
    group.first = total;
    total += group.count;
    group.count = 0;
  }
  members_.resize(total);
  for (size_t slot = 0; slot < places_.size(); ++slot) {
    if (places_[slot].group == kNone) continue;
    Group& group = groups_[ranks_[places_[slot].group]];
    members_[group.first + group.count++] = static_cast<uint32_t>(slot);
    places_[slot].group = kNone;
  }
}

std::span<TileHits::Group> TileHits::chunk(size_t first) {
  size_t end = first;
  while (end < groups_.size() && groups_[end].chunk == groups_[first].chunk) ++end;
  return {groups_.data() + first, end - first};
}

void TileHits::find(const ChunkGeometry& geometry, Group& group, std::span<const CameraSample> samples) {
  const Ray* rays[ChunkGeometry::kMaxRays];
  Hit hits[ChunkGeometry::kMaxRays];
  for (size_t first = 0; first < group.count; first += ChunkGeometry::kMaxRays) {
    const size_t count = std::min<size_t>(group.count - first, ChunkGeometry::kMaxRays);
    const uint32_t* members = &members_[group.first + first];
    for (size_t i = 0; i < count; ++i) rays[i] = &samples[members[i]].ray;
    geometry.closest_at({rays, count}, group.segment, hits);
    for (size_t i = 0; i < count; ++i) {
      if (!hits[i]) continue;
      group.hit = hits[i];
      const auto number = static_cast<uint32_t>(&group - groups_.data());
      places_[members[i]] = {number, hits[i].distance, hits[i].u, hits[i].v};
    }
  }
}

Hit TileHits::hit(size_t slot) const {
  const Place& place = places_[slot];
  if (place.group == kNone) return {};
  Hit hit = groups_[place.group].hit;
  hit.distance = place.distance;
  hit.u = place.u;
  hit.v = place.v;
  hit.start.place = static_cast<float>(hit.segment) + place.u;
  return hit;
}

}  // namespace pelage
