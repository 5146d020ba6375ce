// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "base/content_store.h"
#include "groom/follicles.h"

namespace pelage {

class SurfaceTopology;

std::filesystem::path follicle_file(const ContentStore& store, const ContentHash& key);
/// Returns whether the follicles are now in the store.
bool store_follicles(const ContentStore& store, const ContentHash& key, const FollicleTree& follicles,
                     const WarningSink& warn);
/// Empty when the entry is missing or does not hold follicles of this skin. `topology`: null for strands
/// without a skin.
std::optional<FollicleTree> stored_follicles(const ContentStore& store, const ContentHash& key,
                                             const SurfaceTopology* topology, const WarningSink& warn);

}  // namespace pelage
