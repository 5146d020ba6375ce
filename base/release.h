// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace pelage {

/// Empties a vector and frees its memory. `values = {}` would keep the memory.
template <class T>
void release(std::vector<T>& values) {
  std::vector<T>().swap(values);
}

}  // namespace pelage
