// SPDX-License-Identifier: Apache-2.0
// Cost of reading strands from a binary RIB file. The yardstick is reading the bytes of the file in one
// piece.
#include "rib/scene/rib_reading.h"

#include <bit>
#include <cstdint>
#include <filesystem>

#include <benchmark/benchmark.h>

#include "base/file.h"
#include "base/temporary_folder.h"
#include "bench/yardstick.h"

namespace pelage {
namespace {

constexpr int kStrands = 100'000, kPerRequest = 1000, kPoints = 10;

void append(std::string& to, float value) {
  const auto bits = std::bit_cast<uint32_t>(value);
  for (int shift = 24; shift >= 0; shift -= 8) to += static_cast<char>(bits >> shift & 0xff);
}

void append_count(std::string& to, uint32_t count) {
  to += '\xcb';
  for (int shift = 24; shift >= 0; shift -= 8) to += static_cast<char>(count >> shift & 0xff);
}

// Strands of 8 points with phantom points and widths, as `pelage rib` writes them.
std::string strands_in_rib() {
  std::string rib = "Basis \"b-spline\" 1 \"b-spline\" 1\n";
  for (int request = 0; request < kStrands / kPerRequest; ++request) {
    rib += "Curves \"cubic\" [";
    for (int i = 0; i < kPerRequest; ++i) rib += "\x80\x0a";
    rib += "] \"nonperiodic\" \"P\" ";
    append_count(rib, 3 * kPerRequest * kPoints);
    for (int i = 0; i < kPerRequest; ++i) {
      const auto x = static_cast<float>(i), z = static_cast<float>(request);
      for (int p = -1; p < kPoints - 1; ++p) {
        for (const float c : {x, static_cast<float>(p), z}) append(rib, c);
      }
    }
    rib += "\"varying float width\" ";
    append_count(rib, kPerRequest * (kPoints - 2));
    for (int i = 0; i < kPerRequest * (kPoints - 2); ++i) append(rib, 0.01f);
  }
  return rib;
}

void read_binary_rib(benchmark::State& state) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.rib";
  write_file(path, strands_in_rib());
  {
    const RatioTo ratio(state, "x_read_file",
                        seconds_per_call([&](int) { return read_file(path).size(); }, 5));
    for (auto _ : state) benchmark::DoNotOptimize(read_rib(path, {}).coats.size());
  }
  state.SetItemsProcessed(state.iterations() * kStrands);
}
BENCHMARK(read_binary_rib)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pelage
