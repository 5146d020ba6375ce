// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "base/content_store.h"
#include "groom/follicles/follicles.h"

namespace pelage {

class SurfaceTopology;

/// Returns the path of the file of follicles in the store.
std::filesystem::path follicle_file(const ContentStore& store, const ContentHash& key);
/// Stores follicles. Returns whether they are now in the store.
bool store_follicles(const ContentStore& store, const ContentHash& key, const FollicleTree& follicles,
                     const WarningSink& warn);
/// Reads follicles from the store. Empty when the entry is missing or its follicles do not belong to this
/// skin. `topology` is the topology of the skin; null for strands without a skin.
std::optional<FollicleTree> stored_follicles(const ContentStore& store, const ContentHash& key,
                                             const SurfaceTopology* topology, const WarningSink& warn);

}  // namespace pelage
