// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/fur_leaf.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace pelage {
namespace {

constexpr float kExactWhole = 0x1p24f;  // floats hold every integer up to here
constexpr float kWidestDifference = 65535;
constexpr float kRadiusSteps = 255;

template <class T>
void put(std::byte* block, size_t offset, T value) {
  std::memcpy(block + offset, &value, sizeof(value));
}

template <class T>
T block_value(const std::byte* block, size_t offset) {
  T value;
  std::memcpy(&value, block + offset, sizeof(value));
  return value;
}

size_t value_offset(const FurBlockSizes& sizes, size_t value_bytes, size_t lane, size_t point, size_t axis,
                    int key) {
  return sizeof(FurBlockHeader) + static_cast<size_t>(key) * sizes.key() + axis * sizes.axis +
         (point * FurBlockHeader::kLanes + lane) * value_bytes;
}

/// Min and max coordinates along an axis.
std::array<float, 2> reach(std::span<const SnappedSegment> segments, size_t axis) {
  float low = segments[0][0][axis], high = low;
  for (const SnappedSegment& segment : segments) {
    for (const auto& point : segment) {
      low = std::min(low, point[axis]);
      high = std::max(high, point[axis]);
    }
  }
  return {low, high};
}

}  // namespace

bool fits_narrow_block(const FurBlockContents& contents) {
  for (size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] = reach(contents.segments, axis);
    if (!(low >= -kExactWhole && high <= kExactWhole && high - low <= kWidestDifference)) return false;
  }
  for (const SnappedSegment& segment : contents.segments) {
    for (const auto& point : segment) {
      if (point[3] * 256 > kRadiusSteps * kRadiusSteps) return false;
    }
  }
  return true;
}

void write_block(const FurBlockContents& contents, int motion_keys, bool wide, std::byte* out) {
  FurBlockHeader header{};
  float origin[3];
  for (size_t axis = 0; axis < 3; ++axis) {
    origin[axis] = wide ? 0 : reach(contents.segments, axis)[0];
    header.origin[axis] = static_cast<int32_t>(origin[axis]);
  }
  std::copy(contents.numbers.begin(), contents.numbers.end(), header.number);
  std::memcpy(out, &header, sizeof(header));

  const auto keys = static_cast<size_t>(motion_keys);
  const size_t lanes = contents.segments.size() / keys;
  for (int key = 0; key < motion_keys; ++key) {
    for (size_t lane = 0; lane < FurBlockHeader::kLanes; ++lane) {
      // An empty lane is a single point inside the block, without length.
      SnappedSegment segment{};
      if (lane < lanes) {
        segment = contents.segments[lane * keys + static_cast<size_t>(key)];
      } else {
        for (auto& point : segment) {
          std::copy_n(contents.segments[0][0].begin(), 3, point.begin());
        }
      }
      for (size_t point = 0; point < 4; ++point) {
        for (size_t axis = 0; axis < 3; ++axis) {
          const float value = segment[point][axis];
          if (wide) {
            put(out, value_offset(kWideBlock, sizeof(float), lane, point, axis, key), value);
          } else {
            put(out, value_offset(kNarrowBlock, sizeof(uint16_t), lane, point, axis, key),
                static_cast<uint16_t>(value - origin[axis]));
          }
        }
        if (wide) {
          put(out, value_offset(kWideBlock, sizeof(float), lane, point, 3, key), segment[point][3]);
        } else {
          put(out, value_offset(kNarrowBlock, sizeof(uint8_t), lane, point, 3, key),
              static_cast<uint8_t>(std::sqrt(segment[point][3] * 256)));
        }
      }
    }
  }
}

SnappedSegment read_block(const std::byte* block, bool wide, size_t lane, int key) {
  const auto header = block_value<FurBlockHeader>(block, 0);
  SnappedSegment segment;
  for (size_t point = 0; point < 4; ++point) {
    for (size_t axis = 0; axis < 3; ++axis) {
      segment[point][axis] =
          wide ? block_value<float>(block, value_offset(kWideBlock, sizeof(float), lane, point, axis, key))
               : static_cast<float>(header.origin[axis]) +
                     static_cast<float>(block_value<uint16_t>(
                         block, value_offset(kNarrowBlock, sizeof(uint16_t), lane, point, axis, key)));
    }
    if (wide) {
      segment[point][3] =
          block_value<float>(block, value_offset(kWideBlock, sizeof(float), lane, point, 3, key));
    } else {
      const auto root = static_cast<float>(
          block_value<uint8_t>(block, value_offset(kNarrowBlock, sizeof(uint8_t), lane, point, 3, key)));
      segment[point][3] = root * root * (1.0f / 256);
    }
  }
  return segment;
}

}  // namespace pelage
