// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/hash.h"
#include "groom/operators/bend.h"
#include "groom/operators/curl.h"
#include "groom/operators/noise.h"
#include "groom/operators/push_out.h"
#include "tests/groom/stacks.h"

namespace pelage::stacks {

/// Length, a few operators of any kind in any order, and width, for skins about `size` wide.
inline OperatorList random(uint64_t seed, float size, bool with_push_out) {
  uint64_t draw = 0;
  const auto between = [&](float low, float high) {
    return low + (high - low) * unit_float(hash64(seed, draw++, random_use("random stack")));
  };
  const auto field = [&](float low, float high) { return Field(between(low, high)); };
  const auto direction = [&] {
    const float x = between(-1, 1), y = between(-1, 1);
    return Field(Rgb(x, y, between(-1, 1)));
  };
  OperatorList list;
  add<Length>(list, {.value = field(0.02f * size, 0.2f * size), .variation = between(0, 0.8f)});
  for (int i = 0; i < 4; ++i) {
    switch (static_cast<int>(between(0, 5.999f))) {
      case 0:
        add<Comb>(
            list,
            {.direction = direction(), .lift = field(0, 1), .amount = field(0, 1), .curve = between(0, 1)});
        break;
      case 1:
        add<Bend>(list, {.direction = direction(), .angle = field(0, 150), .profile = between(0.5f, 2)});
        break;
      case 2: {
        ClumpParams clump;
        clump.spacing = between(0.02f, 0.2f) * size;
        clump.amount = field(0, 1);
        clump.strays = between(0, 0.2f);
        add<Clump>(list, clump);
        break;
      }
      case 3:
        add<Curl>(list, {.radius = field(0, 0.03f * size), .turns = field(-4, 4)});
        break;
      case 4:
        add<Frizz>(list, {.amplitude = field(0, 0.02f * size), .frequency = field(0, 8)});
        break;
      default:
        add<Noise>(list, {.amplitude = field(0, 0.04f * size), .frequency = between(0, 10) / size});
    }
  }
  if (with_push_out) add<PushOut>(list, {.offset = field(0, 0.01f * size)});
  add<Width>(list, {.root = field(0, 0.01f * size), .tip = field(0, 0.005f * size)});
  return list;
}

}  // namespace pelage::stacks
