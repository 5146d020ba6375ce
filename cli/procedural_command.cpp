// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <iostream>
#include <string>

#include "base/visible_text.h"
#include "cli/commands.h"
#include "rib/host/program_replies.h"

namespace pelage {
namespace {

class OutputSink final : public RibSink {
 public:
  void write(std::string_view bytes) override {
    std::cout.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
};

}  // namespace

int run_procedural(const Options& options) {
  ProgramReplies replies(options.rib.command);
  OutputSink output;
  for (std::string request; read_program_request(std::cin, request);) {
    const std::string error = replies.reply(request, output);
    std::cout.flush();
    if (!error.empty()) std::fprintf(stderr, "pelage: error: %s\n", visible(error).c_str());
    if (!std::cout) break;
  }
  return 0;
}

}  // namespace pelage
