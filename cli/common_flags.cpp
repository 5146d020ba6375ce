// SPDX-License-Identifier: Apache-2.0
#include "cli/common_flags.h"

#include <algorithm>
#include <iterator>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "base/error.h"
#include "base/nearest_name.h"
#include "base/value_readers.h"
#include "cli/command_line.h"
#include "cli/number_checks.h"
#include "world/frames.h"

namespace pelage {
namespace {

constexpr const char* kProgressNames[] = {"auto", "bar", "plain", "json", "alfred", "tractor"};

ProgressStyle parse_progress(const RunTexts& texts) {
  if (texts.quiet) return ProgressStyle::kQuiet;
  if (texts.progress.empty()) return ProgressStyle::kAuto;
  const std::vector<std::string> names(std::begin(kProgressNames), std::end(kProgressNames));
  const auto found = std::find(names.begin(), names.end(), texts.progress);
  if (found == names.end())
    fail_arguments("--progress " + quote(texts.progress) + " is not known" + suggest(texts.progress, names));
  return static_cast<ProgressStyle>(found - names.begin());
}

}  // namespace

void add_scene_flags(CLI::App& command, RunOptions& options, RunTexts& texts, const char* scene_help) {
  command.add_option("SCENE", options.input, scene_help)->required();
  // Not greedy: `--set a=1 scene.yaml` must not consume the scene.
  command.add_option("--set", texts.set, "Override a scene value: a.b.c=value; repeatable")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
}

void add_script_flag(CLI::App& command, RunOptions& options) {
  command.add_flag("--allow-scripts", options.allow_scripts,
                   "Run the Python functions of operators `python`; they may do whatever you may do");
}

void add_thread_flags(CLI::App& command, RunOptions& options, RunTexts& texts) {
  command.add_option("--threads", options.threads, "Number of threads (default: all available)")
      ->check(CLI::Range(0, 4096))
      ->type_name("N");
  CLI::Option* quiet = command.add_flag("--quiet", texts.quiet, "Show no progress");
  command.add_option("--progress", texts.progress, "Progress display: bar, plain, json, alfred or tractor")
      ->type_name("STYLE")
      ->excludes(quiet);
}

void add_parallel_flags(CLI::App& command, RunOptions& options, RunTexts& texts, const char* memory_help) {
  add_thread_flags(command, options, texts);
  command.add_option("--memory", texts.memory, memory_help)->type_name("BYTES");
}

void add_run_flags(CLI::App& command, RunOptions& options, RunTexts& texts, const char* memory_help) {
  command.add_option("--stats", texts.stats, "Write statistics of this run as JSON")->type_name("FILE.json");
  command
      .add_option("--sample-memory", options.sample_memory_s,
                  "Interval in seconds between memory samples, for the timeline in --stats")
      ->check(number_between(0.001, 3600))
      ->type_name("SECONDS");
  add_parallel_flags(command, options, texts, memory_help);
}

void add_cache_flags(CLI::App& command, RunTexts& texts) {
  CLI::Option* none =
      command.add_flag("--no-cache", texts.no_cache, "Neither read nor write the user's cache of growth");
  command
      .add_option("--cache-size", texts.cache_size,
                  "Max size of the user's cache of growth, such as 500M (default: 2G)")
      ->type_name("BYTES")
      ->excludes(none);
}

std::shared_ptr<const GrowthCache> growth_cache(const RunOptions& options) {
  const std::filesystem::path folder =
      options.cache ? GrowthCache::folder_of_user() : std::filesystem::path();
  return folder.empty() ? nullptr : std::make_shared<const GrowthCache>(folder, options.cache_bytes);
}

void interpret_run(const RunTexts& texts, RunOptions& options) {
  for (const std::string& text : texts.set) options.overrides.push_back(parse_override(text));
  options.set_count = options.overrides.size();
  if (!texts.memory.empty()) {
    if (!parse_bytes(texts.memory))
      fail_arguments("--memory: expected bytes such as 512M or 4G, got " + quote(texts.memory));
    options.overrides.push_back({"render.memory", texts.memory});
  }
  if (!texts.frames.empty()) {
    parse_frames(texts.frames);  // throws here, where the flag can be named
    options.overrides.push_back({"frames", "'" + texts.frames + "'"});
  }
  if (!texts.stats.empty()) options.stats = texts.stats;
  if (!texts.cache_size.empty()) {
    const std::optional<uint64_t> bytes = parse_bytes(texts.cache_size);
    if (!bytes)
      fail_arguments("--cache-size: expected bytes such as 500M or 2G, got " + quote(texts.cache_size));
    options.cache_bytes = *bytes;
  }
  options.progress = parse_progress(texts);
}

std::string progress_name(ProgressStyle style) {
  const bool named = style != ProgressStyle::kAuto && style != ProgressStyle::kQuiet;
  return named ? kProgressNames[static_cast<size_t>(style)] : "";
}

}  // namespace pelage
