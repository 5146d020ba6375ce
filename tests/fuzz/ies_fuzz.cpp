// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "base/check.h"
#include "base/error.h"
#include "render/light/light_profile.h"
#include "tests/fuzz/fuzz_targets.h"

namespace pelage {

void fuzz_ies(std::span<const uint8_t> bytes) {
  const std::filesystem::path path = fuzz_file(bytes, ".ies");
  try {
    IesPhotometry ies = read_ies(path);
    PELAGE_CHECK(ies.candela.size() == ies.vertical.size() * ies.horizontal.size());
    const LightProfile profile(std::move(ies));
    PELAGE_CHECK(profile.watts() > 0 && std::isfinite(profile.watts()));
    for (const V3f& direction : {V3f(0, 0, 1), V3f(0, 0, -1), V3f(1, 0, 0), V3f(0, 1, 0), V3f(0, -1, 0),
                                 V3f(-0.6f, 0.64f, 0.48f), V3f(0.48f, -0.6f, -0.64f)}) {
      const float factor = profile.factor(direction);
      PELAGE_CHECK(factor >= 0 && std::isfinite(factor));
    }
  } catch (const Error& error) {
    PELAGE_CHECK(error.kind() == ErrorKind::kInput);
  }
}

}  // namespace pelage
