// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/rib_flags.h"
#include "groom/cache/growth_cache.h"
#include "scene/document.h"

namespace pelage {

enum class ProgressStyle {
  kAuto,     ///< a bar on a terminal, lines elsewhere
  kBar,      ///< one line that is redrawn continuously, with the time left
  kPlain,    ///< a line from time to time, for logs
  kJson,     ///< a JSON object for each percent of progress
  kAlfred,   ///< "ALF_PROGRESS 7%" for each percent of the run, on standard output
  kTractor,  ///< "TR_PROGRESS 007%" for each percent of the run, on standard output
  kQuiet,    ///< nothing
};

/// Returns the name that --progress has for a style; nothing for kAuto and kQuiet.
std::string progress_name(ProgressStyle style);

/// What the command lines of long runs have in common, in all programs.
struct RunOptions {
  std::string input;  ///< positional argument SCENE, FILE or IN
  /// -o or argument OUT; may contain a placeholder for the frame number (world/frames.h).
  std::string output;
  /// Values of --set, followed by those of flags that set scene values, such as --frames and --memory.
  std::vector<Override> overrides;
  size_t set_count = 0;                   ///< how many of the overrides are values of --set
  std::optional<std::string> stats;       ///< --stats
  std::optional<double> sample_memory_s;  ///< --sample-memory: seconds between samples
  int threads = 0;                        ///< --threads; 0: as many as are available to the process
  ProgressStyle progress = ProgressStyle::kAuto;
  bool cache = false;  ///< whether to use the user's cache of growth: true for commands that have --no-cache,
                       ///< without it
  uint64_t cache_bytes = GrowthCache::kMaxBytes;  ///< --cache-size
  bool allow_scripts = false;                     ///< --allow-scripts
  RibUseOptions rib_in;                           ///< flags for RIB files that the scene reads
};

/// Returns the cache that the flags and the environment choose; null if there is none.
std::shared_ptr<const GrowthCache> growth_cache(const RunOptions& options);

}  // namespace pelage
