// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "exchange/posed_frames.h"

namespace pelage {

/// Writes a coat as a layer `file` and one layer per leaf in a folder of the same name. The prims of leaves
/// have payloads and extents, so a stage opens without loading a strand. `coat`: index in FrameParts::coats.
/// `metadata`: of all layers. Returns the extent of the coat in all frames; empty, without a file, if it has
/// no strands.
std::optional<Box3f> write_usd_coat(const std::filesystem::path& file, const std::string& metadata,
                                    const PosedFrames& frames, size_t coat, const Job& job);

}  // namespace pelage
