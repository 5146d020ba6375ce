// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdlib>

namespace pelage {

/// How many times as long tests run that can be run for longer: PELAGE_SOAK, or 1. See CONTRIBUTING.md.
inline uint64_t soak_scale() {
  const char* text = std::getenv("PELAGE_SOAK");
  const long scale = text ? std::atol(text) : 1;
  return scale > 1 ? static_cast<uint64_t>(scale) : 1;
}

/// The first of the cases of a soak that is looked at, to come back to one that failed: PELAGE_SOAK_FROM, or
/// 0. Cases before it are made, and nothing is asked of them.
inline uint64_t soak_begin() {
  const char* text = std::getenv("PELAGE_SOAK_FROM");
  const long long first = text ? std::atoll(text) : 0;
  return first > 0 ? static_cast<uint64_t>(first) : 0;
}

}  // namespace pelage
