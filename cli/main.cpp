// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <new>

#include <unistd.h>

#include "base/heap.h"
#include "cli/commands.h"
#include "cli/report_error.h"
#include "cli/signals.h"
#include "cli/standard_output.h"

namespace {

int run(const pelage::Options& options) {
  using pelage::Command;
  switch (options.command) {
    case Command::kRender:
      return pelage::run_render(options);
    case Command::kGrow:
      return pelage::run_grow(options);
    case Command::kMeasure:
      return pelage::run_measure(options);
    case Command::kCompare:
      return pelage::run_compare(options);
    case Command::kInfo:
      return pelage::run_info(options);
    case Command::kFarm:
      return pelage::run_farm(options);
    case Command::kMerge:
      return pelage::run_merge(options);
    case Command::kConvert:
      return pelage::run_convert(options);
    case Command::kMotionBlur:
      return pelage::run_motion_blur(options);
    case Command::kStereo:
      return pelage::run_stereo(options);
    case Command::kRib:
      return pelage::run_rib(options);
    case Command::kProcedural:
      return pelage::run_procedural(options);
    case Command::kView:
      return pelage::run_view(options);
    case Command::kWhy:
      return pelage::run_why(options);
    case Command::kManual:
      return pelage::run_manual(options);
  }
  return 2;
}

int run_command_line(int argc, char** argv) {
  try {
    const auto options = pelage::parse_options(std::vector<std::string>(argv + 1, argv + argc), std::cout);
    return options ? run(*options) : 0;
  } catch (const pelage::Error& error) {
    std::fputs(pelage::error_text(error).c_str(), stderr);
    return pelage::exit_code(error.kind());
  } catch (const std::bad_alloc&) {
    std::fputs("pelage: error: out of memory\n", stderr);
    return pelage::exit_code(pelage::ErrorKind::kMemory);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "pelage: error: %s\n", error.what());
    return pelage::exit_code(pelage::ErrorKind::kFailed);
  }
}

// Output that could not be written is a failure too. A reader that stops early (head) is not.
int after_output(int code, int failure) {
  if (failure == 0 || code != 0) return code;
  if (failure != EPIPE)
    std::fprintf(stderr, "pelage: error: cannot write to standard output: %s\n", std::strerror(failure));
  return pelage::exit_code(pelage::ErrorKind::kFailed);
}

}  // namespace

int main(int argc, char** argv) {
  pelage::prepare_process();
  pelage::keep_heap_small();
  pelage::StandardOutput output(STDOUT_FILENO);
  const int code = run_command_line(argc, argv);
  return after_output(code, output.finish());
}
