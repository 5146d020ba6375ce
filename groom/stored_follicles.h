// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "base/content_store.h"
#include "groom/follicles.h"

namespace pelage {

class SurfaceTopology;

std::filesystem::path follicle_file(const ContentStore& store, const ContentHash& key);
/// Whether the follicles now stand in the store.
bool store_follicles(const ContentStore& store, const ContentHash& key, const FollicleTree& follicles,
                     const WarningSink& warn);
/// Nothing when they are not there, or when what is there are no follicles of such a skin. `topology` is null
/// for strands that stand free.
std::optional<FollicleTree> stored_follicles(const ContentStore& store, const ContentHash& key,
                                             const SurfaceTopology* topology, const WarningSink& warn);

}  // namespace pelage
