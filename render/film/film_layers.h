// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/value_readers.h"
#include "base/vector.h"

namespace pelage {

enum class PixelFilter { kBox, kBlackmanHarris };
template <>
struct EnumNames<PixelFilter> {
  static constexpr const char* names[] = {"box", "blackman-harris"};
};

struct ImageParams {
  int width = 1280;
  int height = 720;
  PixelFilter filter = PixelFilter::kBlackmanHarris;
  static const Schema<ImageParams>& schema();
};

}  // namespace pelage
