// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/run_options.h"

namespace CLI {
class App;
}

namespace pelage {

/// Values of flags that the parser leaves as text until interpret_run() validates them, so that all messages
/// are our own.
struct RunTexts {
  std::string frames, memory, progress, stats, cache_size;
  std::vector<std::string> set;
  bool quiet = false;
  bool no_cache = false;
};

inline constexpr const char* kMemoryHelp = "Memory budget, such as 512M or 4G (sets render.memory)";

/// Adds SCENE and --set.
void add_scene_flags(CLI::App& command, RunOptions& options, RunTexts& texts,
                     const char* scene_help = "Scene file");
/// Adds --allow-scripts, for commands that grow coats.
void add_script_flag(CLI::App& command, RunOptions& options);
/// Adds --threads, --quiet and --progress.
void add_thread_flags(CLI::App& command, RunOptions& options, RunTexts& texts);
/// Adds --memory and the flags of add_thread_flags().
void add_parallel_flags(CLI::App& command, RunOptions& options, RunTexts& texts, const char* memory_help);
/// Adds --stats, --sample-memory and the flags of add_parallel_flags().
void add_run_flags(CLI::App& command, RunOptions& options, RunTexts& texts,
                   const char* memory_help = kMemoryHelp);

/// Adds --no-cache and --cache-size.
void add_cache_flags(CLI::App& command, RunTexts& texts);

/// Reads the texts, and adds the overrides of the flags that set scene values. Throws Error (kArguments).
void interpret_run(const RunTexts& texts, RunOptions& options);

}  // namespace pelage
