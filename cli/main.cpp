// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <iostream>
#include <new>

#include "base/heap.h"
#include "cli/commands.h"
#include "cli/report_error.h"

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
    case Command::kTrace:
      return pelage::run_trace(options);
    case Command::kCompare:
      return pelage::run_compare(options);
    case Command::kInfo:
      return pelage::run_info(options);
    case Command::kConvert:
      return pelage::run_convert(options);
    case Command::kMotionBlur:
      return pelage::run_motion_blur(options);
    case Command::kStereo:
      return pelage::run_stereo(options);
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
    std::fputs("pelage: error: the machine has no memory left\n", stderr);
    return pelage::exit_code(pelage::ErrorKind::kMemory);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "pelage: error: %s\n", error.what());
    return pelage::exit_code(pelage::ErrorKind::kFailed);
  }
}

}  // namespace

int main(int argc, char** argv) {
  pelage::keep_heap_small();
  const int code = run_command_line(argc, argv);
  // What was printed but did not arrive (a full disk) is a failure too.
  if (code == 0 && (!std::cout.flush() || std::fflush(stdout) != 0)) return 1;
  return code;
}
