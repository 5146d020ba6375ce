// SPDX-License-Identifier: Apache-2.0
#include "cli/render_estimate.h"

#include <algorithm>
#include <iostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/counted.h"
#include "base/memory_budget.h"
#include "base/process_usage.h"
#include "world/compose.h"
#include "world/world.h"

namespace pelage {
namespace {

void print_estimate(const RunEstimate& estimate, int threads) {
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

nlohmann::ordered_json run_json(const RunEstimate& estimate, size_t i) {
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

int64_t RunEstimate::peak_bytes() const {
  int64_t peak = 0;
  for (const FrameEstimate& e : estimates) peak = std::max(peak, e.peak_bytes());
  return peak;
}

double RunEstimate::cpu_s() const {
  double sum = loading_cpu_s + posing_cpu_s;
  for (const FrameEstimate& e : estimates) sum += e.cpu_s();
  return sum;
}

double RunEstimate::cpu_s(size_t i) const {
  return loading_cpu_s + posing_cpu_s / static_cast<double>(std::max<size_t>(1, frames.size())) +
         estimates[i].cpu_s();
}

RunEstimate estimate_run(const SceneDescription& scene, const std::vector<int>& frames,
                         const std::optional<PixelBox>& region, Run& run) {
  RunEstimate estimate;
  const double began = cpu_seconds();
  MemoryCharge film = reserve_film(scene, run.job(), region);
  const auto assets = run.stage("read", [&] { return load_assets(scene, run.job()); });
  film = {};  // estimate_frame() counts it
  estimate.loading_cpu_s = cpu_seconds() - began;
  for (const int frame : frames) {
    const double posing = cpu_seconds();
    const World world = run.stage("pose", [&] { return compose(scene, *assets, frame, run.job()); });
    estimate.posing_cpu_s += cpu_seconds() - posing;
    estimate.frames.push_back(frame);
    estimate.estimates.push_back(
        run.stage("estimate", [&] { return estimate_frame(world.scene, run.job(), region); }));
  }
  return estimate;
}

int print_estimate(const SceneDescription& scene, const Options& options, Run& run) {
  const RunEstimate estimate = estimate_run(scene, scene.frames.frames, options.picture.region, run);
  const int threads = run.workers().thread_count();
  if (options.json) {
    nlohmann::ordered_json json{{"estimate", 1},
                                {"threads", threads},
                                {"peak_bytes", estimate.peak_bytes()},
                                {"cpu_s", estimate.cpu_s()}};
    for (size_t i = 0; i < estimate.frames.size(); ++i) json["frames"].push_back(run_json(estimate, i));
    std::cout << json.dump(2) << "\n";
  } else {
    print_estimate(estimate, threads);
  }
  return 0;
}

}  // namespace pelage
