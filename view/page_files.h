// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "base/page_file.h"

namespace pelage {

/// Returns all files of view/page/.
std::span<const PageFile> page_files();

}  // namespace pelage
