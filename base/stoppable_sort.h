// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include "base/job.h"

namespace pelage {

/// Sorts like std::sort. Throws Error (kStopped) once the user has asked to stop; the order of the elements
/// is then unspecified.
template <class Iterator, class Less>
void stoppable_sort(const Job& job, Iterator begin, Iterator end, const Less& less) {
  size_t comparisons = 0;
  std::sort(begin, end, [&](const auto& a, const auto& b) {
    if ((++comparisons & 0xffff) == 0) job.check_stop();
    return less(a, b);
  });
}

}  // namespace pelage
