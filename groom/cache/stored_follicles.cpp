// SPDX-License-Identifier: Apache-2.0
#include "groom/cache/stored_follicles.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "geom/limit_surface.h"

namespace pelage {
namespace {

constexpr const char* kFolliclesKind = "follicles";
constexpr uint32_t kFolliclesFormat = 1;

/// Files of other formats have other names, so they are not taken for damaged.
ContentHash follicles_key(const ContentHash& key) {
  return ContentHasher().add(key).add(kFolliclesFormat).digest();
}

// Sections: leaves; ids; faces; u and v. Ids ascend within a leaf: when no difference exceeds 65535,
// differences are stored instead, 0 for the first of a leaf. Faces take 16 bits when the skin has no more.
// The size of a section shows which form it has.
struct StoredLeaf {
  uint32_t begin, end;
  uint32_t first_id;
  float low[3], high[3];
};

template <class T>
std::optional<std::vector<T>> elements(std::span<const std::byte> bytes) {
  if (bytes.size() % sizeof(T) != 0) return {};
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!bytes.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

/// Numbers of 16 or of 32 bits each.
std::optional<std::vector<uint32_t>> narrow_or_wide(std::span<const std::byte> bytes, size_t count) {
  if (bytes.size() != count * 2) {
    return bytes.size() == count * 4 ? elements<uint32_t>(bytes) : std::optional<std::vector<uint32_t>>();
  }
  const auto narrow = elements<uint16_t>(bytes);
  return std::vector<uint32_t>(narrow->begin(), narrow->end());
}

void add_narrow(const std::vector<uint32_t>& values, ContentStore::Writer& writer) {
  const std::vector<uint16_t> narrow(values.begin(), values.end());
  writer.add(std::span<const uint16_t>(narrow));
}

bool good(const RootAddress& root, uint32_t faces) {
  return root.face < faces && root.u >= 0 && root.u <= 1 && root.v >= 0 && root.v <= 1;
}

}  // namespace

std::filesystem::path follicle_file(const ContentStore& store, const ContentHash& key) {
  return store.file(kFolliclesKind, follicles_key(key));
}

bool store_follicles(const ContentStore& store, const ContentHash& key, const FollicleTree& follicles,
                     const WarningSink& warn) {
  std::vector<StoredLeaf> leaves;
  const std::span<const uint32_t> ids = follicles.ids();
  std::vector<uint32_t> steps(ids.size()), faces;
  std::vector<V2f> places;
  for (const FollicleTree::Leaf& leaf : follicles.leaves()) {
    const Box3f& box = leaf.rest_roots;
    leaves.push_back({leaf.begin,
                      leaf.end,
                      ids[leaf.begin],
                      {box.min.x, box.min.y, box.min.z},
                      {box.max.x, box.max.y, box.max.z}});
    for (uint32_t f = leaf.begin + 1; f < leaf.end; ++f) steps[f] = ids[f] - ids[f - 1];
  }
  for (const RootAddress& root : follicles.roots()) {
    faces.push_back(root.face);
    places.emplace_back(root.u, root.v);
  }
  const auto is_narrow = [](const std::vector<uint32_t>& values) {
    return std::all_of(values.begin(), values.end(), [](uint32_t v) { return v <= UINT16_MAX; });
  };
  ContentStore::Writer writer = store.writer(kFolliclesKind, follicles_key(key));
  writer.add(std::span<const StoredLeaf>(leaves));
  if (is_narrow(steps)) {
    add_narrow(steps, writer);
  } else {
    writer.add(ids);
  }
  if (is_narrow(faces)) {
    add_narrow(faces, writer);
  } else {
    writer.add(std::span<const uint32_t>(faces));
  }
  writer.add(std::span<const V2f>(places));
  return writer.commit(warn);
}

std::optional<FollicleTree> stored_follicles(const ContentStore& store, const ContentHash& key,
                                             const SurfaceTopology* topology, const WarningSink& warn) {
  const std::optional<StoredFile> file = store.open(kFolliclesKind, follicles_key(key), warn);
  if (!file) return {};
  const auto refuse = [&]() -> std::optional<FollicleTree> {
    warn(follicle_file(store, key).string() +
         ": damaged cache file: its follicles do not match this skin; it is made again");
    return {};
  };
  if (file->section_count() != 4) return refuse();
  const auto stored = elements<StoredLeaf>(file->section(0));
  const auto places = elements<float>(file->section(3));
  if (!stored || !places || places->size() % 2 != 0) return refuse();
  const size_t count = places->size() / 2;
  auto ids = narrow_or_wide(file->section(1), count);
  const auto faces = narrow_or_wide(file->section(2), count);
  if (!ids || !faces) return refuse();
  const uint32_t face_count = topology ? topology->face_count() : 1;
  std::vector<RootAddress> roots(count);
  for (size_t i = 0; i < count; ++i) {
    roots[i] = {(*faces)[i], (*places)[i * 2], (*places)[i * 2 + 1]};
    if (!good(roots[i], face_count)) return refuse();
  }
  std::vector<FollicleTree::Leaf> leaves;
  const bool has_steps = file->section(1).size() == count * 2;
  uint32_t end = 0;
  for (const StoredLeaf& leaf : *stored) {
    if (leaf.begin != end || leaf.end <= leaf.begin || leaf.end > ids->size()) return refuse();
    end = leaf.end;
    if (has_steps) (*ids)[leaf.begin] = leaf.first_id;
    for (uint32_t f = leaf.begin + 1; f < leaf.end; ++f) {
      if (has_steps) (*ids)[f] += (*ids)[f - 1];
      if ((*ids)[f] <= (*ids)[f - 1]) return refuse();
    }
    leaves.push_back(
        {leaf.begin, leaf.end,
         Box3f(V3f(leaf.low[0], leaf.low[1], leaf.low[2]), V3f(leaf.high[0], leaf.high[1], leaf.high[2]))});
  }
  if (end != ids->size()) return refuse();
  return FollicleTree::of(std::move(leaves), std::move(*ids), std::move(roots));
}

}  // namespace pelage
