// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "view/requests.h"
#include "view/scene_commands.h"
#include "view/view_state.h"

namespace pelage {

/// The web server of `pelage view`. It answers requests for the files of the page, state.json, picture.exr
/// and layer.bin?name=LAYER, and reads no other files. Its threads only read what a ViewState holds, and pass
/// commands on.
class ViewServer {
 public:
  /// Begins to answer at an address. `port`: 0 chooses a free one. The state and the
  /// commands must outlive the server. Throws Error (kFailed) when the address or the port cannot be used.
  ViewServer(ViewState& state, const SceneCommands& commands, const std::string& address, int port);
  /// Ends all requests within a second, also those of clients that do not read or write.
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  /// Returns the address of the page: "http://127.0.0.1:PORT/?token=...".
  const std::string& url() const { return url_; }

 private:
  struct State;
  std::unique_ptr<State> state_;
  std::string url_;
};

}  // namespace pelage
