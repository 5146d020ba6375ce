// SPDX-License-Identifier: Apache-2.0
#include "render/accel/chunk_boxes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/accel/fur/fur_grid.h"

namespace pelage {
namespace {

/// Upper bound: no strand is wider than its box.
float widest_radius(const ChunkBounds& bounds) {
  const Box3f box = bounds.whole();
  const V3f size = box.isEmpty() ? V3f(0) : box.size();
  return 0.5f * std::min({size.x, size.y, size.z});
}

}  // namespace

ChunkBoxes::ChunkBoxes(std::vector<ChunkBounds> given, const ChunkGrower& grower, bool fur_trees)
    : given_(std::move(given)),
      known_(given_.size()),
      learned_(given_.size()),
      whole_(given_.size()),
      tree_parts_(given_.size()) {
  bytes_bound_ =
      given_.size() * (sizeof(known_[0]) + sizeof(learned_[0]) + sizeof(whole_[0]) + sizeof(tree_parts_[0]));
  for (uint32_t chunk = 0; chunk < given_.size(); ++chunk) {
    const ChunkCounts counts = grower.counts(chunk);
    ChunkBounds& bounds = given_[chunk];
    KnownBounds& known = known_[chunk];
    known.in_fur_tree = fur_trees && !grower.is_skin(chunk);
    if (known.in_fur_tree) {
      if (bounds.keys == 1) known.given = bounds.whole();
      known.margin = FurGrid(grower.scale(chunk)).margin(widest_radius(bounds));
      widen(bounds, known.margin);
      bounds = std::move(bounds).in_one_part();
    }
    known.cell_bounds = std::move(bounds.cell_bounds);
    // For a moving chunk, boxes over a longer time than the shutter are less tight than learned ones.
    known.learns = known.cell_bounds.count() == 0 || (counts.motion_keys > 1 && bounds.keys == 1);
    bytes_bound_ += known.cell_bounds.bytes();
    if (known.learns)
      bytes_bound_ += PartBoxes::bytes_bound(learned_parts(counts.segments + counts.triangles) + 3,
                                             counts.motion_keys > 1);
  }
}

ChunkBoxes::~ChunkBoxes() {
  for (auto& boxes : learned_) delete boxes.load(std::memory_order_relaxed);
}

void ChunkBoxes::build_tree(const Workers& workers) {
  for (size_t chunk = 0; chunk < given_.size(); ++chunk) {
    tree_parts_[chunk] = static_cast<uint32_t>(given_[chunk].part_count());
    whole_[chunk] = given_[chunk].whole();
  }
  tree_ = std::make_unique<const ChunkTree>(given_, workers);
  given_ = {};
}

/// Returns the measured box of a chunk without cell bounds, or else the known one.
Box3f ChunkBoxes::tight_box(uint32_t chunk) const {
  const PartBoxes* const measured = learned(chunk);
  if (!measured || !in_fur_tree(chunk) || has_cell_bounds(chunk)) return whole_[chunk];
  Box3f box = measured->bounds().whole();
  if (box.isEmpty()) return box;
  float reach = 0;
  for (int axis = 0; axis < 3; ++axis)
    reach = std::max({reach, std::abs(box.min[axis]), std::abs(box.max[axis])});
  const V3f rounding(1e-6f * reach);  // boxes at shutter close are sums of floats, which round
  box.min -= rounding;
  box.max += rounding;
  return box;
}

void ChunkBoxes::tighten(const Workers& workers) {
  if (!has_news_.exchange(false)) return;
  given_.resize(size());
  for (uint32_t chunk = 0; chunk < given_.size(); ++chunk) {
    const Box3f box = tight_box(chunk);
    if (!box.isEmpty()) given_[chunk].boxes = {box};
  }
  build_tree(workers);
}

void ChunkBoxes::build_tree_of_learned(const Workers& workers) {
  for (uint32_t chunk = 0; chunk < given_.size(); ++chunk) {
    given_[chunk] = learned(chunk)->bounds();
    if (in_fur_tree(chunk)) given_[chunk] = std::move(given_[chunk]).in_one_part();
  }
  build_tree(workers);
}

void ChunkBoxes::learn(uint32_t chunk, const ChunkBounds& measured) {
  learn(chunk, std::make_unique<const PartBoxes>(measured));
}

void ChunkBoxes::learn(uint32_t chunk, std::unique_ptr<const PartBoxes> measured) {
  learned_[chunk].store(measured.release(), std::memory_order_release);
  has_news_.store(true, std::memory_order_relaxed);
}

ChunkBounds ChunkBoxes::take_given(uint32_t chunk) {
  KnownBounds& known = known_[chunk];
  if (known.given.isEmpty()) return {};
  const bool measured = learned(chunk) && !has_cell_bounds(chunk);
  return {1, {measured ? tight_box(chunk) : known.given}, std::move(known.cell_bounds)};
}

std::unique_ptr<const PartBoxes> ChunkBoxes::take_learned(uint32_t chunk) {
  return std::unique_ptr<const PartBoxes>(learned_[chunk].exchange(nullptr, std::memory_order_acq_rel));
}

size_t ChunkBoxes::learned_parts(size_t primitives) {
  return std::clamp<size_t>(primitives / kPrimitivesPerPart, 1, kMaxParts);
}

}  // namespace pelage
