// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "lab/runs/variant.h"

namespace pelage {

std::string runs_json(const std::vector<Outcome>& outcomes) {
  nlohmann::ordered_json runs = nlohmann::ordered_json::array();
  for (const Outcome& outcome : outcomes) {
    for (const VariantRun& run : outcome.runs) {
      nlohmann::ordered_json json{{"variant", outcome.variant.id},
                                  {"command", run.command},
                                  {"exit_code", run.end.exit_code},
                                  {"signal", run.end.signal},
                                  {"interrupted", run.end.interrupted},
                                  {"timed_out", run.end.timed_out},
                                  {"load_average", run.load},
                                  {"wall_s", run.end.wall_s},
                                  {"cpu_s", run.end.cpu_s},
                                  {"peak_rss_bytes", run.end.peak_rss_bytes}};
      if (!run.error.empty()) json["error"] = run.error;
      if (run.statistics) json["statistics"] = nlohmann::ordered_json::parse(run.statistics->json());
      runs.push_back(std::move(json));
    }
  }
  return runs.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace pelage
