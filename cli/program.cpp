// SPDX-License-Identifier: Apache-2.0
#include "cli/program.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>

#include <unistd.h>

#include "base/heap.h"
#include "cli/report_error.h"
#include "cli/signals.h"
#include "cli/standard_output.h"

namespace pelage {
namespace {

int run_command_line(const std::vector<std::string>& arguments,
                     const std::function<int(const std::vector<std::string>&)>& run) {
  try {
    return run(arguments);
  } catch (const Error& error) {
    std::fputs(error_text(error).c_str(), stderr);
    return exit_code(error.kind());
  } catch (const std::bad_alloc&) {
    std::fputs("pelage: error: out of memory\n", stderr);
    return exit_code(ErrorKind::kMemory);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "pelage: error: %s\n", error.what());
    return exit_code(ErrorKind::kFailed);
  }
}

// Output that could not be written is a failure too. A reader that stops early (head) is not.
int after_output(int code, int failure) {
  if (failure == 0 || code != 0) return code;
  if (failure != EPIPE)
    std::fprintf(stderr, "pelage: error: cannot write to standard output: %s\n", std::strerror(failure));
  return exit_code(ErrorKind::kFailed);
}

}  // namespace

int run_program(int argc, char** argv, const std::function<int(const std::vector<std::string>&)>& run) {
  prepare_process();
  keep_heap_small();
  StandardOutput output(STDOUT_FILENO);
  const int code = run_command_line({argv + 1, argv + argc}, run);
  return after_output(code, output.finish());
}

}  // namespace pelage
