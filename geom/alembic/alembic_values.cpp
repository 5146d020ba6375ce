// SPDX-License-Identifier: Apache-2.0
#include "geom/alembic/alembic_values.h"

#include <algorithm>
#include <type_traits>

#include <Imath/half.h>
#include <fmt/format.h>

namespace pelage {
namespace {

constexpr size_t kNumbersAtOnce = 8192;

OgawaBlock whole_elements(const AlembicArchive& archive, const AlembicProperty& property, uint32_t sample) {
  const size_t number = alembic_pod_bytes(property.pod);
  if (number == 0 || property.kind == AlembicProperty::Kind::kCompound) return {};
  const OgawaBlock block = archive.sample(property, sample);
  if (block.size % (number * property.extent) != 0) {
    archive.file().fail(fmt::format("'{}' has {} bytes, which is no whole number of elements of {} bytes",
                                    property.name, block.size, number * property.extent),
                        block);
  }
  return block;
}

template <class From, class To>
void read_numbers(const OgawaFile& file, const OgawaBlock& block, std::vector<To>& to) {
  to.resize(block.size / sizeof(From));
  if constexpr (std::is_same_v<From, To>) {
    file.read(block, std::as_writable_bytes(std::span(to)));
  } else {
    std::vector<From> part(std::min(kNumbersAtOnce, to.size()));
    for (size_t first = 0; first < to.size(); first += part.size()) {
      part.resize(std::min(part.size(), to.size() - first));
      file.read(block.from(first * sizeof(From)), std::as_writable_bytes(std::span(part)));
      std::transform(part.begin(), part.end(), to.begin() + static_cast<ptrdiff_t>(first),
                     [](From number) { return static_cast<To>(number); });
    }
  }
}

template <class To>
std::vector<To> numbers_of(const AlembicArchive& archive, const AlembicProperty& property,
                           const OgawaBlock& block) {
  std::vector<To> numbers;
  if (block.size == 0) return numbers;
  if (std::is_integral_v<To> && property.pod > AlembicPod::kInt64)
    archive.file().fail(fmt::format("'{}' must hold integers", property.name), block);
  using Read = void (*)(const OgawaFile&, const OgawaBlock&, std::vector<To>&);
  // In the order of AlembicPod; texts have no numbers.
  constexpr Read kRead[] = {read_numbers<uint8_t>,  read_numbers<uint8_t>,  read_numbers<int8_t>,
                            read_numbers<uint16_t>, read_numbers<int16_t>,  read_numbers<uint32_t>,
                            read_numbers<int32_t>,  read_numbers<uint64_t>, read_numbers<int64_t>,
                            read_numbers<half>,     read_numbers<float>,    read_numbers<double>};
  kRead[static_cast<size_t>(property.pod)](archive.file(), block, numbers);
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
  const OgawaBlock block = whole_elements(archive, property, 0);
  if (block.size == 0) return {};
  return numbers_of<int64_t>(archive, property, block.first(alembic_pod_bytes(property.pod)))[0];
}

size_t alembic_count(const AlembicArchive& archive, const AlembicProperty& property, uint32_t sample) {
  const size_t number = alembic_pod_bytes(property.pod);
  return number == 0 ? 0 : whole_elements(archive, property, sample).size / number;
}

bool alembic_is_integer(const AlembicProperty& property) {
  return property.kind != AlembicProperty::Kind::kCompound && property.pod <= AlembicPod::kInt64;
}

}  // namespace pelage
