// SPDX-License-Identifier: Apache-2.0
#include "view/run_view.h"

#include <chrono>
#include <thread>

#include "view/live_renderer.h"
#include "view/scene_follower.h"
#include "view/view_server.h"

namespace pelage {

void run_live_view(const ViewOptions& options, const std::function<void(const std::string&)>& ready,
                   const std::function<bool()>& stopped) {
  ViewState state;
  const bool is_local = options.address == ViewOptions{}.address;
  const SceneCommands commands(options.scene, options.overrides, state, is_local);
  const ViewServer server(state, commands, options.address, options.port);
  LiveRenderer renderer(state, options.threads);
  const SceneFollower follower(options.scene, options.overrides, renderer, state, options.growth_cache,
                               options.scripts);
  ready(server.url());
  while (!stopped()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

}  // namespace pelage
