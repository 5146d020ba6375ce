// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace pelage {

/// Environment variable: folders, separated by ':', whose caches other users may fill for this user.
inline constexpr const char* kSharedCachesVariable = "PELAGE_SHARED_CACHES";

/// Whether the variable names `folder` or a parent of it, by any path. Trust in other users is declared by
/// the user or the farm through the environment, never by a scene, which may come from those very users.
bool is_shared_folder(const std::filesystem::path& folder);

}  // namespace pelage
