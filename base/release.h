// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace pelage {

/// Gives the memory of a vector back; `values = {}` would keep it for the next ones.
template <class T>
void release(std::vector<T>& values) {
  std::vector<T>().swap(values);
}

}  // namespace pelage
