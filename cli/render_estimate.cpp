// SPDX-License-Identifier: Apache-2.0
#include "cli/render_estimate.h"

#include <iostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/counted.h"
#include "base/memory_budget.h"
#include "world/run_estimate.h"

namespace pelage {
namespace {

void print_text(const RunEstimate& estimate, int threads) {
  for (size_t i = 0; i < estimate.frames.size(); ++i) {
    const FrameEstimate& e = estimate.estimates[i];
    const auto part_if_any = [](const char* name, int64_t bytes) {
      return bytes > 0 ? fmt::format(", {} {}", name, memory_text(bytes)) : "";
    };
    std::cout << fmt::format(
        "frame {}: {} of memory: scene {}, frame buffer {}, boxes {}, fur and skins {}{}, "
        "libraries {}{}{}\n",
        estimate.frames[i], memory_text(e.peak_bytes()), memory_text(e.scene_bytes),
        memory_text(e.film_bytes), memory_text(e.box_bytes), memory_text(e.chunk_bytes),
        e.fits ? "" : " (limited by render.memory)", memory_text(e.library_bytes),
        part_if_any("sample buffers", e.buffer_bytes), part_if_any("shadows", e.shadows.held_bytes));
    const double cpu_s = estimate.cpu_s(i);
    std::cout << fmt::format("frame {}: about {} of CPU time, {} on {}; {}, {}\n", estimate.frames[i],
                             duration_text(cpu_s), duration_text(cpu_s / threads), counted(threads, "thread"),
                             counted(e.chunks, "chunk"), counted(e.strands, "strand"));
  }
}

nlohmann::ordered_json json_of(const RunEstimate& estimate, size_t i) {
  const FrameEstimate& e = estimate.estimates[i];
  return {{"frame", estimate.frames[i]},
          {"peak_bytes", e.peak_bytes()},
          {"cpu_s", estimate.cpu_s(i)},
          {"bytes",
           {{"scene", e.scene_bytes},
            {"preparing", e.preparing_bytes},
            {"libraries", e.library_bytes},
            {"film", e.film_bytes},
            {"boxes", e.box_bytes},
            {"measuring", e.measuring_bytes},
            {"buffers", e.buffer_bytes},
            {"shadows", e.shadows.held_bytes},
            {"balls", e.shadows.making_bytes},
            {"chunks", e.chunk_bytes},
            {"writing", e.writing_bytes}}},
          {"cpu_s_by",
           {{"measuring", e.measuring_cpu_s},
            {"growth", e.growing_cpu_s},
            {"shadows", e.shadows.cpu_s},
            {"tracing", e.tracing_cpu_s},
            {"writing", e.writing_cpu_s}}},
          {"fits", e.fits},
          {"chunks", e.chunks},
          {"strands", e.strands}};
}

}  // namespace

int print_estimate(const SceneDescription& scene, const Options& options, Run& run) {
  const RunEstimate estimate = estimate_run(scene, scene.frames.frames, options.picture.region, run.job());
  const int threads = run.workers().thread_count();
  if (options.json) {
    nlohmann::ordered_json json{{"estimate", 1},
                                {"threads", threads},
                                {"peak_bytes", estimate.peak_bytes()},
                                {"cpu_s", estimate.cpu_s()}};
    for (size_t i = 0; i < estimate.frames.size(); ++i) json["frames"].push_back(json_of(estimate, i));
    std::cout << json.dump(2) << "\n";
  } else {
    print_text(estimate, threads);
  }
  return 0;
}

}  // namespace pelage
