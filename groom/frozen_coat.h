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

/// All leaves of a coat after its frozen operators: in a file, or in memory when no file could be written.
/// Immutable. Thread safety: const members may be called from any thread.
class FrozenCoat {
 public:
  static std::filesystem::path file(const ContentStore& store, const ContentHash& key);
  /// The coat in the store. Empty when it is missing, or when its leaves do not match `source`.
  static std::optional<FrozenCoat> open(const ContentStore& store, const ContentHash& key,
                                        const CoatSource& source, const WarningSink& warn);
  /// Leaves that were just grown, kept in memory and charged to `ledger`.
  FrozenCoat(std::vector<std::vector<std::byte>> leaves, std::vector<StrandReach> reaches,
             MemoryLedger& ledger);
  static bool store(const ContentStore& store, const ContentHash& key,
                    const std::vector<std::vector<std::byte>>& leaves,
                    const std::vector<StrandReach>& reaches, const WarningSink& warn);

  const FrozenLeaf& leaf(size_t i) const { return leaves_[i]; }
  /// Properties of a leaf's strands, including quantisation.
  const StrandReach& reach(size_t leaf) const { return reaches_[leaf]; }
  /// Size of all leaves, without the rest of the file.
  size_t bytes() const;

 private:
  FrozenCoat() = default;

  std::optional<StoredFile> file_;
  std::vector<std::vector<std::byte>> memory_;
  MemoryCharge charge_;
  std::vector<FrozenLeaf> leaves_;
  std::vector<StrandReach> reaches_;
};

/// Runs a coat through the frozen operators.
struct FrozenGrowth {
  const std::string& owner;  ///< for messages: "groom 'coat'"
  const CoatSource& source;
  OperatorStack& stack;
  const GroomIdentity& identity;
  size_t frozen = 0;  ///< number of frozen operators: [0, frozen)
  const ContentStore& store;
  const WarningSink& warn;          ///< called for damaged files
  const WarningSink& cannot_store;  ///< called for files that cannot be written
  const Job& job;

  struct Result {
    std::vector<std::vector<std::byte>> leaves;
    std::vector<StrandReach> reaches;
    size_t resumed = 0;   ///< operators whose result was in the store
    MemoryCharge charge;  ///< of the leaves
  };
  /// Grows all leaves, starting after the last operator whose result is in the store, and stores the state
  /// after each operator that runs, except after the last. Prepares the operators that it needs. Passes on
  /// the exceptions of operators. Throws Error: kMemory as soon as the first leaves show that all leaves
  /// together will not fit, kStopped when the job is stopped. After an exception, nothing is stored.
  Result run(const PrepareContext& context, int leaf_strands) const;
  void charge_grown(size_t done, Result& result) const;
  /// Whether growth can continue from a layer; if so, sets `reaches` to the reaches after the layer's
  /// operator.
  bool resumes(const StoredFile& layer, std::vector<StrandReach>& reaches) const;
};

/// The file with the state after the operator whose stage has this hash.
std::filesystem::path layer_file(const ContentStore& store, const ContentHash& stage, int leaf_strands);

/// Key of the file of a layer or of the offsets. The same strands in another layout of leaves use another
/// file.
ContentHash in_leaves(const ContentHash& hash, int leaf_strands);

}  // namespace pelage
