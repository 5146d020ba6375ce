// SPDX-License-Identifier: Apache-2.0
#include "groom/follicles/follicles.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/check.h"
#include "base/error.h"
#include "base/job.h"
#include "base/memory_budget.h"
#include "groom/follicles/follicle_candidates.h"
#include "groom/follicles/progressive_order.h"

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
// Bytes per follicle while the tree is made: its position, its root twice, its id and its place in the order.
constexpr size_t kBytesOfTree = sizeof(V3f) + 2 * sizeof(RootAddress) + 3 * sizeof(uint32_t);

/// Candidates that are tried for `count` follicles in the first round.
size_t candidates_for(size_t count) { return count * kCandidatesPerFollicle + kMoreCandidates; }

/// Memory for placing `count` follicles, chosen from `wanted` candidates, including the tree.
int64_t placing_bytes(size_t wanted, size_t count, const HeldCandidates& held) {
  return static_cast<int64_t>(std::max(progressive_order_bytes(wanted, count, held), count * kBytesOfTree));
}

/// The fastest way to hold candidates that the ledger has room for.
HeldCandidates held_in(const MemoryLedger& ledger, size_t wanted, size_t count) {
  const size_t max = FollicleCandidates::max_of(wanted);
  const HeldCandidates fastest = HeldCandidates::fastest(max, count);
  return has_room(ledger, placing_bytes(wanted, count, fastest)) ? fastest
                                                                 : HeldCandidates::least(max, count);
}

/// Chooses the candidates that become follicles, in progressive order; nullopt if there are too few
/// candidates.
std::optional<std::vector<uint32_t>> choose(const FollicleCandidates& source, const HeldCandidates& held,
                                            size_t count, double mass, bool few_will_do,
                                            const FollicleOptions& options, const Job& job) {
  size_t all = 0;
  {
    CandidateSupply supply(source, held.parts, job);
    all = supply.survey().count;
    if (all < count && !few_will_do) return std::nullopt;
    const HeldCandidates max{held.parts, held.parts == 1 ? all : held.max_waiting, held.in_blocks};
    if (auto order = progressive_order(supply, count, mass, max, job)) return order;
  }
  // Dropped candidates were needed, because the skin is narrower than the distance between follicles, or
  // there was no room for the lists of blocks. The grid with all candidates always succeeds.
  const HeldCandidates whole{held.parts, all};
  const size_t needed = progressive_order_bytes(source.wanted(), count, whole),
               reserved = progressive_order_bytes(source.wanted(), count, held);
  const size_t more = needed - std::min(needed, reserved);
  const MemoryCharge charge = reserve(
      job.ledger, MemoryTag::kGrooms, static_cast<int64_t>(more),
      fmt::format("placing {} {} of {} with all their candidates", count, options.noun, options.owner));
  CandidateSupply supply(source, whole.parts, job);
  return progressive_order(supply, count, mass, whole, job);
}

/// Positions of follicles in their progressive order. Returns the charge for them and for making the tree.
MemoryCharge place(const LimitSurface& rest, const FollicleDensity& density, const FollicleOptions& options,
                   size_t count, SurfaceMeasure measure, const Job& job, std::vector<V3f>& positions,
                   std::vector<RootAddress>& roots) {
  const double mass = measure.mass;
  FollicleCandidates source(rest, density, options.seed, candidates_for(count), std::move(measure));
  // The number of candidates is random: in the rare case of too few, repeats with more.
  for (size_t wanted = candidates_for(count), round = 0; round < 8; wanted *= 2, ++round) {
    const HeldCandidates held = held_in(job.ledger, wanted, count);
    MemoryCharge making = reserve(job.ledger, MemoryTag::kGrooms, placing_bytes(wanted, count, held),
                                  fmt::format("placing {} {} of {}{}", count, options.noun,
                                              round == 0 ? "" : "uneven density for ", options.owner));
    source.want(wanted);
    const auto order = choose(source, held, count, mass, round == 7, options, job);
    if (!order) continue;
    positions.resize(order->size());
    roots.resize(order->size());
    job.for_each(order->size(), 4096, [&](WorkRange range) {
      for (size_t i = range.begin; i < range.end; ++i) roots[i] = source.root((*order)[i], &positions[i]);
    });
    return making;
  }
  return {};
}

/// Shows progress for many follicles, and nothing for few.
class PlacingStage final : public Progress {
 public:
  PlacingStage(Progress& whole, const FollicleOptions& options, size_t count)
      : whole_(whole), shown_(count >= kMinForProgress) {
    // The survey of the candidates, their making and their order count 1 each.
    if (shown_) whole_.begin("place " + options.noun, 3);
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
  const size_t candidates = candidates_for(n);
  return placing_bytes(candidates, n, HeldCandidates::least(FollicleCandidates::max_of(candidates), n));
}

int64_t follicle_bytes(int64_t count) {
  return count * static_cast<int64_t>(sizeof(uint32_t) + sizeof(RootAddress));
}

FollicleTree FollicleTree::build(const LimitSurface& rest, const FollicleOptions& options, const Job& job) {
  // For a coat with a given number of strands, memory is checked before anything is computed.
  if (options.count > 0 && options.count <= kMaxFollicles) {
    require_memory(job.ledger, follicle_temporary_bytes(options.count),
                   fmt::format("placing {} {} of {}", options.count, options.noun, options.owner));
  }
  const FollicleDensity density{options.density, options.coverage};
  SurfaceMeasure measure = measure_surface(rest, density, job);
  const double asked =
      options.count > 0 ? static_cast<double>(options.count) : std::round(options.per_area * measure.mass);
  if (!(asked <= static_cast<double>(kMaxFollicles))) {
    throw Error(ErrorKind::kInput, fmt::format("{}: {:.3g} {} on one skin; the limit is {}", options.owner,
                                               asked, options.noun, kMaxFollicles));
  }
  const auto count = static_cast<size_t>(asked);
  if (count == 0 || !(measure.mass > 0)) return {};

  PlacingStage stage(job.progress, options, count);
  const Job placing{job.workers, job.ledger, stage};
  std::vector<V3f> positions;
  std::vector<RootAddress> roots;
  const MemoryCharge making =
      place(rest, density, options, count, std::move(measure), placing, positions, roots);
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
