// SPDX-License-Identifier: Apache-2.0
#include "cli/stats_json.h"

#include <nlohmann/json.hpp>

#include "base/file.h"
#include "base/version.h"

namespace pelage {
namespace {

nlohmann::ordered_json timeline_columns() {
  nlohmann::ordered_json names{"seconds", "rss_anon_bytes", "rss_file_bytes"};
  for (int tag = 0; tag < static_cast<int>(MemoryTag::kCount); ++tag)
    names.push_back(memory_tag_name(static_cast<MemoryTag>(tag)));
  return names;
}

nlohmann::ordered_json timeline_row(const MemorySample& sample) {
  nlohmann::ordered_json row{sample.seconds, sample.resident.anonymous, sample.resident.file};
  for (const int64_t bytes : sample.tags) row.push_back(bytes);
  return row;
}

}  // namespace

std::string statistics_json(const Statistics& s) {
  nlohmann::ordered_json json{
      {"schema", kStatisticsSchema},
      {"version", version()},
      {"wall_s", s.wall_s},
      {"cpu_s", s.cpu_s},
      {"first_pixel_s", s.first_pixel_s},
      {"peak_rss_bytes", s.peak_rss_bytes},
      {"baseline_rss_bytes", s.baseline_rss_bytes},
      {"peak_anonymous_bytes", s.peak_anonymous_bytes},
      {"baseline_anonymous_bytes", s.baseline_anonymous_bytes},
      {"unexplained_bytes", s.unexplained_bytes},
      {"memory_bytes", s.memory_bytes},
      {"working_set_bytes", s.working_set_bytes},
      {"strands_described", s.strands_described},
      {"strands_unique", s.strands_unique},
      {"strands_generated", s.strands_generated},
      {"strands_dropped", s.strands_dropped},
      {"strands_repaired", s.strands_repaired},
      {"characters", s.characters},
      {"characters_in_frame", s.characters_in_frame},
      {"chunks", s.chunks},
      {"chunks_touched", s.chunks_touched},
      {"expansions", s.expansions},
      {"reexpansions", s.reexpansions},
      {"false_expansions", s.false_expansions},
      {"evictions", s.evictions},
      {"chunks_read", s.chunks_read},
      {"chunk_bytes_read", s.chunk_bytes_read},
      {"residency_wait_s", s.residency_wait_s},
      {"bounds_area", s.bounds_area},
      {"part_bounds_area", s.part_bounds_area},
      {"box_tests", s.box_tests},
      {"chunk_visits", s.chunk_visits},
      {"samples_per_pixel", s.samples_per_pixel},
      {"noise", s.noise},
      {"time_limited", s.time_limited},
      {"samples_rejected", s.samples_rejected},
      {"clamped_fraction", s.clamped_fraction},
      {"rays", s.rays},
      {"stages_s", s.stages_s},
  };
  if (!s.timeline.empty()) {
    json["timeline_columns"] = timeline_columns();
    for (const MemorySample& sample : s.timeline) json["timeline"].push_back(timeline_row(sample));
  }
  return json.dump(2) + "\n";
}

void write_statistics(const std::filesystem::path& path, const Statistics& statistics) {
  write_file(path, statistics_json(statistics));
}

}  // namespace pelage
