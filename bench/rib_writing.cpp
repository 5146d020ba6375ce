// SPDX-License-Identifier: Apache-2.0
// Writing strands as RIB. The yardstick is copying their points.
#include <benchmark/benchmark.h>

#include "bench/yardstick.h"
#include "rib/syntax/rib_curves.h"
#include "tests/geom/random_strands.h"

namespace pelage {
namespace {

const Strands& fur() {
  static const Strands strands = random_strands(
      1,
      {.strands = 8000, .min_points = 8, .max_points = 8, .step = 0.1f, .wander = 0.15f, .radius = 0.002f});
  return strands;
}

class NoSink final : public RibSink {
 public:
  void write(std::string_view text) override { bytes += text.size(); }
  size_t bytes = 0;
};

void write_rib(benchmark::State& state, RibEncoding encoding) {
  const double copying = seconds_per_call(
      [](int) {
        const auto points = fur().points();
        return std::vector<float>(points.begin(), points.end());
      },
      20);
  NoSink sink;
  {
    RibWriter rib(sink, encoding);
    const RatioTo ratio(state, "x_copy", copying);
    for (auto _ : state) {
      write_curves(rib, fur(), {});
      rib.flush();
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(fur().strand_count()));
  state.counters["bytes_per_strand"] = static_cast<double>(sink.bytes) /
                                       static_cast<double>(state.iterations()) /
                                       static_cast<double>(fur().strand_count());
}

BENCHMARK_CAPTURE(write_rib, binary, RibEncoding::kBinary);
BENCHMARK_CAPTURE(write_rib, ascii, RibEncoding::kAscii);

}  // namespace
}  // namespace pelage

BENCHMARK_MAIN();
