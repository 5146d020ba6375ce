// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/value_readers.h"

namespace pelage {

/// Returns what `make` makes from a file. Errors of `make` that have no line, because the file has none, get
/// the place where the scene names the file.
template <class Make>
std::invoke_result_t<Make> with_place_of(const AssetPath& file, const Make& make) {
  try {
    return make();
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::kStopped) throw;
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems) {
      if (problem.position.line == 0) problem = {file.position, file.path.string() + ": " + problem.message};
    }
    throw Error(error.kind(), std::move(problems));
  }
}

}  // namespace pelage
