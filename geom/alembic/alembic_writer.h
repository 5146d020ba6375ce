// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/file.h"
#include "geom/alembic/alembic_archive.h"
#include "geom/alembic/ogawa_writer.h"

namespace pelage {

/// Metadata of objects and properties. Texts must not contain ';' or '='.
using AlembicMetadata = std::map<std::string, std::string>;

class AlembicWriter;

/// A compound property under construction. Values are written at once, headers when the compound ends. Each
/// property has one sample.
class AlembicCompoundWriter {
 public:
  explicit AlembicCompoundWriter(AlembicWriter& writer) : writer_(writer) {}

  /// Add a property. `values`: `extent` numbers per element; a scalar has one element.
  template <class T>
  void scalar(const std::string& name, std::span<const T> values, uint32_t extent = 1,
              const AlembicMetadata& metadata = {});
  template <class T>
  void array(const std::string& name, std::span<const T> values, uint32_t extent = 1,
             const AlembicMetadata& metadata = {});
  /// Adds an array of so many numbers, which `produce` passes to its argument in parts.
  using FloatSink = std::function<void(std::span<const float>)>;
  void array(const std::string& name, size_t numbers, uint32_t extent, const AlembicMetadata& metadata,
             const std::function<void(const FloatSink&)>& produce);
  void scalar(const std::string& name, const std::string& text, const AlembicMetadata& metadata = {});
  void array(const std::string& name, const std::string& text, const AlembicMetadata& metadata = {});
  /// Ends another compound, and adds it.
  void add(const std::string& name, const AlembicMetadata& metadata, AlembicCompoundWriter&& compound);

 private:
  friend class AlembicObjectWriter;
  void add_array(const std::string& name, AlembicPod pod, uint32_t extent, bool single, uint64_t sample,
                 const ContentHash& key, const AlembicMetadata& metadata);
  void add_sample(bool array, const std::string& name, AlembicPod pod, uint32_t extent,
                  std::span<const std::byte> bytes, bool single, const AlembicMetadata& metadata);
  void add_header(uint32_t bits, bool has_samples, const std::string& name, const AlembicMetadata& metadata,
                  uint64_t word);
  uint64_t finish();

  AlembicWriter& writer_;
  std::vector<std::byte> headers_;
  std::vector<uint64_t> words_;
  std::vector<std::byte> keys_;  // of all samples, for the hash of the compound
};

/// An object under construction. Its children are written before it.
class AlembicObjectWriter {
 public:
  AlembicObjectWriter(AlembicWriter& writer, std::string name, const AlembicMetadata& metadata)
      : properties(writer), writer_(writer), name_(std::move(name)), metadata_(metadata) {}

  AlembicCompoundWriter properties;
  /// Ends another object, and adds it as a child.
  void add(AlembicObjectWriter&& child);

 private:
  friend class AlembicWriter;
  uint64_t finish();

  AlembicWriter& writer_;
  const std::string name_;
  const AlembicMetadata metadata_;
  std::vector<std::byte> headers_;
  std::vector<uint64_t> words_;
  std::vector<std::byte> hashes_;  // of the children
  ContentHash hash_;               // after finish()
};

/// An Alembic file under construction. It appears when it is finished, or not at all. Members, also those of
/// objects and compounds, throw Error (kFailed) as AtomicFile does.
class AlembicWriter {
 public:
  explicit AlembicWriter(const std::filesystem::path& path) : file_(path), ogawa_(file_) {}

  /// Ends the top object, and the file.
  void finish(AlembicObjectWriter&& top);

 private:
  friend class AlembicCompoundWriter;
  friend class AlembicObjectWriter;
  /// Returns the index of metadata for headers; 255 if they contain the text itself.
  uint32_t metadata_index(const std::string& text);

  AtomicFile file_;
  OgawaWriter ogawa_;
  std::map<std::string, uint32_t> metadata_;
  std::vector<std::byte> indexed_;
};

}  // namespace pelage
