// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/options.h"
#include "cli/post_flags.h"

namespace CLI {
class App;
}

namespace pelage {

/// Values of flags that the parser leaves as text until parse_options() validates them, so that all messages
/// are our own.
struct Texts {
  std::string frames, memory, progress, basis, stats, experiment;
  std::vector<std::string> set;
  std::vector<std::string> section;  // its words
  bool quiet = false;
  PostTexts post;
  PictureTexts picture;
  std::string checkpoint_every;
  FarmTexts farm;
};

inline constexpr const char* kMemoryHelp = "Memory budget, such as 512M or 4G (sets render.memory)";

/// Adds SCENE and --set.
void add_scene_flags(CLI::App& command, Options& options, Texts& texts,
                     const char* scene_help = "Scene file");
/// Adds --threads, --quiet and --progress.
void add_thread_flags(CLI::App& command, Options& options, Texts& texts);
/// Adds --memory and the flags of add_thread_flags().
void add_parallel_flags(CLI::App& command, Options& options, Texts& texts, const char* memory_help);
/// Adds --stats, --sample-memory and the flags of add_parallel_flags().
void add_run_flags(CLI::App& command, Options& options, Texts& texts, const char* memory_help = kMemoryHelp);
/// Adds --basis and --default-width, for strand files.
void add_strand_flags(CLI::App& command, Options& options, Texts& texts);

}  // namespace pelage
