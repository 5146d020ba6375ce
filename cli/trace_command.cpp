// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "cli/commands.h"
#include "cli/read_scene.h"
#include "cli/run.h"
#include "lab/rays/lab_tracer.h"
#include "world/compose.h"

namespace pelage {
namespace {

nlohmann::ordered_json json_of(const LabCost& cost) {
  return {{"wall_s", cost.wall_s},
          {"cpu_s", cost.cpu_s},
          {"rays", cost.rays},
          {"hits", cost.hits},
          {"answers", cost.answers},
          {"box_tests", cost.box_tests},
          {"segment_tests", cost.segment_tests},
          {"page_faults", cost.page_faults},
          {"bytes_read", cost.bytes_read}};
}

void write_result(const std::string& path, const LabResult& result, const Run& run) {
  nlohmann::ordered_json json{{"wall_s", run.seconds()},
                              {"cpu_s", cpu_seconds()},
                              {"peak_rss_bytes", peak_rss_bytes()},
                              {"segments", result.segments},
                              {"bytes", result.bytes},
                              {"resident_bytes", result.resident_bytes},
                              {"limit_bytes", result.limit_bytes},
                              {"build_cpu_s", result.build_cpu_s}};
  for (const auto& [kind, cost] : result.rays) json["kinds"][kind] = json_of(cost);
  write_file(path, json.dump(2) + "\n");
}

}  // namespace

int run_trace(const Options& options) {
  Run run(options);
  const LabVariant variant{LabVariant::parse(options.trace_variant), options.trace_share,
                           options.trace_kinds};
  const ContentStore store(options.output);
  LabResult result;
  if (variant.kind == LabVariant::Kind::kPrepare) {
    const SceneDescription scene = read_scene(options, run.display());
    const auto assets = run.stage("read", [&] { return load_assets(scene, run.job()); });
    const World world = compose(scene, *assets, scene.frames.frames.front(), run.job());
    result = prepare_lab(world.scene, store, static_cast<size_t>(options.rays), run.job());
  } else {
    result = trace_lab_rays(variant, store, run.job());
  }
  if (run.display().cancelled()) return SignalGuard::exit_code();
  if (options.stats) write_result(*options.stats, result, run);
  return 0;
}

}  // namespace pelage
