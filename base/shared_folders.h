// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace pelage {

/// Environment variable: folders, separated by ':', whose caches other users may fill for this one.
inline constexpr const char* kSharedCachesVariable = "PELAGE_SHARED_CACHES";

/// Whether the variable names `folder` or one that it is in, under any name. It is the user or the farm that
/// trusts other users, by the environment, and never a scene: a scene comes from those very users.
bool is_shared_folder(const std::filesystem::path& folder);

}  // namespace pelage
