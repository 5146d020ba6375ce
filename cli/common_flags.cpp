// SPDX-License-Identifier: Apache-2.0
#include "cli/common_flags.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "cli/number_checks.h"
#include "groom/strands/curve_basis_names.h"

namespace pelage {

void add_scene_flags(CLI::App& command, Options& options, Texts& texts, const char* scene_help) {
  command.add_option("SCENE", options.input, scene_help)->required();
  // Not greedy: `--set a=1 scene.yaml` must not consume the scene.
  command.add_option("--set", texts.set, "Override a scene value: a.b.c=value; repeatable")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
}

void add_thread_flags(CLI::App& command, Options& options, Texts& texts) {
  command.add_option("--threads", options.threads, "Number of threads (default: all available)")
      ->check(CLI::Range(0, 4096))
      ->type_name("N");
  CLI::Option* quiet = command.add_flag("--quiet", texts.quiet, "Show no progress");
  command.add_option("--progress", texts.progress, "Progress display: bar, plain, json, alfred or tractor")
      ->type_name("STYLE")
      ->excludes(quiet);
}

void add_parallel_flags(CLI::App& command, Options& options, Texts& texts, const char* memory_help) {
  add_thread_flags(command, options, texts);
  command.add_option("--memory", texts.memory, memory_help)->type_name("BYTES");
}

void add_run_flags(CLI::App& command, Options& options, Texts& texts, const char* memory_help) {
  command.add_option("--stats", texts.stats, "Write statistics of this run as JSON")->type_name("FILE.json");
  command
      .add_option("--sample-memory", options.sample_memory_s,
                  "Interval in seconds between memory samples, for the timeline in --stats")
      ->check(number_between(0.001, 3600))
      ->type_name("SECONDS");
  add_parallel_flags(command, options, texts, memory_help);
}

void add_strand_flags(CLI::App& command, Options& options, Texts& texts) {
  command
      .add_option("--basis", texts.basis,
                  "Curve basis of a strand file: " + ValueReader<CurveBasis>::type_name())
      ->type_name("BASIS");
  command.add_option("--default-width", options.default_width, "Strand width if the file has none")
      ->check(positive_number())
      ->type_name("WIDTH");
}

}  // namespace pelage
