// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "groom/cache_report.h"
#include "groom/frozen_coat.h"
#include "groom/groom.h"
#include "groom/groom_identity.h"
#include "groom/operator_stack.h"
#include "groom/strand_writer.h"

namespace pelage {

/// Members of a groom, for the source files that make and grow it.
struct Groom::Impl {
  StrandRole role = StrandRole::kUnder;
  uint64_t operator_seed = 0;  // of their context
  CoatSource source;
  std::optional<OperatorStack> stack;
  ContentHash hash;
  std::optional<ContentStore> store;  // of a groom with a cache
  std::optional<FrozenCoat> frozen;   // of a groom with a cache
  size_t frozen_end = 0;              // the operators [0, frozen_end) are in it
  bool needs_rest_frames = true;      // growing from the cache needs the frames of the rest skin
  std::vector<V3f> rest_positions;    // of all roots, when these alone are needed
  std::optional<GroomCacheReport> report;
  MemoryCharge charge;

  /// Reads follicles and frozen leaves from the store, or makes and stores them; prepares the operators that
  /// are needed.
  void open_cache(const std::string& name, const GroomParams& params, const GroomIdentity& identity,
                  const PrepareContext& context, uint64_t seed);
  FollicleTree place_follicles(const GroomParams& params, const PrepareContext& context, uint64_t seed) const;

  void grow_plain(const PosedSkin& pose, size_t begin, size_t end, StrandWriter& writer) const;
  /// Computes the data of the rest skin that growing from the cache needs.
  void prepare_rest(const std::string& name, const Job& job);
  void grow_cached(size_t leaf, const PosedSkin& pose, size_t begin, size_t end, StrandWriter& writer) const;
  /// Sets the roots of batch.count strands at a motion key.
  void stand(StrandBatch& batch, size_t begin, const PosedSkin& skin, size_t key) const;
  StrandWriter::Chosen chosen(const KeptStrands& kept, size_t begin) const;
  StrandReach reach(size_t leaf) const;
};

}  // namespace pelage
