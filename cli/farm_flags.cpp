// SPDX-License-Identifier: Apache-2.0
#include "cli/farm_flags.h"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <regex>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

#include "base/error.h"
#include "base/nearest_name.h"
#include "cli/checkpoint_flags.h"
#include "world/frames.h"

namespace pelage {
namespace {

constexpr int kMaxDivisions = 256;
constexpr const char* kActions[] = {"plan", "submit", "status", "cancel"};

/// Reads "4x3". Returns false for other texts.
bool parse_regions(const std::string& text, int& columns, int& rows) {
  const char* end = text.data() + text.size();
  const auto [x, error] = std::from_chars(text.data(), end, columns);
  if (error != std::errc() || x == end || *x != 'x') return false;
  const auto [stop, second] = std::from_chars(x + 1, end, rows);
  const auto fits = [](int count) { return count >= 1 && count <= kMaxDivisions; };
  return second == std::errc() && stop == end && fits(columns) && fits(rows);
}

/// Returns whether sbatch reads `text` as a time limit: minutes, minutes:seconds, hours:minutes:seconds,
/// days-hours, days-hours:minutes, days-hours:minutes:seconds, UNLIMITED or INFINITE.
bool is_slurm_time(const std::string& text) {
  const std::regex form("(\\d+-)?\\d+(:\\d\\d?){0,2}|UNLIMITED|INFINITE", std::regex::icase);
  constexpr size_t kLongest = 32;  // std::regex recurses once per character
  return text.size() <= kLongest && std::regex_match(text, form);
}

}  // namespace

void add_farm_flags(CLI::App& farm, FarmOptions& options, FarmTexts& texts) {
  farm.add_option("ACTION", texts.action,
                  "plan: print the tasks of a shot; submit: submit them to Slurm; status: show, cancel: "
                  "cancel a submitted shot")
      ->required();
  farm.add_option("--regions", texts.regions,
                  "Divide each frame into columns x rows, such as 4x4 (default: one task per frame)")
      ->type_name("COLUMNSxROWS");
  farm.add_option("--dir", options.folder,
                  "Folder for checkpoints, regions and statistics; one per shot (default: farm)")
      ->type_name("DIR");
  farm.add_option("--every", texts.every,
                  "Time between two checkpoints, such as 60s, 5m or 2h (default: 60s)")
      ->type_name("TIME");
  farm.add_flag("--json", options.json, "plan, status: print JSON (default: a command per line, or text)");
  farm.add_option("--partition", options.partition, "submit: partition of Slurm")->type_name("NAME");
  farm.add_option("--time", options.time,
                  "submit: time limit of a task, in minutes or as Slurm reads it; a task that reaches it "
                  "continues later")
      ->type_name("TIME");
  farm.add_option("--sbatch", options.sbatch,
                  "submit: further option of sbatch, such as --sbatch=--qos=low; repeatable")
      ->allow_extra_args(false)
      ->type_name("OPTION");
  farm.add_option("--retries", options.retries,
                  "plan, submit: how often a task that was stopped or killed is started again (default: 9)")
      ->check(CLI::Range(0, 1000))
      ->type_name("N");
  farm.add_flag("--dry-run", options.dry_run, "submit: print the scripts, and submit nothing");
}

void interpret_farm(const FarmTexts& texts, const std::string& output, FarmOptions& options) {
  if (texts.action.empty()) return;  // another command
  const auto action = std::find(std::begin(kActions), std::end(kActions), texts.action);
  if (action == std::end(kActions)) {
    const std::vector<std::string> names(std::begin(kActions), std::end(kActions));
    throw Error(ErrorKind::kArguments,
                "farm: unknown action " + quote(texts.action) + suggest(texts.action, names));
  }
  options.action = static_cast<FarmAction>(action - std::begin(kActions));
  const bool makes = options.action == FarmAction::kPlan || options.action == FarmAction::kSubmit;
  if (makes && output.empty())
    throw Error(ErrorKind::kArguments, "farm " + texts.action + ": -o is required; see 'pelage farm --help'");
  if (options.folder.empty()) throw Error(ErrorKind::kArguments, "--dir: the name of the folder is empty");
  if (has_frame_pattern(options.folder))
    throw Error(ErrorKind::kArguments,
                "--dir " + quote(options.folder) + ": all frames share the folder, without a frame number");
  if (!texts.regions.empty() && !parse_regions(texts.regions, options.columns, options.rows)) {
    throw Error(ErrorKind::kArguments,
                fmt::format("--regions: expected columns and rows such as 4x4, each at most {}, got {}",
                            kMaxDivisions, quote(texts.regions)));
  }
  if (!options.time.empty() && !is_slurm_time(options.time)) {
    throw Error(ErrorKind::kArguments,
                "--time: expected minutes, or a time such as 2:30:00 or 1-12:00, got " + quote(options.time));
  }
  CheckpointOptions checkpoint;
  interpret_checkpoint(texts.every, checkpoint);
  options.every_s = checkpoint.every_s;
}

}  // namespace pelage
