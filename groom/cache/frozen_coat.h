// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "base/content_store.h"
#include "base/job.h"
#include "base/ledger.h"
#include "groom/cache/frozen_leaf.h"
#include "groom/cache/groom_identity.h"
#include "groom/coat/coat_source.h"
#include "groom/operators/operator_stack.h"

namespace pelage {

/// All leaves of a coat in their state after the frozen operators. The data is in a file, or in memory when
/// no file could be written. Immutable. Thread safety: const members may be called from any thread.
class FrozenCoat {
 public:
  /// Returns the path of the file in the store.
  static std::filesystem::path file(const ContentStore& store, const ContentHash& key);
  /// Opens the coat in the store. Empty when the file is missing, or when its leaves do not match `source`.
  static std::optional<FrozenCoat> open(const ContentStore& store, const ContentHash& key,
                                        const CoatSource& source, const WarningSink& warn);
  /// Makes a coat from leaves that were just grown. Keeps these leaves in memory, and charges them to
  /// `ledger`.
  FrozenCoat(std::vector<std::vector<std::byte>> leaves, std::vector<StrandReach> reaches,
             MemoryLedger& ledger);
  /// Stores leaves. Returns whether the file was written.
  static bool store(const ContentStore& store, const ContentHash& key,
                    const std::vector<std::vector<std::byte>>& leaves,
                    const std::vector<StrandReach>& reaches, const WarningSink& warn);

  const FrozenLeaf& leaf(size_t i) const { return leaves_[i]; }
  /// Bounds of the strands of a leaf, including the error of quantisation.
  const StrandReach& reach(size_t leaf) const { return reaches_[leaf]; }
  /// Size of all leaves, without the header of the file.
  size_t bytes() const;

 private:
  FrozenCoat() = default;

  std::optional<StoredFile> file_;
  std::vector<std::vector<std::byte>> memory_;
  MemoryCharge charge_;
  std::vector<FrozenLeaf> leaves_;
  std::vector<StrandReach> reaches_;
};

/// Grows a coat up to and including its frozen operators.
struct FrozenGrowth {
  const std::string& owner;  ///< for messages: "groom 'coat'"
  const CoatSource& source;
  OperatorStack& stack;
  const GroomIdentity& identity;
  size_t frozen = 0;  ///< the operators [0, frozen) are frozen
  const ContentStore& store;
  const WarningSink& warn;          ///< called for damaged files
  const WarningSink& cannot_store;  ///< called for files that cannot be written
  const Job& job;

  struct Result {
    std::vector<std::vector<std::byte>> leaves;
    std::vector<StrandReach> reaches;
    size_t resumed = 0;   ///< number of operators whose result was in the store
    MemoryCharge charge;  ///< memory of the leaves
  };
  /// Grows all leaves. Starts with the result of the last operator that has one in the store. Stores the
  /// state after each operator that runs, except the last one. Prepares the operators that it needs. Passes
  /// on exceptions of operators. Throws Error: kMemory as soon as the size of the first leaves shows that all
  /// leaves together will not fit, kStopped when the job is stopped. After an exception, nothing is stored.
  Result run(const PrepareContext& context, int leaf_strands) const;
  void charge_grown(size_t done, Result& result) const;
  /// Whether growth can start from the state in `layer`. If so, sets `reaches` to the bounds of the strands
  /// in that state.
  bool resumes(const StoredFile& layer, std::vector<StrandReach>& reaches) const;
};

/// Returns the path of the file with the state after the operator whose stage has the hash `stage`.
std::filesystem::path layer_file(const ContentStore& store, const ContentHash& stage, int leaf_strands);

/// Returns the key of a file of strands: a hash of `hash` and of the layout of leaves. The same strands in
/// another layout need another file.
ContentHash in_leaves(const ContentHash& hash, int leaf_strands);

}  // namespace pelage
