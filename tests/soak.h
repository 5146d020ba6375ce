// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdlib>

namespace pelage {

/// Factor on the length of tests that can run longer: PELAGE_SOAK, or 1. See CONTRIBUTING.md.
inline uint64_t soak_scale() {
  const char* text = std::getenv("PELAGE_SOAK");
  const long scale = text ? std::atol(text) : 1;
  return scale > 1 ? static_cast<uint64_t>(scale) : 1;
}

/// Index of the first case of a soak test to check, for reproducing a failure: PELAGE_SOAK_FROM, or 0. Cases
/// before it are generated but not checked.
inline uint64_t soak_begin() {
  const char* text = std::getenv("PELAGE_SOAK_FROM");
  const long long first = text ? std::atoll(text) : 0;
  return first > 0 ? static_cast<uint64_t>(first) : 0;
}

}  // namespace pelage
