// SPDX-License-Identifier: Apache-2.0
#include "geom/alembic/ogawa_file.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <string_view>

#include <fmt/format.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"

namespace pelage {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers of the file are used as they are");

constexpr std::string_view kHdf5 = "\x89HDF";
constexpr size_t kWindow = 1024;

const std::filesystem::path& existing(const std::filesystem::path& path) {
  if (const std::string problem = file_problem(path); !problem.empty())
    throw Error(ErrorKind::kInput, {path.string(), 0, 0}, problem);
  return path;
}

}  // namespace

OgawaFile::OgawaFile(const std::filesystem::path& path) : file_(existing(path)) {
  std::string beginning(std::min<uint64_t>(size(), 64), '\0');
  read_at(0, std::as_writable_bytes(std::span(beginning)));
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
  if (beginning.compare(kOgawaVersion, 2, right.substr(kOgawaVersion, 2)) != 0)
    refuse("is of an unknown version of Alembic's Ogawa format");
}

OgawaGroup OgawaFile::root() const { return group_at(number_at(kOgawaRoot)); }

OgawaGroup OgawaFile::group(const OgawaGroup& parent, uint64_t child) const {
  const uint64_t position = word(parent, child);
  if (position & kOgawaData) fail("expected a group, found data", position & ~kOgawaData);
  return group_at(position);
}

OgawaBlock OgawaFile::block(const OgawaGroup& parent, uint64_t child) const {
  const uint64_t marked = word(parent, child), position = marked & ~kOgawaData;
  if (!(marked & kOgawaData)) fail("expected data, found a group", position);
  if (position == 0) return {};
  const uint64_t count = number_at(position);
  if (count > size() - position - 8) fail(fmt::format("claims {} bytes of data", count), position);
  return {position + 8, count};
}

void OgawaFile::read(const OgawaBlock& block, std::span<std::byte> to) const { read_at(block.position, to); }

std::span<const std::byte> OgawaFile::keep(const OgawaBlock& block) const {
  if (block.size == 0) return {};
  if (const auto known = kept_.find(block.position); known != kept_.end()) return known->second;
  kept_bytes_ += block.size;
  if (kept_bytes_ > size()) fail("objects or properties share their headers", block);
  std::vector<std::byte> bytes(block.size);
  read(block, bytes);
  return kept_.emplace(block.position, std::move(bytes)).first->second;
}

void OgawaFile::fail(const std::string& what, uint64_t position) const {
  throw Error(ErrorKind::kInput, {path().string(), 0, 0}, fmt::format("{} (byte {})", what, position));
}

uint64_t OgawaFile::word(const OgawaGroup& group, uint64_t child) const {
  if (child >= group.count)
    fail(fmt::format("child {} of a group of {} is missing", child, group.count), group.position);
  return number_at(group.position + 8 * (child + 1));
}

uint64_t OgawaFile::number_at(uint64_t position) const {
  if (position > size() || size() - position < 8) fail("points beyond its end", position);
  if (position < window_position_ || position + 8 > window_position_ + window_.size()) {
    // The old window stays as it is if this throws.
    std::vector<std::byte> window(std::min<uint64_t>(kWindow, size() - position));
    read_at(position, window);
    window_ = std::move(window);
    window_position_ = position;
  }
  uint64_t number = 0;
  std::memcpy(&number, window_.data() + (position - window_position_), sizeof number);
  return number;
}

void OgawaFile::read_at(uint64_t position, std::span<std::byte> to) const {
  for (size_t done = 0; done < to.size();) {
    const ssize_t got =
        ::pread(file_.descriptor(), to.data() + done, to.size() - done, static_cast<off_t>(position + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(fmt::format("cannot be read: {}", std::strerror(errno)), position + done);
    if (got == 0) fail("became shorter while it was read", position + done);
    done += static_cast<size_t>(got);
  }
}

OgawaGroup OgawaFile::group_at(uint64_t position) const {
  if (position == 0) return {};
  const OgawaGroup group{position, number_at(position)};
  if (group.count > (size() - position - 8) / 8)
    fail(fmt::format("claims a group of {} children", group.count), position);
  return group;
}

}  // namespace pelage
