// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

#include "groom/operators/clump.h"
#include "groom/operators/comb.h"
#include "groom/operators/frizz.h"
#include "groom/operators/length.h"
#include "groom/operators/operator_list.h"
#include "groom/operators/width.h"

namespace pelage::stacks {

/// Adds an operator to a list, as the scene reader does.
template <class Op>
void add(OperatorList& list, typename Op::Params params) {
  OperatorList::Item& item = list.items.emplace_back();
  item.name = Op::kName;
  item.prototype = std::make_shared<Op>(std::move(params));
  item.clone = [](const Operator& prototype) -> std::unique_ptr<Operator> {
    return std::make_unique<Op>(static_cast<const Op&>(prototype));
  };
}

/// length + comb + clump + frizz + width, for skins about 20 units wide.
inline OperatorList usual() {
  OperatorList list;
  add<Length>(list, {.value = Field(1.2f), .scale = Field(1.0f), .variation = 0.3f});
  add<Comb>(list,
            {.direction = Field(Rgb(0, -0.3f, -1)), .lift = Field(0.35f), .amount = Field(1.0f), .curve = 0});
  ClumpParams clump;
  clump.spacing = 0.4f;
  clump.amount = Field(0.6f);
  add<Clump>(list, clump);
  add<Frizz>(list, {.amplitude = Field(0.02f), .frequency = Field(3.0f)});
  add<Width>(list, {.root = Field(0.008f), .tip = Field(0.001f), .profile = 1, .variation = 0});
  return list;
}

}  // namespace pelage::stacks
