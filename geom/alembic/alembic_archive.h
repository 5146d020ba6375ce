// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "geom/alembic/ogawa_file.h"

namespace pelage {

/// Types of numbers, as the files number them.
enum class AlembicPod : uint8_t {
  kBool,
  kUint8,
  kInt8,
  kUint16,
  kInt16,
  kUint32,
  kInt32,
  kUint64,
  kInt64,
  kHalf,
  kFloat,
  kDouble,
  kText,
  kWideText
};
/// Bytes of a number; 0 for texts.
size_t alembic_pod_bytes(AlembicPod pod);

/// The texts are valid as long as the archive.
struct AlembicProperty {
  enum class Kind { kCompound, kScalar, kArray };
  std::string_view name, metadata;
  Kind kind = Kind::kCompound;
  AlembicPod pod = AlembicPod::kUint8;
  uint32_t extent = 1;  ///< numbers per element
  /// Samples in the file, of which the first is the earliest. Equal samples at the end are stored once.
  uint32_t stored = 0;
  OgawaGroup group;
};
struct AlembicObject {
  std::string_view name, metadata;
  OgawaGroup group;
};

/// The properties of an object or of a compound property.
class AlembicCompound {
 public:
  std::vector<AlembicProperty> properties;
  /// Returns the property of this name; null if there is none.
  const AlembicProperty* find(std::string_view name) const;
};

/// Returns the value of a key in metadata ("key=value;key=value"); empty if the key is missing.
std::string_view alembic_metadata(std::string_view metadata, std::string_view key);

/// The objects and properties of an Alembic file. Members throw Error (kInput) with the position in bytes
/// where the file is malformed, or has names of more than 64 KiB or with control characters. They also throw
/// after they have parsed 16 times as many bytes of headers as the file has: only objects and properties that
/// share their headers need so many, and no library writes such files. For use by one thread.
class AlembicArchive {
 public:
  explicit AlembicArchive(const std::filesystem::path& path);

  const OgawaFile& file() const { return file_; }
  const AlembicObject& top() const { return top_; }
  std::vector<AlembicObject> children(const AlembicObject& object) const;
  AlembicCompound properties(const AlembicObject& object) const;
  AlembicCompound compound(const AlembicProperty& property) const;
  /// Returns the bytes of a stored sample, without the key before them; empty if there is no such sample.
  /// Does not read them.
  OgawaBlock sample(const AlembicProperty& property, uint32_t index = 0) const;

 private:
  AlembicCompound compound_of(const OgawaGroup& group) const;
  void count_headers(const OgawaBlock& headers) const;
  void read_indexed_metadata(const OgawaBlock& block);

  OgawaFile file_;
  AlembicObject top_;
  std::vector<std::string_view> metadata_;  // which headers name by index
  mutable uint64_t header_bytes_ = 0;
};

}  // namespace pelage
