// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "base/value.h"
#include "rib/document/rib_use.h"
#include "scene/document.h"

namespace pelage {

/// Where a scene comes from: a file, or values of the host.
struct SceneSource {
  std::filesystem::path path;
  const Value* made = nullptr;  ///< null: a file

  bool is_rib() const;

  /// Returns the document of a scene file or of values of the host, see load_document().
  std::optional<Value> document(const std::vector<Override>& overrides, Problems& problems,
                                RenamedKeys* renamed) const {
    return made ? complete_document(*made, overrides, problems, renamed)
                : load_document(path, overrides, problems, renamed);
  }

  /// Returns the document of a scene file, of values of the host, or of a RIB file as a scene, with the
  /// overrides and with the materials of RIB files. Returns nullopt if there are problems that hide others.
  std::optional<Value> any_document(const std::vector<Override>& overrides, const RibUse& use,
                                    Problems& problems, RenamedKeys& renamed) const;
};

}  // namespace pelage
