// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/memory_sample.h"

namespace pelage {

/// Numbers of one run, written by `--stats`. A value: each room fills its part and passes it on; there is no
/// global registry. Counts are totals of the whole run, over all frames.
struct Statistics {
  double wall_s = 0;
  double first_pixel_s = 0;  ///< from the start of the run until the first tile of the first frame was done
  double cpu_s = 0;
  int64_t peak_rss_bytes = 0;
  int64_t baseline_rss_bytes = 0;        ///< resident set when the command line had been parsed
  int64_t peak_anonymous_bytes = 0;      ///< highest resident anonymous pages that sampling met
  int64_t baseline_anonymous_bytes = 0;  ///< those when the command line had been parsed
  int64_t unexplained_bytes = 0;    ///< peak - baseline of these - all ledger tags at that moment (law 5)
  int64_t working_set_bytes = 0;    ///< all distinct chunks touched
  int64_t strands_described = 0;    ///< all in the scene, before LOD
  int64_t strands_unique = 0;       ///< the same, geometry shared by identical poses counted once
  int64_t strands_generated = 0;    ///< grown for use, regrowth included
  int64_t characters = 0;           ///< those with a coat
  int64_t characters_in_frame = 0;  ///< of these, those that the camera may see
  int64_t chunks = 0;               ///< leaves of coats and skins that could be grown
  int64_t chunks_touched = 0;       ///< those that were
  int64_t expansions = 0;           ///< growths of a chunk for use, regrowth included
  int64_t reexpansions = 0;         ///< those after an eviction
  int64_t false_expansions = 0;     ///< chunks grown that were the answer to no ray
  int64_t evictions = 0;
  int64_t chunks_read = 0;       ///< expansions that were read from render.bvh.file
  int64_t chunk_bytes_read = 0;  ///< by these
  double residency_wait_s = 0;   ///< thread seconds spent waiting for a chunk or for memory
  double bounds_area = 0;        ///< sum of the surface areas of the boxes of all leaves of coats
  double part_bounds_area = 0;   ///< the same of the boxes of their parts, which rays are tested against
  int64_t box_tests = 0;         ///< rays against boxes above the chunks
  int64_t chunk_visits = 0;      ///< rays against what a chunk holds
  double samples_per_pixel = 0;  ///< mean over all pixels of all frames
  double noise = 0;           ///< of the noisiest frame: see frame_noise(); 0 where the film keeps no moments
  bool time_limited = false;  ///< some frame ran into render.time_limit
  int64_t samples_rejected = 0;  ///< camera samples that were not finite; more than zero is a bug
  double clamped_fraction = 0;   ///< of indirect light, by render.clamp_indirect: the highest of all frames
  int64_t strands_dropped = 0;   ///< degenerate strands of files that could not be repaired
  int64_t strands_repaired = 0;
  std::map<std::string, int64_t> rays;          ///< by kind: camera, shadow, indirect
  std::map<std::string, int64_t> memory_bytes;  ///< peak by ledger tag
  std::map<std::string, double> stages_s;       ///< wall seconds by stage
  std::vector<MemorySample> timeline;           ///< memory over time, where asked for
};

/// Resident set of this process, now and at its highest, in bytes; user + system CPU seconds so far.
int64_t current_rss_bytes();
int64_t peak_rss_bytes();
double cpu_seconds();

}  // namespace pelage
