// SPDX-License-Identifier: Apache-2.0
#include "groom/attachment.h"

#include <algorithm>

#include <fmt/format.h>

namespace pelage {

SkinGaps SkinGaps::of(std::vector<float>& gaps, const Box3f& skin) {
  SkinGaps result;
  result.skin_size = skin.isEmpty() ? 0 : skin.size().length();
  if (gaps.empty()) return result;
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::nth_element(gaps.begin(), middle, gaps.end());
  result.least = *std::min_element(gaps.begin(), middle + 1);
  result.median = *middle;
  result.most = *std::max_element(middle, gaps.end());
  return result;
}

std::string SkinGaps::describe(const std::string& skin) const {
  return fmt::format("begin {:.3g} to {:.3g} units from skin '{}', which is {:.3g} units across", least, most,
                     skin, skin_size);
}

}  // namespace pelage
