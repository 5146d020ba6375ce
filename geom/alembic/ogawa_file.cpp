// SPDX-License-Identifier: Apache-2.0
#include "geom/alembic/ogawa_file.h"

#include <bit>
#include <cstring>
#include <string_view>

#include <fmt/format.h>

#include "base/error.h"
#include "base/file.h"

namespace pelage {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers of the file are used as they are");

constexpr std::string_view kHdf5 = "\x89HDF";

}  // namespace

OgawaFile::OgawaFile(const std::filesystem::path& path) : path_(path) {
  if (const std::string problem = file_problem(path); !problem.empty())
    throw Error(ErrorKind::kInput, {path.string(), 0, 0}, problem);
  file_ = MappedFile(path);
  bytes_ = file_.bytes();
  const std::string_view beginning(reinterpret_cast<const char*>(bytes_.data()),
                                   std::min<size_t>(bytes_.size(), 64));
  const auto refuse = [&](std::string_view why) {
    throw Error(ErrorKind::kInput, {path.string(), 0, 0}, std::string(why));
  };
  if (const std::string_view foreign = foreign_contents(beginning); !foreign.empty()) refuse(foreign);
  if (beginning.starts_with(kHdf5))
    refuse("is an Alembic file of the older kind, HDF5; convert it: abcconvert -toOgawa IN.abc OUT.abc");
  const std::string_view right(kOgawaBeginning, sizeof kOgawaBeginning);
  if (!beginning.starts_with(right.substr(0, kOgawaMark)) || beginning.size() < right.size())
    refuse("is not an Alembic file");
  if (beginning[kOgawaClosed] != kOgawaClosedByte)
    refuse("is not complete: the program that wrote it did not close it");
  if (beginning.substr(kOgawaVersion, 2) != right.substr(kOgawaVersion, 2))
    refuse("is of an unknown version of Alembic's Ogawa format");
}

OgawaGroup OgawaFile::root() const { return group_at(number_at(kOgawaRoot)); }

OgawaGroup OgawaFile::group(const OgawaGroup& parent, uint64_t child) const {
  const uint64_t position = word(parent, child);
  if (position & kOgawaData) fail("expected a group, found data", position & ~kOgawaData);
  return group_at(position);
}

std::span<const std::byte> OgawaFile::data(const OgawaGroup& parent, uint64_t child) const {
  const uint64_t marked = word(parent, child), position = marked & ~kOgawaData;
  if (!(marked & kOgawaData)) fail("expected data, found a group", position);
  if (position == 0) return {};
  const uint64_t count = number_at(position);
  if (count > size() - position - 8) fail(fmt::format("claims {} bytes of data", count), position);
  return bytes_.subspan(position + 8, count);
}

void OgawaFile::fail(const std::string& what, uint64_t position) const {
  throw Error(ErrorKind::kInput, {path_.string(), 0, 0}, fmt::format("{} (byte {})", what, position));
}

uint64_t OgawaFile::word(const OgawaGroup& group, uint64_t child) const {
  if (child >= group.count)
    fail(fmt::format("child {} of a group of {} is missing", child, group.count), group.position);
  return number_at(group.position + 8 * (child + 1));
}

uint64_t OgawaFile::number_at(uint64_t position) const {
  if (position > size() || size() - position < 8) fail("points beyond its end", position);
  uint64_t number = 0;
  std::memcpy(&number, bytes_.data() + position, sizeof number);
  return number;
}

OgawaGroup OgawaFile::group_at(uint64_t position) const {
  if (position == 0) return {};
  const OgawaGroup group{position, number_at(position)};
  if (group.count > (size() - position - 8) / 8)
    fail(fmt::format("claims a group of {} children", group.count), position);
  return group;
}

}  // namespace pelage
