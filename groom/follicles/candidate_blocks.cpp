// SPDX-License-Identifier: Apache-2.0
#include "groom/follicles/candidate_blocks.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pelage {

void NearFollicles::add(const PlacedFollicle& follicle) {
  const size_t lane = size_ % 4;
  Group& group = groups_[size_ / 4];
  const V3f normal = unpack_normal(follicle.normal);
  group.at.x[lane] = follicle.x, group.at.y[lane] = follicle.y, group.at.z[lane] = follicle.z;
  group.normal.x[lane] = normal.x, group.normal.y[lane] = normal.y, group.normal.z[lane] = normal.z;
  group.spacing[lane] = follicle.spacing;
  ++size_;
}

void NearFollicles::finish() {
  // No candidate is nearer than 0 to a follicle without spacing.
  for (size_t lane = size_; lane % 4 != 0; ++lane) groups_[size_ / 4].spacing[lane % 4] = 0;
}

float NearFollicles::nearest(const FollicleCandidate& candidate, float radius) const {
  const V3f up = unpack_normal(candidate.normal);
  const FourVectors at{four(candidate.x), four(candidate.y), four(candidate.z)};
  const FourVectors normal{four(up.x), four(up.y), four(up.z)};
  float best = radius;
  for (size_t g = 0; g < (size_ + 3) / 4; ++g) {
    const Group& group = groups_[g];
    const FourVectors d = at - group.at;
    const Four distance2 = d.dot(d), spacing = smaller(four(candidate.spacing), group.spacing);
    const Four limit = four(best) * spacing;
    const FourTruths closer = (distance2 < limit * limit) & (group.normal.dot(normal) >= four(0.5f));
    if (lane_bits(closer) == 0) continue;
    for (int lane = 0; lane < 4; ++lane) {
      if (closer[lane]) best = std::min(best, std::sqrt(distance2[lane]) / spacing[lane]);
    }
  }
  return best;
}

CandidateBlocks::Group CandidateBlocks::empty_group() {
  Group group{};
  for (size_t axis = 0; axis < 3; ++axis) {
    group.low[axis].fill(std::numeric_limits<float>::infinity());
    group.high[axis].fill(-std::numeric_limits<float>::infinity());
  }
  return group;
}

void CandidateBlocks::extend(Group& group, size_t lane, const FollicleCandidate& candidate) {
  const float at[] = {candidate.x, candidate.y, candidate.z};
  for (size_t axis = 0; axis < 3; ++axis) {
    group.low[axis][lane] = std::min(group.low[axis][lane], at[axis]);
    group.high[axis][lane] = std::max(group.high[axis][lane], at[axis]);
  }
  group.spacing[lane] = std::max(group.spacing[lane], candidate.spacing);
}

CandidateBlocks::CandidateBlocks(std::span<const FollicleCandidate> candidates, size_t max_follicles,
                                 size_t max_listed)
    : lists_((candidates.size() + kBlock - 1) / kBlock), max_listed_(max_listed) {
  follicles_.reserve(max_follicles);
  levels_.emplace_back((lists_.size() + kFan - 1) / kFan, empty_group());
  for (size_t i = 0; i < candidates.size(); ++i) {
    extend(levels_[0][i / kBlock / kFan], i / kBlock % kFan, candidates[i]);
  }
  while (levels_.back().size() > 1) {
    std::vector<Group> above((levels_.back().size() + kFan - 1) / kFan, empty_group());
    for (size_t below = 0; below < levels_.back().size(); ++below) {
      const Group& group = levels_.back()[below];
      Group& to = above[below / kFan];
      const size_t lane = below % kFan;
      for (size_t axis = 0; axis < 3; ++axis) {
        to.low[axis][lane] = *std::min_element(group.low[axis].begin(), group.low[axis].end());
        to.high[axis][lane] = *std::max_element(group.high[axis].begin(), group.high[axis].end());
      }
      to.spacing[lane] = *std::max_element(group.spacing.begin(), group.spacing.end());
    }
    levels_.push_back(std::move(above));
  }
}

size_t CandidateBlocks::tree_bytes(size_t candidates) {
  const size_t blocks = candidates / kBlock + 1;
  // Each level has an eighth of the groups of the level below it.
  return blocks * sizeof(std::vector<uint32_t>) + (blocks / (kFan - 1) + 16) * sizeof(Group);
}

bool CandidateBlocks::add(const FollicleCandidate& candidate, float radius) {
  const uint32_t index = follicle_count();
  follicles_.push_back({candidate.x, candidate.y, candidate.z, candidate.normal, candidate.spacing});
  return lists_.empty() || visit(levels_.size() - 1, 0, follicles_.back(), index, radius);
}

bool CandidateBlocks::visit(size_t level, size_t index, const PlacedFollicle& follicle, uint32_t number,
                            float radius) {
  const Group& group = levels_[level][index];
  std::array<float, kFan> is_near;  // all at once, so that the compiler compares several lanes at a time
  for (size_t i = 0; i < kFan; ++i) is_near[i] = group.meets(i, follicle, radius) ? 1.0f : 0.0f;
  for (size_t i = 0; i < kFan; ++i) {
    if (is_near[i] == 0) continue;
    const size_t below = index * kFan + i;
    if (!(level == 0 ? list(below, number, radius) : visit(level - 1, below, follicle, number, radius)))
      return false;
  }
  return true;
}

bool CandidateBlocks::list(size_t block, uint32_t follicle, float radius) {
  std::vector<uint32_t>& list = lists_[block];
  if (list.size() == list.capacity()) {
    std::erase_if(list, [&](uint32_t f) { return !is_near(block, follicles_[f], radius); });
    if (list.size() > list.capacity() / 2 || list.capacity() == 0) {
      const size_t more = std::max<size_t>(list.capacity() / 2, 16);
      listed_ += more;
      if (listed_ > max_listed_) return false;
      list.reserve(list.capacity() + more);
    }
  }
  list.push_back(follicle);
  return true;
}

bool CandidateBlocks::is_near(size_t block, const PlacedFollicle& follicle, float radius) const {
  return levels_[0][block / kFan].meets(block % kFan, follicle, radius);
}

void CandidateBlocks::gather(size_t block, float radius, NearFollicles& out) {
  std::vector<uint32_t>& list = lists_[block];
  out.clear(list.size());
  size_t kept = 0;
  for (uint32_t f : list) {
    const PlacedFollicle& follicle = follicles_[f];
    if (!is_near(block, follicle, radius)) continue;
    out.add(follicle);
    list[kept++] = f;
  }
  list.resize(kept);
  out.finish();
}

void CandidateBlocks::gather_all(size_t block, NearFollicles& out) const {
  const std::vector<uint32_t>& list = lists_[block];
  out.clear(list.size());
  for (uint32_t f : list) out.add(follicles_[f]);
  out.finish();
}

float CandidateBlocks::nearest_of_latest(size_t block, const FollicleCandidate& candidate, float radius,
                                         uint32_t first) const {
  const V3f normal = unpack_normal(candidate.normal);
  float best = radius;
  const std::vector<uint32_t>& list = lists_[block];
  for (size_t i = list.size(); i-- > 0 && list[i] >= first;) {
    const PlacedFollicle& other = follicles_[list[i]];
    const float dx = candidate.x - other.x, dy = candidate.y - other.y, dz = candidate.z - other.z;
    const float spacing = std::min(candidate.spacing, other.spacing);
    const float limit = best * spacing, distance2 = dx * dx + dy * dy + dz * dz;
    if (distance2 >= limit * limit || unpack_normal(other.normal).dot(normal) < 0.5f) continue;
    best = std::min(best, std::sqrt(distance2) / spacing);
  }
  return best;
}

}  // namespace pelage
