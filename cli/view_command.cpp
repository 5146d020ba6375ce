// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <iostream>

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/signals.h"
#include "groom/operators/operator_scripts.h"
#include "view/run_view.h"

namespace pelage {

int run_view(const Options& options) {
  const SignalGuard signals("\n");
  ViewOptions view;
  view.scene = options.input;
  view.overrides = options.overrides;
  view.threads = options.threads;
  view.growth_cache = growth_cache(options);
  if (options.allow_scripts) view.scripts = python_scripts();
  view.port = options.port;
  if (!options.bind.empty()) view.address = options.bind;
  if (view.address != "127.0.0.1") {
    std::fputs(
        fmt::format("pelage: --bind {}: everybody who can reach this address and knows the token can see "
                    "the picture, and its messages with names of files, and can move its camera; nothing is "
                    "encrypted\n",
                    view.address)
            .c_str(),
        stderr);
  }
  run_live_view(
      view, [](const std::string& url) { std::cout << url << std::endl; }, &SignalGuard::interrupted);
  return 0;  // Ctrl-C is how a view ends
}

}  // namespace pelage
