// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/value_readers.h"
#include "geom/io/strand_file.h"

namespace pelage {

/// Rethrows an error in the content of a file that a scene names. The position becomes that of the name in
/// the scene; each message begins with the position in the file.
[[noreturn]] void throw_where_named(const Error& error, const AssetPath& file);

/// What `work` returns. Errors of kind kInput go through throw_where_named().
template <class Work>
auto where_named(const AssetPath& file, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kInput) throw;
    throw_where_named(error, file);
  }
}

/// read_strands() of a file that a scene names.
StrandFile read_named_strands(const AssetPath& file, const StrandReadOptions& options);

}  // namespace pelage
