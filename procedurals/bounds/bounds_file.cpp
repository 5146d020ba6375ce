// SPDX-License-Identifier: Apache-2.0
#include "procedurals/bounds/bounds_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

namespace pelage {
namespace {

const std::string kKind = "boxes";

// With reduced detail, a coat may be divided into different numbers of chunks.
ContentHash entry_key(const BoundsRecord& record, BoundSpan span, int keys) {
  return ContentHasher()
      .add("boxes")
      .add(kBoundsVersion)
      .add(record.key)
      .add(static_cast<uint64_t>(record.count))
      .add(span)
      .add(keys)
      .digest();
}

template <class T>
std::vector<T> numbers(std::span<const std::byte> section) {
  std::vector<T> values(section.size() / sizeof(T));
  if (!values.empty())
    std::memcpy(values.data(), section.data(), values.size() * sizeof(T));  // memcpy must not get null
  return values;
}

/// Whether a box is empty, or finite and not inverted.
bool is_possible(const Box3f& box) {
  if (box.isEmpty()) return true;
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(box.min[axis]) || !std::isfinite(box.max[axis])) return false;
  }
  return true;
}

/// Stored data of the cell bounds of one chunk, except their sides.
struct FineHeader {
  float corner[3], motion[3], step[3];
  uint32_t count;
};

V3f vector(const float* v) { return {v[0], v[1], v[2]}; }

/// Empty when the numbers are inconsistent.
std::vector<ChunkBounds> unpack(const StoredFile& file, size_t count, int keys) {
  if (file.section_count() != 4) return {};
  const auto first = numbers<uint32_t>(file.section(0));
  const auto values = numbers<float>(file.section(1));
  const auto headers = numbers<FineHeader>(file.section(2));
  const auto groups = numbers<SegmentCellBounds::Group>(file.section(3));
  if (first.size() != count + 1 || first[0] != 0 || size_t(first[count]) * 6 != values.size()) return {};
  if (headers.size() != count) return {};
  std::vector<ChunkBounds> bounds(count);
  std::span<const SegmentCellBounds::Group> rest(groups);
  for (size_t chunk = 0; chunk < count; ++chunk) {
    if (first[chunk + 1] < first[chunk] || first[chunk + 1] > first[count]) return {};
    if ((first[chunk + 1] - first[chunk]) % static_cast<uint32_t>(keys) != 0) return {};
    bounds[chunk].keys = keys;
    for (size_t i = first[chunk]; i < first[chunk + 1]; ++i) {
      const float* v = &values[i * 6];
      bounds[chunk].boxes.emplace_back(vector(v), vector(v + 3));
      if (!is_possible(bounds[chunk].boxes.back())) return {};
    }
    const FineHeader& h = headers[chunk];
    const size_t finest = SegmentCellBounds::groups_of(h.count);
    if (finest > rest.size()) return {};
    bounds[chunk].cell_bounds =
        SegmentCellBounds({vector(h.corner), vector(h.motion), vector(h.step)}, rest.first(finest), h.count);
    if (!bounds[chunk].cell_bounds.is_possible()) return {};
    rest = rest.subspan(finest);
  }
  if (!rest.empty()) return {};
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
    warn(record.store->file(kKind, key).string() +
         ": the stored boxes cannot be right; they are measured again");
  }
  return bounds;
}

void write_bounds(const BoundsRecord& record, BoundSpan span, int keys,
                  std::span<const ChunkBounds* const> bounds, const WarningSink& warn) {
  std::vector<uint32_t> first{0};
  std::vector<float> values;
  std::vector<FineHeader> headers;
  std::vector<SegmentCellBounds::Group> groups;
  for (const ChunkBounds* chunk : bounds) {
    for (const Box3f& box : chunk->boxes) {
      values.insert(values.end(), {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z});
    }
    first.push_back(static_cast<uint32_t>(values.size() / 6));
    const SegmentCellBounds& cell_bounds = chunk->cell_bounds;
    FineHeader header;
    std::copy_n(&cell_bounds.grid().corner[0], 3, header.corner);
    std::copy_n(&cell_bounds.grid().motion[0], 3, header.motion);
    std::copy_n(&cell_bounds.grid().step[0], 3, header.step);
    header.count = static_cast<uint32_t>(cell_bounds.count());
    headers.push_back(header);
    if (cell_bounds.count() > 0)
      groups.insert(groups.end(), cell_bounds.level(0).begin(), cell_bounds.level(0).end());
  }
  ContentStore::Writer writer = record.store->writer(kKind, entry_key(record, span, keys));
  writer.add(std::span<const uint32_t>(first));
  writer.add(std::span<const float>(values));
  writer.add(std::span<const FineHeader>(headers));
  writer.add(std::span<const SegmentCellBounds::Group>(groups));
  writer.commit(warn);
}

}  // namespace pelage
