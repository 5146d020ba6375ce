// SPDX-License-Identifier: Apache-2.0
#include "geom/alembic/alembic_values.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

#include <Imath/half.h>
#include <fmt/format.h>

namespace pelage {
namespace {

std::span<const std::byte> whole_elements(const AlembicArchive& archive, const AlembicProperty& property,
                                          uint32_t sample) {
  const size_t number = alembic_pod_bytes(property.pod);
  if (number == 0 || property.kind == AlembicProperty::Kind::kCompound) return {};
  const std::span<const std::byte> bytes = archive.sample(property, sample);
  if (bytes.size() % (number * property.extent) != 0) {
    archive.file().fail(fmt::format("'{}' has {} bytes, which is no whole number of elements of {} bytes",
                                    property.name, bytes.size(), number * property.extent),
                        bytes);
  }
  return bytes;
}

template <class From, class To>
void convert_numbers(std::span<const std::byte> bytes, std::vector<To>& to) {
  if constexpr (std::is_same_v<From, To>) {
    to.resize(bytes.size() / sizeof(To));
    if (!bytes.empty()) std::memcpy(to.data(), bytes.data(), bytes.size());
  } else {
    to.reserve(bytes.size() / sizeof(From));
    for (size_t i = 0; i < bytes.size(); i += sizeof(From)) {
      From number;
      std::memcpy(&number, bytes.data() + i, sizeof number);
      to.push_back(static_cast<To>(number));
    }
  }
}

template <class To>
std::vector<To> numbers_of(const AlembicArchive& archive, const AlembicProperty& property,
                           std::span<const std::byte> bytes) {
  std::vector<To> numbers;
  switch (property.pod) {
    case AlembicPod::kBool:
    case AlembicPod::kUint8:
      convert_numbers<uint8_t>(bytes, numbers);
      break;
    case AlembicPod::kInt8:
      convert_numbers<int8_t>(bytes, numbers);
      break;
    case AlembicPod::kUint16:
      convert_numbers<uint16_t>(bytes, numbers);
      break;
    case AlembicPod::kInt16:
      convert_numbers<int16_t>(bytes, numbers);
      break;
    case AlembicPod::kUint32:
      convert_numbers<uint32_t>(bytes, numbers);
      break;
    case AlembicPod::kInt32:
      convert_numbers<int32_t>(bytes, numbers);
      break;
    case AlembicPod::kUint64:
      convert_numbers<uint64_t>(bytes, numbers);
      break;
    case AlembicPod::kInt64:
      convert_numbers<int64_t>(bytes, numbers);
      break;
    case AlembicPod::kHalf:
    case AlembicPod::kFloat:
    case AlembicPod::kDouble:
      if constexpr (std::is_floating_point_v<To>) {
        if (property.pod == AlembicPod::kHalf) convert_numbers<half>(bytes, numbers);
        if (property.pod == AlembicPod::kFloat) convert_numbers<float>(bytes, numbers);
        if (property.pod == AlembicPod::kDouble) convert_numbers<double>(bytes, numbers);
      } else {
        archive.file().fail(fmt::format("'{}' must hold integers", property.name), bytes);
      }
      break;
    case AlembicPod::kText:
    case AlembicPod::kWideText:
      break;
  }
  return numbers;
}

}  // namespace

std::vector<float> alembic_floats(const AlembicArchive& archive, const AlembicProperty& property,
                                  uint32_t sample) {
  return numbers_of<float>(archive, property, whole_elements(archive, property, sample));
}
std::vector<double> alembic_doubles(const AlembicArchive& archive, const AlembicProperty& property,
                                    uint32_t sample) {
  return numbers_of<double>(archive, property, whole_elements(archive, property, sample));
}
std::vector<int64_t> alembic_integers(const AlembicArchive& archive, const AlembicProperty& property,
                                      uint32_t sample) {
  return numbers_of<int64_t>(archive, property, whole_elements(archive, property, sample));
}

std::optional<int64_t> alembic_first_integer(const AlembicArchive& archive, const AlembicProperty& property) {
  if (!alembic_is_integer(property)) return {};
  const std::span<const std::byte> bytes = whole_elements(archive, property, 0);
  if (bytes.empty()) return {};
  return numbers_of<int64_t>(archive, property, bytes.first(alembic_pod_bytes(property.pod)))[0];
}

size_t alembic_count(const AlembicArchive& archive, const AlembicProperty& property, uint32_t sample) {
  const size_t number = alembic_pod_bytes(property.pod);
  return number == 0 ? 0 : whole_elements(archive, property, sample).size() / number;
}

bool alembic_is_integer(const AlembicProperty& property) {
  return property.kind != AlembicProperty::Kind::kCompound && property.pod <= AlembicPod::kInt64;
}

}  // namespace pelage
