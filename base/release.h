// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace pelage {

/// Frees the memory of a vector; `values = {}` would keep it.
template <class T>
void release(std::vector<T>& values) {
  std::vector<T>().swap(values);
}

}  // namespace pelage
