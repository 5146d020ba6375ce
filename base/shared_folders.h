// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace pelage {

/// Environment variable: folders, separated by ':', whose caches other users may fill for this user.
inline constexpr const char* kSharedCachesVariable = "PELAGE_SHARED_CACHES";

/// Whether the variable names `folder` or a parent of it, by any path. Only the environment, set by the user
/// or the farm, can declare trust in other users. A scene cannot, because it may come from these other users.
bool is_shared_folder(const std::filesystem::path& folder);

}  // namespace pelage
