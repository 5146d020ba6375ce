// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>

#include "base/vector.h"

namespace pelage {

/// Turns a colour into an absorption under which a single fibre of any model is as bright as one of the
/// Chiang model of that colour, so that models may be exchanged: by a table over the logarithm of the colour.
class MatchedAbsorption {
 public:
  /// `albedo` of a fibre for light across it, averaged over h, by absorption; falls as absorption rises.
  explicit MatchedAbsorption(const std::function<float(float)>& albedo);
  Rgb operator()(const Rgb& color) const;

 private:
  static constexpr int kCells = 96;
  std::array<float, kCells + 1> root_;  // of the absorption, over -log(color)
};

}  // namespace pelage
