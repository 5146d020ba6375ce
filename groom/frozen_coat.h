// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "base/content_store.h"
#include "base/job.h"
#include "base/ledger.h"
#include "groom/coat_source.h"
#include "groom/frozen_leaf.h"
#include "groom/groom_identity.h"
#include "groom/operator_stack.h"

namespace pelage {

/// All leaves of a coat after its frozen operators: of a file, or in memory where no file could be written.
/// Immutable. Thread safety: const members may be called from any thread.
class FrozenCoat {
 public:
  static std::filesystem::path file(const ContentStore& store, const ContentHash& key);
  /// What stands in the store. Nothing when it is not there, or not the leaves of `source`.
  static std::optional<FrozenCoat> open(const ContentStore& store, const ContentHash& key,
                                        const CoatSource& source, const WarningSink& warn);
  /// Leaves that were just grown, kept in memory and charged to `ledger`.
  FrozenCoat(std::vector<std::vector<std::byte>> leaves, std::vector<StrandReach> reaches,
             MemoryLedger& ledger);
  static bool store(const ContentStore& store, const ContentHash& key,
                    const std::vector<std::vector<std::byte>>& leaves,
                    const std::vector<StrandReach>& reaches, const WarningSink& warn);

  const FrozenLeaf& leaf(size_t i) const { return leaves_[i]; }
  /// What holds of a leaf's strands; quantisation included.
  const StrandReach& reach(size_t leaf) const { return reaches_[leaf]; }
  /// Of all leaves, without what surrounds them in a file.
  size_t bytes() const;

 private:
  FrozenCoat() = default;

  std::optional<StoredFile> file_;
  std::vector<std::vector<std::byte>> memory_;
  MemoryCharge charge_;
  std::vector<FrozenLeaf> leaves_;
  std::vector<StrandReach> reaches_;
};

/// A coat on its way through the frozen operators.
struct FrozenGrowth {
  const CoatSource& source;
  OperatorStack& stack;
  const GroomIdentity& identity;
  size_t frozen = 0;  ///< operators [0, frozen) run
  const ContentStore& store;
  const WarningSink& warn;          ///< of damaged files
  const WarningSink& cannot_store;  ///< of files that cannot be written
  const Job& job;

  struct Result {
    std::vector<std::vector<std::byte>> leaves;
    std::vector<StrandReach> reaches;
    size_t resumed = 0;  ///< operators whose result stood in the store
  };
  /// Grows all leaves, from the last operator on whose result the store has, and stores the state behind each
  /// operator that runs, but the last. Prepares the operators that it needs. Throws what they throw, and
  /// Error (kStopped) when `progress` was cancelled: then nothing is stored.
  Result run(const PrepareContext& context, int leaf_strands) const;
  /// Whether growth can go on from a layer; then `reaches` are those behind its operator.
  bool resumes(const StoredFile& layer, std::vector<StrandReach>& reaches) const;
};

/// The file of the state behind an operator whose stage has this hash.
std::filesystem::path layer_file(const ContentStore& store, const ContentHash& stage, int leaf_strands);

/// A layer or the offsets: the same strands in another layout of leaves stand in another file.
ContentHash in_leaves(const ContentHash& hash, int leaf_strands);

}  // namespace pelage
