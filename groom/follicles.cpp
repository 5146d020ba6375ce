// SPDX-License-Identifier: Apache-2.0
#include "groom/follicles.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "base/check.h"
#include "base/error.h"
#include "base/job.h"
#include "base/memory_budget.h"
#include "groom/follicle_candidates.h"
#include "groom/progressive_order.h"

namespace pelage {
namespace {

/// Splits ids[begin, end) into parts of at most `leaf` by halving along the longest axis of their box: parts
/// are compact, nearly equal in size, and a function of the positions only.
void split(std::span<const V3f> positions, std::vector<uint32_t>& ids, uint32_t begin, uint32_t end,
           uint32_t leaf, const Job& job, std::vector<FollicleTree::Leaf>& leaves) {
  job.check_stop();
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
  split(positions, ids, begin, begin + left, leaf, job, leaves);
  split(positions, ids, begin + left, end, leaf, job, leaves);
}

}  // namespace

FollicleTree FollicleTree::over(std::span<const V3f> rest_positions, std::span<const RootAddress> roots,
                                std::span<const uint32_t> ids, int leaf_strands, const Job& job,
                                std::vector<uint32_t>& order) {
  const size_t count = rest_positions.size();
  PELAGE_CHECK(leaf_strands > 0 && ids.size() == count && (roots.empty() || roots.size() == count));
  FollicleTree tree;
  order.resize(count);
  std::iota(order.begin(), order.end(), 0u);
  if (count == 0) return tree;
  split(rest_positions, order, 0, static_cast<uint32_t>(count), static_cast<uint32_t>(leaf_strands), job,
        tree.leaves_);
  tree.leaves_.shrink_to_fit();
  tree.ids_.reserve(count);
  for (uint32_t i : order) tree.ids_.push_back(ids[i]);
  tree.roots_.reserve(roots.size());
  for (size_t i = 0; i < roots.size(); ++i) tree.roots_.push_back(roots[order[i]]);
  return tree;
}

namespace {

constexpr size_t kMoreCandidates = 100;  // for coats of a few strands

/// Candidates that are tried for `count` follicles in the first round.
size_t candidates_for(size_t count) { return count * kCandidatesPerFollicle + kMoreCandidates; }

/// Positions of follicles in their progressive order.
void place(const LimitSurface& rest, const FollicleDensity& density, uint64_t seed, size_t count, double mass,
           const Job& job, std::vector<V3f>& positions, std::vector<RootAddress>& roots) {
  // The number of candidates that pass is random: repeats with more in the rare case of too few.
  MemoryCharge more;
  for (size_t wanted = candidates_for(count), round = 0; round < 8; wanted *= 2, ++round) {
    if (round > 0) {
      more = {};
      more = reserve(job.ledger, MemoryTag::kGrooms, static_cast<int64_t>(wanted * sizeof(FollicleCandidate)),
                     "more places for strands");
    }
    const FollicleCandidates source(rest, density, seed, wanted, job);
    std::vector<FollicleCandidate> candidates = source.make(job);
    if (candidates.size() < count && round < 7) continue;
    const std::vector<uint32_t> order = progressive_order(candidates, count, mass, job);
    positions.resize(order.size());
    roots.resize(order.size());
    job.for_each(order.size(), 4096, [&](WorkRange range) {
      for (size_t i = range.begin; i < range.end; ++i) {
        const FollicleCandidate& c = candidates[order[i]];
        positions[i] = V3f(c.x, c.y, c.z);
        roots[i] = source.root(c);
      }
    });
    return;
  }
}

/// Shows progress for many follicles, and nothing for few.
class PlacingStage final : public Progress {
 public:
  PlacingStage(Progress& whole, const FollicleOptions& options, size_t count)
      : whole_(whole), shown_(count >= kMinForProgress) {
    // The candidates and their order count 1 each.
    if (shown_) whole_.begin("place " + options.noun, 2);
  }
  ~PlacingStage() override { end(); }
  PlacingStage(const PlacingStage&) = delete;
  PlacingStage& operator=(const PlacingStage&) = delete;

  void begin(std::string_view, double) override {}
  void advance(double amount) override {
    if (shown_) whole_.advance(amount);
  }
  void end() override {
    if (std::exchange(shown_, false)) whole_.end();
  }
  bool cancelled() const override { return whole_.cancelled(); }

 private:
  static constexpr size_t kMinForProgress = 200'000;  // about a second
  Progress& whole_;
  bool shown_;
};

}  // namespace

int64_t follicle_temporary_bytes(int64_t count) {
  const auto n = static_cast<size_t>(count);
  return static_cast<int64_t>(progressive_order_bytes(candidates_for(n) + candidates_for(n) / 64, n));
}

int64_t follicle_bytes(int64_t count) {
  return count * static_cast<int64_t>(sizeof(uint32_t) + sizeof(RootAddress));
}

FollicleTree FollicleTree::build(const LimitSurface& rest, const FollicleOptions& options, const Job& job) {
  // For a coat with a given number of strands, memory is checked before anything is computed.
  const auto require = [&](size_t count) {
    return reserve(job.ledger, MemoryTag::kGrooms, follicle_temporary_bytes(static_cast<int64_t>(count)),
                   fmt::format("{}: placing {} {}", options.owner, count, options.noun));
  };
  if (options.count > 0 && options.count <= kMaxFollicles) require(static_cast<size_t>(options.count));
  const FollicleDensity density{options.density, options.coverage};
  const SurfaceMeasure measure = measure_surface(rest, density, job);
  const double asked =
      options.count > 0 ? static_cast<double>(options.count) : std::round(options.per_area * measure.mass);
  if (!(asked <= static_cast<double>(kMaxFollicles))) {
    throw Error(ErrorKind::kInput, fmt::format("{}: {:.3g} {} on one skin; at most {} are possible",
                                               options.owner, asked, options.noun, kMaxFollicles));
  }
  const auto count = static_cast<size_t>(asked);
  if (count == 0 || !(measure.mass > 0)) return {};

  const MemoryCharge making = require(count);
  PlacingStage stage(job.progress, options, count);
  const Job placing{job.workers, job.ledger, stage};
  std::vector<V3f> positions;
  std::vector<RootAddress> roots;
  place(rest, density, options.seed, count, measure.mass, placing, positions, roots);
  std::vector<uint32_t> ids(roots.size());
  std::iota(ids.begin(), ids.end(), 0u);
  std::vector<uint32_t> places;
  return over(positions, roots, ids, options.leaf_strands, job, places);
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
