// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "groom/cache/cache_report.h"
#include "groom/cache/frozen_coat.h"
#include "groom/cache/groom_identity.h"
#include "groom/coat/strand_writer.h"
#include "groom/groom.h"
#include "groom/operators/follow.h"
#include "groom/operators/operator_stack.h"

namespace pelage {

/// Members of Groom, for the source files that make and grow it.
struct Groom::Impl {
  StrandRole role = StrandRole::kUnder;
  uint64_t operator_seed = 0;  // seed of the context in which operators are prepared
  CoatSource source;
  std::optional<OperatorStack> stack;
  std::shared_ptr<MovingGuides> guides;  // only with dynamics
  size_t follow = 0;                     // index of the operator that moves strands, with dynamics
  ContentHash whole;                     // GroomIdentity::whole()
  ContentHash follicle_identity;         // equal hashes mean equal follicles in equal leaves
  std::optional<ContentStore> store;     // only with a cache
  std::optional<FrozenCoat> frozen;      // only with a cache
  size_t frozen_end = 0;                 // `frozen` is the state after the operators [0, frozen_end)
  bool needs_rest_frames = true;         // whether growing from the cache needs the frames of the rest skin
  // of all roots, if growing from the cache needs positions of the rest skin but no frames
  std::vector<V3f> rest_positions;
  std::optional<GroomCacheReport> report;
  MemoryCharge charge;

  /// Reads follicles and frozen leaves from the store. If they are missing, makes and stores them. Prepares
  /// the operators that are needed.
  void open_cache(const std::string& name, const GroomParams& params, const GroomIdentity& identity,
                  const PrepareContext& context, uint64_t seed);
  FollicleTree place_follicles(const GroomParams& params, const PrepareContext& context, uint64_t seed) const;

  void grow_plain(const PosedSkin& pose, size_t begin, size_t end, StrandWriter& writer) const;
  /// Computes the data of the rest skin that growing from the cache needs.
  void prepare_rest(const std::string& name, const Job& job);
  void grow_cached(size_t leaf, const PosedSkin& pose, size_t begin, size_t end, StrandWriter& writer) const;
  /// Sets the roots of the strands of a batch at a motion key: batch.count follicles from `begin` on.
  void stand(StrandBatch& batch, size_t begin, const PosedSkin& skin, size_t key) const;
  StrandWriter::Chosen chosen(const KeptStrands& kept, size_t begin) const;
  StrandReach reach(size_t leaf) const;
  size_t end_of(const PosedSkin& pose) const { return pose.guides_only ? follow : stack->size(); }
};

}  // namespace pelage
