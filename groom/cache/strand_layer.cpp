// SPDX-License-Identifier: Apache-2.0
#include "groom/cache/strand_layer.h"

#include <algorithm>
#include <cstring>

namespace pelage {
namespace {

struct Header {
  uint32_t count = 0, points = 0;
  uint32_t has_radii = 0;
  uint32_t color_rows = 0;
};

template <class Rows>
bool all_are(const Rows& rows, size_t count, float value) {
  return std::all_of(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(count),
                     [value](float v) { return v == value; });
}

void append_row(const StrandRow& row, size_t count, std::vector<std::byte>& bytes) {
  const auto from = std::as_bytes(std::span(row).first(count));
  bytes.insert(bytes.end(), from.begin(), from.end());
}

}  // namespace

void append_layer(const StrandBatch& batch, std::vector<std::byte>& bytes) {
  const size_t n = batch.count;
  Header header{static_cast<uint32_t>(n), static_cast<uint32_t>(batch.points.size()), 0, 0};
  for (const StrandBatch::PointRows& point : batch.points)
    header.has_radii |= !all_are(point.radius, n, 0.0f);
  for (const VectorRow& color : batch.colors) {
    for (const StrandRow& channel : color) {
      if (!all_are(channel, n, 1.0f)) header.color_rows = static_cast<uint32_t>(batch.colors.size());
    }
  }
  const auto from = std::as_bytes(std::span(&header, 1));
  bytes.insert(bytes.end(), from.begin(), from.end());
  append_row(batch.clump, n, bytes);
  // Operators do not move point 0.
  for (size_t p = 1; p < batch.points.size(); ++p) {
    for (const StrandRow& axis : batch.points[p].offset) append_row(axis, n, bytes);
  }
  if (header.has_radii) {
    for (const StrandBatch::PointRows& point : batch.points) append_row(point.radius, n, bytes);
  }
  if (header.color_rows) {
    for (const VectorRow& color : batch.colors) {
      for (const StrandRow& channel : color) append_row(channel, n, bytes);
    }
  }
}

bool read_layer(std::span<const std::byte> bytes, size_t& at, StrandBatch& batch) {
  Header header;
  if (at > bytes.size() || bytes.size() - at < sizeof(header)) return false;
  std::memcpy(&header, bytes.data() + at, sizeof(header));
  const size_t n = batch.count, points = batch.points.size();
  if (header.count != n || header.points != points) return false;
  if (header.color_rows != 0 && header.color_rows != batch.colors.size()) return false;
  const size_t rows = 1 + 3 * (points - 1) + (header.has_radii ? points : 0) + 3 * size_t(header.color_rows);
  if ((bytes.size() - at - sizeof(header)) / (4 * n) < rows) return false;
  at += sizeof(header);
  const auto take = [&](StrandRow& row) {
    std::memcpy(row.data(), bytes.data() + at, 4 * n);
    at += 4 * n;
  };
  take(batch.clump);
  for (size_t p = 1; p < points; ++p) {
    for (StrandRow& axis : batch.points[p].offset) take(axis);
  }
  for (StrandBatch::PointRows& point : batch.points) {
    if (header.has_radii) {
      take(point.radius);
    } else {
      point.radius.fill(0.0f);
    }
  }
  if (header.color_rows) {
    for (VectorRow& color : batch.colors) {
      for (StrandRow& channel : color) take(channel);
    }
  }
  return true;
}

}  // namespace pelage
