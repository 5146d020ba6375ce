// SPDX-License-Identifier: Apache-2.0
#include "geom/alembic/alembic_writer.h"

#include <algorithm>

#include "base/version.h"

namespace pelage {
namespace {

constexpr uint32_t kMaxIndexed = 254, kInline = 255, kMaxIndexedSize = 255;
// The version of the library whose layout this is; readers refuse numbers below 9999.
constexpr int32_t kLayoutVersion = 0, kLibraryVersion = 10700;

// Bits of the header of a property.
constexpr uint32_t kScalarBits = 1, kArrayBits = 2, kSingleBit = 1, kSameSizeBit = 0x400,
                   kConstantBit = 0x800;
constexpr uint32_t kPodShift = 4, kExtentShift = 12, kMetadataShift = 20, kNumberSizeShift = 2;

uint32_t property_bits(uint32_t kind, AlembicPod pod, uint32_t extent) {
  return kind | static_cast<uint32_t>(pod) << kPodShift | extent << kExtentShift | kSameSizeBit |
         kConstantBit;
}

std::string serialized(const AlembicMetadata& metadata) {
  std::string text;
  for (const auto& [key, value] : metadata) {
    if (!value.empty()) text += (text.empty() ? "" : ";") + key + "=" + value;
  }
  return text;
}

void append(std::vector<std::byte>& to, std::span<const std::byte> bytes) {
  to.insert(to.end(), bytes.begin(), bytes.end());
}
/// Appends a number of 1, 2 or 4 bytes.
void append_number(std::vector<std::byte>& to, uint32_t value, size_t size) {
  append(to, std::as_bytes(std::span(&value, 1)).first(size));
}
void append_double(std::vector<std::byte>& to, double value) {
  append(to, std::as_bytes(std::span(&value, 1)));
}
void append_header_text(std::vector<std::byte>& to, std::string_view text) {
  append(to, std::as_bytes(std::span(text)));
}
void append_hash(std::vector<std::byte>& to, const ContentHash& hash) {
  append(to, std::as_bytes(std::span(&hash, 1)));
}
static_assert(sizeof(ContentHash) == 16, "samples have keys of 16 bytes");

template <class T>
constexpr AlembicPod kPodOf = AlembicPod::kText;
template <>
constexpr AlembicPod kPodOf<uint8_t> = AlembicPod::kUint8;
template <>
constexpr AlembicPod kPodOf<int16_t> = AlembicPod::kInt16;
template <>
constexpr AlembicPod kPodOf<int32_t> = AlembicPod::kInt32;
template <>
constexpr AlembicPod kPodOf<int64_t> = AlembicPod::kInt64;
template <>
constexpr AlembicPod kPodOf<float> = AlembicPod::kFloat;
template <>
constexpr AlembicPod kPodOf<double> = AlembicPod::kDouble;

}  // namespace

template <class T>
void AlembicCompoundWriter::scalar(const std::string& name, std::span<const T> values, uint32_t extent,
                                   const AlembicMetadata& metadata) {
  add_sample(false, name, kPodOf<T>, extent, std::as_bytes(values), true, metadata);
}
template <class T>
void AlembicCompoundWriter::array(const std::string& name, std::span<const T> values, uint32_t extent,
                                  const AlembicMetadata& metadata) {
  add_sample(true, name, kPodOf<T>, extent, std::as_bytes(values), values.size() == extent, metadata);
}
#define PELAGE_ALEMBIC_NUMBERS(T)                                                                  \
  template void AlembicCompoundWriter::scalar<T>(const std::string&, std::span<const T>, uint32_t, \
                                                 const AlembicMetadata&);                          \
  template void AlembicCompoundWriter::array<T>(const std::string&, std::span<const T>, uint32_t,  \
                                                const AlembicMetadata&)
PELAGE_ALEMBIC_NUMBERS(uint8_t);
PELAGE_ALEMBIC_NUMBERS(int16_t);
PELAGE_ALEMBIC_NUMBERS(int32_t);
PELAGE_ALEMBIC_NUMBERS(int64_t);
PELAGE_ALEMBIC_NUMBERS(float);
PELAGE_ALEMBIC_NUMBERS(double);
#undef PELAGE_ALEMBIC_NUMBERS

// Texts end with a zero.
void AlembicCompoundWriter::scalar(const std::string& name, const std::string& text,
                                   const AlembicMetadata& metadata) {
  add_sample(false, name, AlembicPod::kText, 1, std::as_bytes(std::span(text.c_str(), text.size() + 1)), true,
             metadata);
}
void AlembicCompoundWriter::array(const std::string& name, const std::string& text,
                                  const AlembicMetadata& metadata) {
  add_sample(true, name, AlembicPod::kText, 1, std::as_bytes(std::span(text.c_str(), text.size() + 1)), true,
             metadata);
}

void AlembicCompoundWriter::add(const std::string& name, const AlembicMetadata& metadata,
                                AlembicCompoundWriter&& compound) {
  append_hash(keys_, content_hash(compound.keys_));
  add_header(0, false, name, metadata, compound.finish());
}

void AlembicCompoundWriter::array(const std::string& name, size_t numbers, uint32_t extent,
                                  const AlembicMetadata& metadata,
                                  const std::function<void(const FloatSink&)>& produce) {
  OgawaWriter& out = writer_.ogawa_;
  ContentHash key;
  const uint64_t sample = out.begin(numbers == 0 ? 0 : sizeof key + numbers * sizeof(float));
  if (numbers > 0) out.append(std::as_bytes(std::span(&key, 1)));
  produce([&](std::span<const float> part) {
    // Equal arrays have equal parts.
    key = content_hash(std::as_bytes(part), key.low ^ key.high);
    out.append(std::as_bytes(part));
  });
  if (numbers > 0) out.replace(sample, 0, std::as_bytes(std::span(&key, 1)));
  add_array(name, AlembicPod::kFloat, extent, numbers == extent, sample, key, metadata);
}

void AlembicCompoundWriter::add_sample(bool array, const std::string& name, AlembicPod pod, uint32_t extent,
                                       std::span<const std::byte> bytes, bool single,
                                       const AlembicMetadata& metadata) {
  const ContentHash key = content_hash(bytes);
  const uint64_t sample =
      bytes.empty() ? writer_.ogawa_.data({}) : writer_.ogawa_.data(std::as_bytes(std::span(&key, 1)), bytes);
  if (array) return add_array(name, pod, extent, single, sample, key, metadata);
  append_hash(keys_, key);
  append_header_text(keys_, name);
  add_header(property_bits(kScalarBits, pod, extent), true, name, metadata,
             writer_.ogawa_.group({&sample, 1}));
}

void AlembicCompoundWriter::add_array(const std::string& name, AlembicPod pod, uint32_t extent, bool single,
                                      uint64_t sample, const ContentHash& key,
                                      const AlembicMetadata& metadata) {
  append_hash(keys_, key);
  append_header_text(keys_, name);
  // Sizes follow from the data, but not for texts.
  const uint64_t one = 1;
  const uint64_t words[] = {sample,
                            writer_.ogawa_.data(pod == AlembicPod::kText ? std::as_bytes(std::span(&one, 1))
                                                                         : std::span<const std::byte>())};
  add_header(property_bits(kArrayBits | (single ? kSingleBit : 0), pod, extent), true, name, metadata,
             writer_.ogawa_.group(words));
}

void AlembicCompoundWriter::add_header(uint32_t bits, bool has_samples, const std::string& name,
                                       const AlembicMetadata& metadata, uint64_t word) {
  const std::string text = serialized(metadata);
  const uint32_t index = writer_.metadata_index(text);
  const size_t longest = std::max(name.size(), text.size());
  const uint32_t number_size = longest < 256 ? 0 : longest < 65536 ? 1 : 2;
  append_number(headers_, bits | number_size << kNumberSizeShift | index << kMetadataShift, 4);
  const size_t bytes = size_t(1) << number_size;
  if (has_samples) append_number(headers_, 1, bytes);
  append_number(headers_, static_cast<uint32_t>(name.size()), bytes);
  append_header_text(headers_, name);
  if (index == kInline) {
    append_number(headers_, static_cast<uint32_t>(text.size()), bytes);
    append_header_text(headers_, text);
  }
  words_.push_back(word);
}

uint64_t AlembicCompoundWriter::finish() {
  if (!words_.empty()) words_.push_back(writer_.ogawa_.data(headers_));
  return writer_.ogawa_.group(words_);
}

void AlembicObjectWriter::add(AlembicObjectWriter&& child) {
  words_.push_back(child.finish());
  append_hash(hashes_, child.hash_);
  const std::string text = serialized(child.metadata_);
  const uint32_t index = writer_.metadata_index(text);
  append_number(headers_, static_cast<uint32_t>(child.name_.size()), 4);
  append_header_text(headers_, child.name_);
  append_number(headers_, index, 1);
  if (index == kInline) {
    append_number(headers_, static_cast<uint32_t>(text.size()), 4);
    append_header_text(headers_, text);
  }
}

uint64_t AlembicObjectWriter::finish() {
  // After the headers of the children there are hashes of the properties and of the children.
  const ContentHash own = content_hash(properties.keys_),
                    children = hashes_.empty() ? ContentHash() : content_hash(hashes_);
  append_hash(headers_, own);
  append_hash(headers_, children);
  std::vector<std::byte> all = hashes_;
  append_hash(all, own);
  append_header_text(all, name_ + serialized(metadata_));
  hash_ = content_hash(all);
  std::vector<uint64_t> words{properties.finish()};
  words.insert(words.end(), words_.begin(), words_.end());
  words.push_back(writer_.ogawa_.data(headers_));
  return writer_.ogawa_.group(words);
}

uint32_t AlembicWriter::metadata_index(const std::string& text) {
  if (text.empty()) return 0;
  if (const auto known = metadata_.find(text); known != metadata_.end()) return known->second;
  if (text.size() > kMaxIndexedSize || metadata_.size() == kMaxIndexed) return kInline;
  append_number(indexed_, static_cast<uint32_t>(text.size()), 1);
  append_header_text(indexed_, text);
  const auto index = static_cast<uint32_t>(metadata_.size() + 1);  // 0: none
  metadata_.emplace(text, index);
  return index;
}

void AlembicWriter::finish(AlembicObjectWriter&& top) {
  std::vector<uint64_t> root{ogawa_.data(std::as_bytes(std::span(&kLayoutVersion, 1))),
                             ogawa_.data(std::as_bytes(std::span(&kLibraryVersion, 1)))};
  root.push_back(top.finish());
  const std::string metadata = serialized({{"_ai_Application", std::string("Pelage ") + version()}});
  root.push_back(ogawa_.data(std::as_bytes(std::span(metadata))));
  // One time sampling: one sample at time 0, then one per second.
  std::vector<std::byte> times;
  append_number(times, 1, 4);
  append_double(times, 1);  // per second
  append_number(times, 1, 4);
  append_double(times, 0);  // the first
  root.push_back(ogawa_.data(times));
  root.push_back(ogawa_.data(indexed_));
  ogawa_.finish(ogawa_.group(root));
  file_.commit();
}

}  // namespace pelage
