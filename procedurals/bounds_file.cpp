// SPDX-License-Identifier: Apache-2.0
#include "procedurals/bounds_file.h"

#include <cmath>
#include <cstring>
#include <string>

namespace pelage {
namespace {

const std::string kKind = "boxes";
// Counts up whenever the same strands would get other boxes, or the file another layout.
constexpr uint32_t kVersion = 1;

ContentHash entry_key(const BoundsRecord& record, BoundSpan span, int keys) {
  return ContentHasher().add("boxes").add(kVersion).add(record.key).add(span).add(keys).digest();
}

template <class T>
std::vector<T> numbers(std::span<const std::byte> section) {
  std::vector<T> values(section.size() / sizeof(T));
  std::memcpy(values.data(), section.data(), values.size() * sizeof(T));
  return values;
}

/// Whether a box is empty, or finite and the right way round.
bool is_possible(const Box3f& box) {
  if (box.isEmpty()) return true;
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(box.min[axis]) || !std::isfinite(box.max[axis])) return false;
  }
  return true;
}

/// Nothing when the numbers do not fit together.
std::vector<ChunkBounds> unpack(const StoredFile& file, size_t count, int keys) {
  if (file.section_count() != 2) return {};
  const std::vector<uint32_t> first = numbers<uint32_t>(file.section(0));
  const std::vector<float> values = numbers<float>(file.section(1));
  if (first.size() != count + 1 || first[0] != 0 || size_t(first[count]) * 6 != values.size()) return {};
  std::vector<ChunkBounds> bounds(count);
  for (size_t chunk = 0; chunk < count; ++chunk) {
    if (first[chunk + 1] < first[chunk] || first[chunk + 1] > first[count]) return {};
    if ((first[chunk + 1] - first[chunk]) % static_cast<uint32_t>(keys) != 0) return {};
    bounds[chunk].keys = keys;
    for (size_t i = first[chunk]; i < first[chunk + 1]; ++i) {
      const float* v = &values[i * 6];
      bounds[chunk].boxes.emplace_back(V3f(v[0], v[1], v[2]), V3f(v[3], v[4], v[5]));
      if (!is_possible(bounds[chunk].boxes.back())) return {};
    }
  }
  return bounds;
}

}  // namespace

std::vector<ChunkBounds> read_bounds(const BoundsRecord& record, BoundSpan span, int keys,
                                     const WarningSink& warn) {
  const ContentHash key = entry_key(record, span, keys);
  const std::optional<StoredFile> file = record.store->open(kKind, key, warn);
  if (!file) return {};
  std::vector<ChunkBounds> bounds = unpack(*file, record.count, keys);
  if (bounds.empty()) {
    warn(record.store->file(kKind, key).string() + ": these boxes cannot be right; they are measured again");
  }
  return bounds;
}

void write_bounds(const BoundsRecord& record, BoundSpan span, int keys, std::span<const ChunkBounds> bounds,
                  const WarningSink& warn) {
  std::vector<uint32_t> first{0};
  std::vector<float> values;
  for (const ChunkBounds& chunk : bounds) {
    for (const Box3f& box : chunk.boxes) {
      values.insert(values.end(), {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z});
    }
    first.push_back(static_cast<uint32_t>(values.size() / 6));
  }
  const std::span<const std::byte> sections[] = {std::as_bytes(std::span(first)),
                                                 std::as_bytes(std::span(values))};
  record.store->store(kKind, entry_key(record, span, keys), sections, warn);
}

}  // namespace pelage
