// SPDX-License-Identifier: Apache-2.0
#include "cli/checkpoint_flags.h"

#include <charconv>
#include <string_view>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "base/error.h"
#include "base/nearest_name.h"

namespace pelage {
namespace {

constexpr double kShortest_s = 0.1, kLongest_s = 7 * 24 * 3600.0;

/// 0 for a text that is no duration.
double parse_duration(const std::string& text) {
  double number = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc()) return 0;
  const std::string_view unit(stop, static_cast<size_t>(end - stop));
  if (unit.empty() || unit == "s") return number;
  if (unit == "m") return number * 60;
  return unit == "h" ? number * 3600 : 0;
}

}  // namespace

void add_checkpoint_flags(CLI::App& render, CheckpointOptions& checkpoint, std::string& every) {
  CLI::Option* folder =
      render
          .add_option(
              "--checkpoint", checkpoint.folder,
              "Folder for one checkpoint per frame, written from time to time, at SIGUSR1, and when the "
              "render is interrupted")
          ->type_name("DIR");
  render.add_option("--every", every, "Time between two checkpoints, such as 60s, 5m or 2h (default: 60s)")
      ->type_name("TIME")
      ->needs(folder);
  render
      .add_flag("--resume", checkpoint.resume,
                "Continue from the checkpoints, and skip the frames that they say are finished")
      ->needs(folder);
}

void interpret_checkpoint(const std::string& every, CheckpointOptions& checkpoint) {
  if (checkpoint.folder && checkpoint.folder->empty())
    throw Error(ErrorKind::kArguments, "--checkpoint: the name of the folder is empty");
  if (every.empty()) return;
  const double seconds = parse_duration(every);
  if (!(seconds >= kShortest_s && seconds <= kLongest_s))
    throw Error(ErrorKind::kArguments,
                "--every: expected a time from 0.1s to 168h such as 60s, 5m or 2h, got " + quote(every));
  checkpoint.every_s = seconds;
}

}  // namespace pelage
