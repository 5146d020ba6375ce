// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/ledger.h"
#include "base/value_readers.h"
#include "geom/io/strand_file.h"

namespace pelage {

/// Rethrows an error about the contents of a file that a scene names. The position of the new error is the
/// line of the scene that names the file. Each message starts with the position in the file.
[[noreturn]] void rethrow_at_asset(const Error& error, const AssetPath& file);

/// Returns the result of `work`. If `work` throws an Error of kind kInput, calls rethrow_at_asset(); other
/// errors pass through.
template <class Work>
auto with_errors_at_asset(const AssetPath& file, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kInput) throw;
    rethrow_at_asset(error, file);
  }
}

/// Returns how many bytes still fit the memory limit; the largest number if there is none.
int64_t free_bytes(const MemoryLedger& ledger);

/// Reads the strands of a file that a scene names, like read_strands(), with errors as in
/// with_errors_at_asset().
StrandFile read_named_strands(const AssetPath& file, const StrandReadOptions& options);

}  // namespace pelage
