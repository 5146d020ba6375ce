// SPDX-License-Identifier: Apache-2.0
#include "groom/stored_follicles.h"

#include <cmath>
#include <cstring>

#include "geom/limit_surface.h"

namespace pelage {
namespace {

constexpr const char* kKind = "follicles";

struct StoredLeaf {
  uint32_t begin, end;
  float low[3], high[3];
};

template <class T>
std::optional<std::vector<T>> elements(std::span<const std::byte> bytes) {
  if (bytes.size() % sizeof(T) != 0) return {};
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!bytes.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

bool good(const RootAddress& root, uint32_t faces) {
  return root.face < faces && root.u >= 0 && root.u <= 1 && root.v >= 0 && root.v <= 1;
}

}  // namespace

bool store_follicles(const ContentStore& store, const ContentHash& key, const FollicleTree& follicles,
                     const WarningSink& warn) {
  std::vector<StoredLeaf> leaves;
  for (const FollicleTree::Leaf& leaf : follicles.leaves()) {
    const Box3f& box = leaf.rest_roots;
    leaves.push_back(
        {leaf.begin, leaf.end, {box.min.x, box.min.y, box.min.z}, {box.max.x, box.max.y, box.max.z}});
  }
  ContentStore::Writer writer = store.writer(kKind, key);
  writer.add(std::span<const StoredLeaf>(leaves));
  writer.add(follicles.ids());
  writer.add(follicles.roots());
  return writer.commit(warn);
}

std::optional<FollicleTree> stored_follicles(const ContentStore& store, const ContentHash& key,
                                             const SurfaceTopology& topology, const WarningSink& warn) {
  const std::optional<StoredFile> file = store.open(kKind, key, warn);
  if (!file) return {};
  const auto refuse = [&]() -> std::optional<FollicleTree> {
    warn(store.file(kKind, key).string() +
         ": damaged cache file: its follicles are none of this skin; made again");
    return {};
  };
  if (file->section_count() != 3) return refuse();
  const auto stored = elements<StoredLeaf>(file->section(0));
  auto ids = elements<uint32_t>(file->section(1));
  auto roots = elements<RootAddress>(file->section(2));
  if (!stored || !ids || !roots || ids->size() != roots->size()) return refuse();
  for (const RootAddress& root : *roots) {
    if (!good(root, topology.face_count())) return refuse();
  }
  std::vector<FollicleTree::Leaf> leaves;
  uint32_t end = 0;
  for (const StoredLeaf& leaf : *stored) {
    if (leaf.begin != end || leaf.end <= leaf.begin || leaf.end > ids->size()) return refuse();
    end = leaf.end;
    leaves.push_back(
        {leaf.begin, leaf.end,
         Box3f(V3f(leaf.low[0], leaf.low[1], leaf.low[2]), V3f(leaf.high[0], leaf.high[1], leaf.high[2]))});
  }
  if (end != ids->size()) return refuse();
  return FollicleTree::of(std::move(leaves), std::move(*ids), std::move(*roots));
}

}  // namespace pelage
