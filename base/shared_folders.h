// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace pelage {

/// Name of an environment variable. Its value lists folders, separated by ':'. In these folders, cache files
/// that other users wrote are accepted.
inline constexpr const char* kSharedCachesVariable = "PELAGE_SHARED_CACHES";

/// Returns whether the variable lists `folder` or a folder that contains it; both paths are compared without
/// symbolic links. A scene cannot declare a folder as shared, because the scene may come from the very users
/// whose files would then be trusted. The environment is set by the user or the farm.
bool is_shared_folder(const std::filesystem::path& folder);

}  // namespace pelage
