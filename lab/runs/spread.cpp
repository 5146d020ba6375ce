// SPDX-License-Identifier: Apache-2.0
#include "lab/runs/spread.h"

#include <fmt/format.h>

namespace pelage {

RatioSpread ratio_of(const Outcome& above, const Outcome& below, const std::string& path) {
  return {above.number(path) / below.number(path), above.min(path) / below.max(path),
          above.max(path) / below.min(path)};
}

std::string spread_text(const RatioSpread& ratio) {
  if (ratio.min == ratio.max) return fmt::format("{:.2f}", ratio.typical);
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", ratio.typical, ratio.min, ratio.max);
}

}  // namespace pelage
