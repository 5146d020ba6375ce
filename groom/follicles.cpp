// SPDX-License-Identifier: Apache-2.0
#include "groom/follicles.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "base/check.h"
#include "base/error.h"
#include "groom/follicle_candidates.h"
#include "groom/progressive_order.h"

namespace pelage {
namespace {

/// Splits ids[begin, end) into parts of at most `leaf` by halving along the longest axis of their box: parts
/// are compact, nearly equal in size, and a function of the positions alone.
void split(std::span<const V3f> positions, std::vector<uint32_t>& ids, uint32_t begin, uint32_t end,
           uint32_t leaf, std::vector<FollicleTree::Leaf>& leaves) {
  Box3f box;
  for (uint32_t i = begin; i < end; ++i) box.extendBy(positions[ids[i]]);
  const uint32_t count = end - begin;
  if (count <= leaf) {
    std::sort(ids.begin() + begin, ids.begin() + end);
    leaves.push_back({begin, end, box});
    return;
  }
  const uint32_t parts = (count + leaf - 1) / leaf;
  const auto left = static_cast<uint32_t>(static_cast<uint64_t>(count) * (parts / 2) / parts);
  const auto axis = static_cast<int>(box.majorAxis());
  std::nth_element(ids.begin() + begin, ids.begin() + begin + left, ids.begin() + end,
                   [&](uint32_t a, uint32_t b) {
                     const float pa = positions[a][axis], pb = positions[b][axis];
                     return pa != pb ? pa < pb : a < b;
                   });
  split(positions, ids, begin, begin + left, leaf, leaves);
  split(positions, ids, begin + left, end, leaf, leaves);
}

}  // namespace

FollicleTree FollicleTree::over(std::span<const V3f> rest_positions, std::span<const RootAddress> roots,
                                std::span<const uint32_t> ids, int leaf_strands,
                                std::vector<uint32_t>& order) {
  PELAGE_CHECK(leaf_strands > 0 && rest_positions.size() == roots.size() && ids.size() == roots.size());
  FollicleTree tree;
  order.resize(roots.size());
  std::iota(order.begin(), order.end(), 0u);
  if (roots.empty()) return tree;
  split(rest_positions, order, 0, static_cast<uint32_t>(roots.size()), static_cast<uint32_t>(leaf_strands),
        tree.leaves_);
  tree.leaves_.shrink_to_fit();
  tree.ids_.reserve(roots.size());
  tree.roots_.reserve(roots.size());
  for (uint32_t i : order) {
    tree.ids_.push_back(ids[i]);
    tree.roots_.push_back(roots[i]);
  }
  return tree;
}

FollicleTree FollicleTree::build(const LimitSurface& rest, const FollicleOptions& options,
                                 const Workers& workers) {
  const FollicleDensity density{options.density, options.coverage};
  const SurfaceMeasure measure = measure_surface(rest, density, workers);
  const double asked =
      options.count > 0 ? static_cast<double>(options.count) : std::round(options.per_area * measure.mass);
  if (!(asked <= static_cast<double>(kMaxFollicles))) {
    throw Error(ErrorKind::kInput,
                fmt::format("{:.3g} strands on one skin; at most {} are possible", asked, kMaxFollicles));
  }
  const auto count = static_cast<size_t>(asked);
  if (count == 0 || !(measure.mass > 0)) return {};

  // How many candidates pass is random: ask again with more in the rare case that they are too few.
  std::vector<FollicleCandidate> candidates;
  for (size_t wanted = count * kCandidatesPerFollicle + 100, round = 0; round < 8; wanted *= 2, ++round) {
    candidates = make_candidates(rest, density, options.seed, wanted, workers);
    if (candidates.size() >= count) break;
  }
  const std::vector<uint32_t> order = progressive_order(candidates, count, measure.mass);
  std::vector<V3f> positions;
  std::vector<RootAddress> roots;
  positions.reserve(order.size());
  roots.reserve(order.size());
  for (uint32_t i : order) {
    positions.emplace_back(candidates[i].x, candidates[i].y, candidates[i].z);
    roots.push_back(candidates[i].root);
  }
  candidates = {};
  std::vector<uint32_t> ids(order.size());
  std::iota(ids.begin(), ids.end(), 0u);
  std::vector<uint32_t> places;
  return over(positions, roots, ids, options.leaf_strands, places);
}

FollicleTree FollicleTree::of(std::vector<Leaf> leaves, std::vector<uint32_t> ids,
                              std::vector<RootAddress> roots) {
  PELAGE_CHECK(ids.size() == roots.size() && (leaves.empty() ? 0 : leaves.back().end) == ids.size());
  FollicleTree tree;
  tree.leaves_ = std::move(leaves);
  tree.ids_ = std::move(ids);
  tree.roots_ = std::move(roots);
  return tree;
}

size_t FollicleTree::bytes() const {
  return leaves_.capacity() * sizeof(Leaf) + ids_.capacity() * sizeof(uint32_t) +
         roots_.capacity() * sizeof(RootAddress);
}

}  // namespace pelage
