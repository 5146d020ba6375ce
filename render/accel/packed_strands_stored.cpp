// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <type_traits>

#include "base/check.h"
#include "render/accel/packed_strands.h"

// Serialisation of packed strands: a sequence of numbers, and the block unchanged.
namespace pelage {
namespace {

constexpr uint32_t kMaxComponents = 16, kMaxNames = 1 << 12;
constexpr int kMaxMotionKeys = 64;

class ByteWriter {
 public:
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void put(const T& value) {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    out_.insert(out_.end(), bytes.begin(), bytes.end());
  }
  void put(const std::string& text) {
    put(static_cast<uint32_t>(text.size()));
    const auto bytes = std::as_bytes(std::span(text));
    out_.insert(out_.end(), bytes.begin(), bytes.end());
  }
  std::vector<std::byte> finish() { return std::move(out_); }

 private:
  std::vector<std::byte> out_;
};

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <class T>
  bool get(T& value) {
    if (rest_.size() < sizeof(T)) return false;
    std::memcpy(&value, rest_.data(), sizeof(T));
    rest_ = rest_.subspan(sizeof(T));
    return true;
  }
  bool get(bool& value) {
    uint8_t byte = 0;
    if (!get(byte) || byte > 1) return false;
    value = byte == 1;
    return true;
  }
  bool get(std::string& text) {
    uint32_t size = 0;
    if (!get(size) || size > kMaxNames || size > rest_.size()) return false;
    text.assign(reinterpret_cast<const char*>(rest_.data()), size);
    rest_ = rest_.subspan(size);
    return true;
  }
  bool at_end() const { return rest_.empty(); }

 private:
  std::span<const std::byte> rest_;
};

/// Whether `count` numbers of `size` bytes are within the block and aligned.
bool lies_within(size_t offset, size_t count, size_t size, size_t bytes) {
  return offset <= bytes && offset % size == 0 && count <= (bytes - offset) / size;
}

}  // namespace

/// Calls use(member) for everything except the block and the attributes.
template <class Packed, class Use>
void PackedStrands::for_each_number(Packed& packed, const Use& use) {
  use(packed.strand_count_), use(packed.segment_count_), use(packed.vertex_count_), use(packed.first_id_);
  use(packed.ids_), use(packed.faces_), use(packed.first_segments_);
  use(packed.segments_per_strand_), use(packed.extra_), use(packed.phantoms_), use(packed.first_face_);
  use(packed.motion_keys_), use(packed.basis_);
  use(packed.opaque_), use(packed.wide_ids_), use(packed.has_roots_), use(packed.wide_faces_);
  use(packed.has_root_uv_);
  for (auto* values : {&packed.root_place_, &packed.root_uv_, &packed.opacity_}) {
    use(values->offset), use(values->precision), use(values->frequency), use(values->components);
  }
}

std::vector<std::byte> PackedStrands::stored_head() const {
  PELAGE_CHECK(!segments_);
  ByteWriter writer;
  for_each_number(*this, [&](const auto& number) { writer.put(number); });
  writer.put(static_cast<uint32_t>(attributes_.size()));
  for (const Attribute& attribute : attributes_) {
    writer.put(attribute.name);
    const Values& values = attribute.values;
    writer.put(values.offset), writer.put(values.precision), writer.put(values.frequency);
    writer.put(values.components);
  }
  return writer.finish();
}

std::optional<PackedStrands> PackedStrands::from_stored(std::span<const std::byte> head, PageBlock block) {
  PackedStrands packed;
  ByteReader reader(head);
  bool good = true;
  for_each_number(packed, [&](auto& number) { good = good && reader.get(number); });
  uint32_t attributes = 0;
  good = good && reader.get(attributes) && attributes <= kMaxNames;
  for (uint32_t i = 0; good && i < attributes; ++i) {
    Attribute attribute;
    Values& values = attribute.values;
    good = reader.get(attribute.name) && reader.get(values.offset) && reader.get(values.precision) &&
           reader.get(values.frequency) && reader.get(values.components);
    packed.attributes_.push_back(std::move(attribute));
  }
  packed.block_ = std::move(block);
  if (!good || !reader.at_end() || !packed.is_possible()) return {};
  return packed;
}

bool PackedStrands::is_possible() const {
  constexpr size_t kMax = UINT32_MAX;
  const size_t bytes = block_.bytes();
  if (strand_count_ > kMax || segment_count_ > kMax) return false;
  if (motion_keys_ < 1 || motion_keys_ > kMaxMotionKeys) return false;
  if (basis_ > CurveBasis::kCatmullRom || extra_ != (basis_ == CurveBasis::kLinear ? 1 : 3)) return false;
  const bool pinned = basis_ == CurveBasis::kPinnedBSpline || basis_ == CurveBasis::kCatmullRom;
  if (phantoms_ != (pinned ? 2 : 0)) return false;
  if (!lies_within(ids_, strand_count_, wide_ids_ ? 8 : 4, bytes)) return false;
  if (has_roots_ && !lies_within(faces_, strand_count_, wide_faces_ ? 4 : 2, bytes)) return false;
  if (segments_per_strand_ != 0) {
    if (segments_per_strand_ * strand_count_ != segment_count_) return false;
  } else {
    if (!lies_within(first_segments_, strand_count_ + 1, 4, bytes)) return false;
    const auto* first = at<uint32_t>(first_segments_);
    for (size_t s = 0; s < strand_count_; ++s) {
      if (first[s + 1] <= first[s]) return false;
    }
    if (first[0] != 0 || first[strand_count_] != segment_count_) return false;
  }
  const size_t points = segment_count_ + size_t(extra_ - phantoms_) * strand_count_;
  const auto fits = [&](const Values& values) {
    if (values.precision > Precision::kUnorm8) return false;
    if (values.components < 1 || values.components > kMaxComponents) return false;
    size_t count = values.components;
    if (values.frequency == AttributeClass::kPerStrand) {
      count *= strand_count_;
    } else if (values.frequency == AttributeClass::kPerPoint) {
      count *= points;
    } else if (values.frequency != AttributeClass::kConstant) {
      return false;
    }
    return lies_within(values.offset, count, precision_bytes(values.precision), bytes);
  };
  if (has_roots_ && (!fits(root_place_) || root_place_.components != 2)) return false;
  if (has_root_uv_ && (!fits(root_uv_) || root_uv_.components != 2)) return false;
  if (!opaque_ && (!fits(opacity_) || opacity_.components != 1)) return false;
  for (const Attribute& attribute : attributes_) {
    if (!fits(attribute.values)) return false;
  }
  return true;
}

}  // namespace pelage
