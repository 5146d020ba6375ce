// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scene/document.h"

namespace pelage {

class GrowthCache;
class OperatorScripts;

struct ViewOptions {
  std::filesystem::path scene;
  std::vector<Override> overrides;
  std::string address = "127.0.0.1";                ///< the address that the server is bound to
  int port = 0;                                     ///< 0: any free port
  int threads = 0;                                  ///< of the render; 0: all available
  std::shared_ptr<const GrowthCache> growth_cache;  ///< SceneDescription::growth_cache
  std::shared_ptr<const OperatorScripts> scripts;   ///< SceneDescription::scripts
};

/// Shows a live picture of a scene to browsers, until `stopped` returns true. `stopped` is called 50 times a
/// second. Calls `ready` with the address of the page once the server answers. Throws the
/// errors of load_scene(), and Error (kFailed) if the port cannot be used.
void run_live_view(const ViewOptions& options, const std::function<void(const std::string& url)>& ready,
                   const std::function<bool()>& stopped);

}  // namespace pelage
