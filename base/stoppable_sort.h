// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include "base/job.h"

namespace pelage {

/// Sorts like std::sort, in place, with all threads of the job. The order of equal elements is unspecified,
/// but does not depend on the number of threads. Throws Error (kStopped) once the user has asked to stop; the
/// order of the elements is then unspecified.
template <class Iterator, class Less>
void stoppable_sort(const Job& job, Iterator begin, Iterator end, const Less& less) {
  constexpr size_t kMaxPieces = 8, kMinToSplit = size_t(1) << 14;
  const auto count = static_cast<size_t>(end - begin);
  // Boundary between equal pieces of the range.
  const auto border = [&](size_t index, size_t pieces) {
    return begin + static_cast<std::ptrdiff_t>(count * index / pieces);
  };
  // Calls step(index of a piece, comparison that now and then checks for a stop).
  const auto run = [&](size_t piece, const auto& step) {
    size_t comparisons = 0;
    step(piece, [&](const auto& a, const auto& b) {
      if ((++comparisons & 0xffff) == 0) job.check_stop();
      return less(a, b);
    });
  };
  const auto for_each_of = [&](size_t pieces, const auto& step) {
    if (pieces == 1) return run(0, step);
    job.for_each(pieces, 1, [&](WorkRange range) { run(range.begin, step); });
  };

  size_t pieces = 1;
  for (; count >= kMinToSplit && pieces < kMaxPieces; pieces *= 2) {
    for_each_of(pieces, [&](size_t piece, const auto& compare) {
      const size_t halves = 2 * pieces;
      std::nth_element(border(2 * piece, halves), border(2 * piece + 1, halves),
                       border(2 * piece + 2, halves), compare);
    });
  }
  for_each_of(pieces, [&](size_t piece, const auto& compare) {
    std::sort(border(piece, pieces), border(piece + 1, pieces), compare);
  });
}

}  // namespace pelage
