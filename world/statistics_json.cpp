// SPDX-License-Identifier: Apache-2.0
#include "world/statistics_json.h"

#include <algorithm>

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

// Nothing where no frame was traced.
nlohmann::ordered_json rays_json(const RayStatistics& rays) {
  if (rays.total() == 0) return nlohmann::ordered_json::object();
  return {{"camera", rays.camera}, {"indirect", rays.indirect}, {"shadow", rays.shadow}};
}

// The parts of cpu_s. Nothing where no frame was traced.
nlohmann::ordered_json cpu_json(const Statistics& s) {
  if (s.frames.rays.total() == 0) return nlohmann::ordered_json::object();
  const RenderSeconds& tiles = s.frames.cpu_s;
  const double growth_s = s.frames.residency.cpu_s;
  return {{"camera_rays", tiles.camera_rays},
          {"indirect_rays", tiles.indirect_rays},
          {"shadow_rays", tiles.shadow_rays},
          {"shading", tiles.shading},
          {"growth", growth_s},
          {"other", std::max(0.0, s.process.cpu_s - tiles.total() - growth_s)}};
}

std::map<std::string, double> stages_json(const Statistics& s) {
  std::map<std::string, double> stages_s = s.stages_s;
  for (const auto& [stage, seconds] : s.frames.stages_s) stages_s[stage] += seconds;
  return stages_s;
}

}  // namespace

std::string statistics_json(const Statistics& s) {
  nlohmann::ordered_json json{
      {"schema", kStatisticsSchema},
      {"version", version()},
      {"wall_s", s.process.wall_s},
      {"cpu_s", s.process.cpu_s},
      {"cpu_s_by", cpu_json(s)},
      {"first_pixel_s", s.first_pixel_s},
      {"peak_rss_bytes", s.process.peak_rss_bytes},
      {"baseline_rss_bytes", s.process.baseline_rss_bytes},
      {"peak_anonymous_bytes", s.process.peak_anonymous_bytes},
      {"baseline_anonymous_bytes", s.process.baseline_anonymous_bytes},
      {"unexplained_bytes", s.process.unexplained_bytes},
      {"memory_bytes", s.process.memory_bytes},
      {"working_set_bytes", s.frames.residency.working_set_bytes},
      {"strands_described", s.world.strands_described},
      {"strands_unique", s.world.strands_unique},
      {"strands_generated", s.frames.growth.strands},
      {"strands_dropped", s.repairs.dropped},
      {"strands_repaired", s.repairs.repaired},
      {"characters", s.world.characters},
      {"characters_in_frame", s.world.characters_in_frame},
      {"chunks", s.frames.growth.chunks},
      {"chunks_touched", s.frames.residency.touched},
      {"expansions", s.frames.residency.expansions},
      {"reexpansions", s.frames.residency.reexpansions},
      {"false_expansions", s.frames.residency.false_expansions},
      {"evictions", s.frames.residency.evictions},
      {"chunks_read", s.frames.reads.chunks},
      {"chunk_bytes_read", s.frames.reads.bytes},
      {"residency_wait_s", s.frames.residency.waited_s},
      {"bounds_area", s.frames.growth.area.chunks},
      {"part_bounds_area", s.frames.growth.area.parts},
      {"box_tests", s.frames.trace.box_tests},
      {"chunk_visits", s.frames.trace.chunk_visits},
      {"samples_per_pixel", s.samples_per_pixel},
      {"noise", s.noise},
      {"time_limited", s.time_limited},
      {"samples_rejected", s.frames.samples_rejected},
      {"indirect", s.dual ? "dual" : "path"},
      {"clamped_fraction", s.clamped_fraction},
      {"gather_points", s.frames.gather_points.count},
      {"gather_point_samples", s.frames.gather_points.samples},
      {"reflection_cells", s.frames.reflections.cells},
      {"reflection_paths", s.frames.reflections.paths},
      {"reflection_slices", s.frames.reflections.slices},
      {"reflection_bytes", s.frames.reflections.bytes},
      {"reflection_lookups", s.frames.reflections.lookups},
      {"reflections_found", s.frames.reflections.found},
      {"rays", rays_json(s.frames.rays)},
      {"shadow_candidates", s.frames.occlusion.candidates},
      {"shadow_candidates_proved", s.frames.occlusion.candidates_proved},
      {"rays_skipped_skin", s.frames.occlusion.rays_proved},
      {"stages_s", stages_json(s)},
  };
  if (!s.process.timeline.empty()) {
    json["timeline_columns"] = timeline_columns();
    for (const MemorySample& sample : s.process.timeline) json["timeline"].push_back(timeline_row(sample));
  }
  return json.dump(2) + "\n";
}

void write_statistics(const std::filesystem::path& path, const Statistics& statistics) {
  write_file(path, statistics_json(statistics));
}

}  // namespace pelage
