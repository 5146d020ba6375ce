// SPDX-License-Identifier: Apache-2.0
#include "geom/alembic/ogawa_writer.h"

#include "geom/alembic/ogawa_layout.h"

namespace pelage {
namespace {

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

}  // namespace

OgawaWriter::OgawaWriter(AtomicFile& file) : file_(file) {
  file_.write(std::as_bytes(std::span(kOgawaBeginning)));
  end_ = sizeof kOgawaBeginning;
}

uint64_t OgawaWriter::data(std::span<const std::byte> bytes, std::span<const std::byte> more) {
  const uint64_t word = begin(bytes.size() + more.size());
  if (!bytes.empty()) append(bytes);
  if (!more.empty()) append(more);
  return word;
}

uint64_t OgawaWriter::begin(uint64_t size) {
  const uint64_t position = end_;
  if (size == 0) return kOgawaData;  // all empty blocks are at 0
  file_.write(bytes_of(size));
  end_ += sizeof size + size;
  return position | kOgawaData;
}

void OgawaWriter::replace(uint64_t block, uint64_t offset, std::span<const std::byte> bytes) {
  file_.write_at((block & ~kOgawaData) + sizeof(uint64_t) + offset, bytes);
}

uint64_t OgawaWriter::group(std::span<const uint64_t> children) {
  if (children.empty()) return 0;
  const uint64_t count = children.size(), position = end_;
  file_.write(bytes_of(count));
  file_.write(std::as_bytes(children));
  end_ += sizeof count * (1 + count);
  return position;
}

void OgawaWriter::finish(uint64_t root) {
  file_.write_at(kOgawaRoot, bytes_of(root));
  file_.write_at(kOgawaClosed, bytes_of(kOgawaClosedByte));
}

}  // namespace pelage
