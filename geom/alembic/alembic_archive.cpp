// SPDX-License-Identifier: Apache-2.0
#include "geom/alembic/alembic_archive.h"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

namespace pelage {
namespace {

// Children of the first group: version of the layout, version of the library, the top object, metadata of
// the archive, time samplings, and indexed metadata.
constexpr uint64_t kLayoutChild = 0, kTopChild = 2, kMetadataChild = 3, kIndexedChild = 5;
constexpr size_t kSampleKey = 16, kHeaderHashes = 32;
constexpr uint32_t kInlineMetadata = 255;
constexpr size_t kMaxNameBytes = size_t(1) << 16;
// Readers parse each compound a few times.
constexpr uint64_t kMaxHeaderPasses = 16;

/// Reads headers from a block of data.
class AlembicHeaderReader {
 public:
  AlembicHeaderReader(const OgawaFile& file, const OgawaBlock& block, std::string_view what)
      : file_(file), block_(block), bytes_(file.keep(block)), what_(what) {}

  bool at_end() const { return next_ == bytes_.size(); }
  /// A number of 1, 2 or 4 bytes.
  uint32_t number(size_t size) {
    uint32_t value = 0;
    std::memcpy(&value, take(size).data(), size);
    return value;
  }
  std::string_view text(size_t size) {
    const std::span<const std::byte> taken = take(size);
    return {reinterpret_cast<const char*>(taken.data()), size};
  }
  /// The name of an object or a property.
  std::string_view name(size_t size) {
    if (size == 0) fail("a name is empty");
    if (size > kMaxNameBytes) fail(fmt::format("a name has {} bytes; {} are allowed", size, kMaxNameBytes));
    const std::string_view taken = text(size);
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
    if (std::any_of(taken.begin(), taken.end(), is_control)) fail("a name has a control character");
    return taken;
  }
  [[noreturn]] void fail(const std::string& why) const {
    file_.fail(fmt::format("{}: {}", what_, why), block_);
  }

 private:
  std::span<const std::byte> take(size_t size) {
    if (size > bytes_.size() - next_) fail("they end within one");
    next_ += size;
    return bytes_.subspan(next_ - size, size);
  }

  const OgawaFile& file_;
  const OgawaBlock block_;
  const std::span<const std::byte> bytes_;
  const std::string_view what_;
  size_t next_ = 0;
};

/// Bits of the first number of a property's header.
struct PropertyBits {
  uint32_t bits;
  uint32_t kind() const { return bits & 3; }
  size_t number_bytes() const { return size_t(1) << (bits >> 2 & 3); }
  uint32_t pod() const { return bits >> 4 & 15; }
  bool has_time() const { return bits & 0x100; }
  bool has_changes() const { return bits & 0x200; }
  bool is_constant() const { return bits & 0x800; }
  uint32_t extent() const { return bits >> 12 & 255; }
  uint32_t metadata() const { return bits >> 20 & 255; }
};

/// Reads how many samples a property has in the file. Those before the first change and after the last one
/// are stored once each.
uint32_t stored_samples(const PropertyBits& info, AlembicHeaderReader& in) {
  const uint32_t samples = in.number(info.number_bytes());
  if (!info.has_changes()) return info.is_constant() ? std::min(samples, 1u) : samples;
  const uint32_t first = in.number(info.number_bytes()), last = in.number(info.number_bytes());
  if (first > last || last > samples) in.fail("samples that do not fit their number");
  return std::min(samples, last == 0 ? 1 : last - first + 2);
}

}  // namespace

size_t alembic_pod_bytes(AlembicPod pod) {
  constexpr size_t kBytes[] = {1, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8, 0, 0};
  return kBytes[static_cast<size_t>(pod)];
}

const AlembicProperty* AlembicCompound::find(std::string_view name) const {
  const auto found = std::find_if(properties.begin(), properties.end(),
                                  [&](const AlembicProperty& property) { return property.name == name; });
  return found == properties.end() ? nullptr : &*found;
}

std::string_view alembic_metadata(std::string_view metadata, std::string_view key) {
  while (!metadata.empty()) {
    const std::string_view pair = metadata.substr(0, metadata.find(';'));
    if (pair.size() > key.size() && pair.starts_with(key) && pair[key.size()] == '=')
      return pair.substr(key.size() + 1);
    metadata.remove_prefix(std::min(metadata.size(), pair.size() + 1));
  }
  return {};
}

AlembicArchive::AlembicArchive(const std::filesystem::path& path) : file_(path) {
  const OgawaGroup root = file_.root();
  const OgawaBlock layout = file_.block(root, kLayoutChild);
  int32_t version = -1;
  if (layout.size == sizeof version) file_.read(layout, std::as_writable_bytes(std::span(&version, 1)));
  if (version != 0) file_.fail("is of an unknown version of Alembic", root.position);
  const std::span<const std::byte> metadata = file_.keep(file_.block(root, kMetadataChild));
  top_.metadata = {reinterpret_cast<const char*>(metadata.data()), metadata.size()};
  top_.group = file_.group(root, kTopChild);
  read_indexed_metadata(file_.block(root, kIndexedChild));
}

void AlembicArchive::read_indexed_metadata(const OgawaBlock& block) {
  metadata_.emplace_back();  // index 0: none
  AlembicHeaderReader in(file_, block, "shared metadata");
  while (!in.at_end() && metadata_.size() < kInlineMetadata) metadata_.push_back(in.text(in.number(1)));
}

void AlembicArchive::count_headers(const OgawaBlock& headers) const {
  header_bytes_ += headers.size;
  if (header_bytes_ > kMaxHeaderPasses * file_.size())
    file_.fail("objects or properties share their headers", headers);
}

std::vector<AlembicObject> AlembicArchive::children(const AlembicObject& object) const {
  std::vector<AlembicObject> children;
  const uint64_t last = object.group.count - 1;
  if (object.group.count == 0 || file_.is_group(object.group, last)) return children;
  const OgawaBlock block = file_.block(object.group, last);
  if (block.size <= kHeaderHashes) return children;
  count_headers(block);
  AlembicHeaderReader in(file_, block.first(block.size - kHeaderHashes), "headers of objects");
  while (!in.at_end()) {
    AlembicObject child;
    child.name = in.name(in.number(4));
    const uint32_t index = in.number(1);
    if (index == kInlineMetadata) {
      child.metadata = in.text(in.number(4));
    } else if (index < metadata_.size()) {
      child.metadata = metadata_[index];
    } else {
      in.fail("metadata with an unknown index");
    }
    child.group = file_.group(object.group, children.size() + 1);
    children.push_back(child);
  }
  return children;
}

AlembicCompound AlembicArchive::properties(const AlembicObject& object) const {
  if (object.group.count == 0 || !file_.is_group(object.group, 0)) return {};
  return compound_of(file_.group(object.group, 0));
}

AlembicCompound AlembicArchive::compound(const AlembicProperty& property) const {
  return property.kind == AlembicProperty::Kind::kCompound ? compound_of(property.group) : AlembicCompound();
}

AlembicCompound AlembicArchive::compound_of(const OgawaGroup& group) const {
  AlembicCompound compound;
  if (group.count == 0 || file_.is_group(group, group.count - 1)) return compound;
  const OgawaBlock block = file_.block(group, group.count - 1);
  count_headers(block);
  AlembicHeaderReader in(file_, block, "headers of properties");
  while (!in.at_end()) {
    AlembicProperty property;
    const PropertyBits info{in.number(4)};
    const size_t bytes = info.number_bytes();
    if (bytes > 4) in.fail("numbers of an unknown size");
    if (info.kind() != 0) {
      property.kind = info.kind() == 1 ? AlembicProperty::Kind::kScalar : AlembicProperty::Kind::kArray;
      if (info.pod() > static_cast<uint32_t>(AlembicPod::kWideText)) in.fail("an unknown type of numbers");
      property.pod = static_cast<AlembicPod>(info.pod());
      property.extent = info.extent();
      if (property.extent == 0) in.fail("elements without numbers");
      property.stored = stored_samples(info, in);
      if (info.has_time()) in.number(bytes);
    }
    property.name = in.name(in.number(bytes));
    if (info.metadata() == kInlineMetadata) {
      property.metadata = in.text(in.number(bytes));
    } else if (info.metadata() < metadata_.size()) {
      property.metadata = metadata_[info.metadata()];
    } else {
      in.fail("metadata with an unknown index");
    }
    property.group = file_.group(group, compound.properties.size());
    compound.properties.push_back(property);
  }
  return compound;
}

OgawaBlock AlembicArchive::sample(const AlembicProperty& property, uint32_t index) const {
  if (index >= property.stored || property.kind == AlembicProperty::Kind::kCompound) return {};
  const bool array = property.kind == AlembicProperty::Kind::kArray;  // which have sizes after each sample
  const OgawaBlock block = file_.block(property.group, array ? 2 * uint64_t{index} : index);
  if (block.size == 0) return {};
  if (block.size < kSampleKey) file_.fail("a sample is shorter than its key", block);
  return block.from(kSampleKey);
}

}  // namespace pelage
