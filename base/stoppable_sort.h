// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include "base/job.h"

namespace pelage {

/// std::sort that throws Error (kStopped), leaving the elements in unspecified order, once the user has asked
/// to stop.
template <class Iterator, class Less>
void stoppable_sort(const Job& job, Iterator begin, Iterator end, const Less& less) {
  size_t comparisons = 0;
  std::sort(begin, end, [&](const auto& a, const auto& b) {
    if ((++comparisons & 0xffff) == 0) job.check_stop();
    return less(a, b);
  });
}

}  // namespace pelage
