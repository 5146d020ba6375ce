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

}  // namespace pelage
