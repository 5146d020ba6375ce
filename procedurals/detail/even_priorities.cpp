// SPDX-License-Identifier: Apache-2.0
#include "procedurals/detail/even_priorities.h"

#include <algorithm>
#include <cstdint>
#include <tuple>

#include "base/memory_budget.h"

namespace pelage {
namespace {

/// Cells along each axis: 2^16 of a face, 2^20 of the box of all roots.
constexpr uint32_t kOfFace = 1u << 16, kOfBox = 1u << 20;
constexpr int64_t kTemporaryBytes = sizeof(uint64_t) + sizeof(uint32_t);  // per strand

uint64_t cell(float place, uint32_t cells) {
  const float scaled = place * static_cast<float>(cells);
  return scaled > 0 ? std::min<uint64_t>(static_cast<uint64_t>(scaled), cells - 1) : 0;
}

/// The bits of x, each followed by `gap` zeros.
uint64_t spread(uint64_t x, int gap) {
  uint64_t result = 0;
  for (int bit = 0; bit < 20; ++bit) result |= (x >> bit & 1) << (bit * (gap + 1));
  return result;
}

/// Position along the curve.
std::vector<uint64_t> positions(const Groom& groom) {
  const FollicleTree& follicles = groom.follicles();
  std::vector<uint64_t> along(follicles.size());
  if (follicles.has_roots()) {
    for (size_t f = 0; f < along.size(); ++f) {
      const RootAddress& root = follicles.root(f);
      along[f] = uint64_t{root.face} << 32 | spread(cell(root.u, kOfFace), 1) |
                 spread(cell(root.v, kOfFace), 1) << 1;
    }
    return along;
  }
  const PosedSkin rest;
  Box3f box;
  for (size_t f = 0; f < along.size(); ++f) box.extendBy(groom.root(f, rest, 0).position);
  const V3f size = along.empty() ? V3f(1) : box.size();
  const float longest = std::max({size.x, size.y, size.z, 1e-30f});
  for (size_t f = 0; f < along.size(); ++f) {
    const V3f at = (groom.root(f, rest, 0).position - box.min) * (1 / longest);
    for (int axis = 0; axis < 3; ++axis) along[f] |= spread(cell(at[axis], kOfBox), 2) << axis;
  }
  return along;
}

/// The bits of a rank in reverse order, behind the binary point.
float radical_inverse(uint32_t x) {
  uint32_t reversed = 0;
  for (int bit = 0; bit < 24; ++bit) reversed |= (x >> bit & 1) << (23 - bit);
  return static_cast<float>(reversed) * 0x1p-24f;
}

}  // namespace

EvenPriorities::EvenPriorities(const Groom& groom, MemoryLedger& ledger) {
  const FollicleTree& follicles = groom.follicles();
  const auto count = static_cast<int64_t>(follicles.size());
  const MemoryCharge temporary = reserve(ledger, MemoryTag::kGrooms, count * kTemporaryBytes,
                                         "sorting the strands of a groom from a file");
  const std::vector<uint64_t> along = positions(groom);
  std::vector<uint32_t> order(follicles.size());
  for (uint32_t f = 0; f < order.size(); ++f) order[f] = f;
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return std::tuple(along[a], follicles.id(a)) < std::tuple(along[b], follicles.id(b));
  });
  charge_ = reserve(ledger, MemoryTag::kGrooms, count * static_cast<int64_t>(sizeof(float)),
                    "the priorities of a groom from a file");
  of_follicle_.resize(order.size());
  for (uint32_t rank = 0; rank < order.size(); ++rank) of_follicle_[order[rank]] = radical_inverse(rank);
}

}  // namespace pelage
