// SPDX-License-Identifier: Apache-2.0
//
// Cost of a visit to a resident chunk: with a pin if chunks may be evicted, and without one if nothing is
// ever evicted. The yardstick follows a plain array of pointers. Several threads visit the same few slots.
#include <memory>
#include <vector>

#include "base/hash.h"
#include "base/ledger.h"
#include "bench/yardstick.h"
#include "cache/residency.h"

namespace pelage {
namespace {

constexpr size_t kSlots = 1024;

class Number final : public Resident {
 public:
  explicit Number(uint32_t slot) : value(slot) {}
  uint64_t value;
};

class NumberGrower final : public Grower {
 public:
  size_t reserve_bytes(uint32_t) const override { return sizeof(Number); }
  Grown grow(uint32_t slot) override { return {std::make_unique<Number>(slot), sizeof(Number)}; }
};

uint32_t slot_of(int i) { return static_cast<uint32_t>(hash64(static_cast<uint64_t>(i)) % kSlots); }

double plain_visit() {
  std::vector<std::unique_ptr<Number>> plain;
  for (uint32_t slot = 0; slot < kSlots; ++slot) plain.push_back(std::make_unique<Number>(slot));
  return seconds_per_call([&](int i) { return plain[slot_of(i)]->value; });
}

void visit(benchmark::State& state) {
  MemoryLedger ledger;
  NumberGrower grower;
  const MemoryBudget budget{state.range(0) ? uint64_t(1) << 30 : 0};
  Residency residency(grower, kSlots, 1, budget, ledger, MemoryTag::kChunks);
  int i = 0;
  const auto once = [&] {
    return residency.visit(slot_of(i++), 0, [](Resident& unit) { return static_cast<Number&>(unit).value; });
  };
  while (i < 20 * static_cast<int>(kSlots)) once();
  const RatioTo ratio(state, "x_plain", plain_visit());
  for (auto _ : state) benchmark::DoNotOptimize(once());
}
BENCHMARK(visit)->Name("visit: without (0), with a limit (1)")->Arg(0)->Arg(1);

}  // namespace
}  // namespace pelage

BENCHMARK_MAIN();
