// SPDX-License-Identifier: Apache-2.0
#include "geom/alembic/ogawa_writer.h"

namespace pelage {
namespace {

constexpr uint64_t kDataWord = uint64_t(1) << 63;
constexpr size_t kClosedByte = 5, kRootWord = 8;

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

}  // namespace

OgawaWriter::OgawaWriter(AtomicFile& file) : file_(file) {
  constexpr char kHeader[16] = {'O', 'g', 'a', 'w', 'a', 0, 0, 1};  // version 1, not yet complete
  file_.write(std::as_bytes(std::span(kHeader)));
  end_ = sizeof kHeader;
}

uint64_t OgawaWriter::data(std::span<const std::byte> bytes, std::span<const std::byte> more) {
  const uint64_t word = begin(bytes.size() + more.size());
  if (!bytes.empty()) append(bytes);
  if (!more.empty()) append(more);
  return word;
}

uint64_t OgawaWriter::begin(uint64_t size) {
  const uint64_t position = end_;
  if (size == 0) return kDataWord;  // all empty blocks are at 0
  file_.write(bytes_of(size));
  end_ += sizeof size + size;
  return position | kDataWord;
}

void OgawaWriter::replace(uint64_t block, uint64_t offset, std::span<const std::byte> bytes) {
  file_.write_at((block & ~kDataWord) + sizeof(uint64_t) + offset, bytes);
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
  constexpr char kClosed = '\xff';
  file_.write_at(kRootWord, bytes_of(root));
  file_.write_at(kClosedByte, bytes_of(kClosed));
}

}  // namespace pelage
