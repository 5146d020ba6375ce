// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"

namespace pelage {

/// A part of the text of a layer.
struct UsdText {
  size_t begin = 0, end = 0;
  bool empty() const { return begin == end; }
};

/// An attribute as a layer states it. Values stay text until they are needed.
struct UsdAttribute {
  std::string type;  ///< without [], such as point3f
  std::string name;  ///< with its namespaces, such as primvars:st
  bool is_array = false;
  UsdText value;                                  ///< empty: none, or None
  std::vector<std::pair<double, UsdText>> times;  ///< time samples in the order of the file
  std::string interpolation;                      ///< empty: not stated
  int element_size = 1;
  size_t place = 0;  ///< of its name in the text
};

/// A reference, payload or sublayer.
struct UsdArc {
  std::string asset;  ///< empty: this layer
  std::string path;   ///< of the prim; empty: the default prim
  size_t place = 0;
};

/// What a layer states about a prim, or about a variant of a prim.
struct UsdPrimSpec {
  std::string specifier;  ///< def, over or class
  std::string type;       ///< such as Mesh; empty: not stated
  std::string name;
  size_t place = 0;
  bool active = true, has_active = false;
  std::vector<UsdArc> references, payloads;
  std::vector<std::string> inherits, specializes;  ///< paths of prims
  std::map<std::string, std::string> selections;
  std::map<std::string, std::vector<UsdPrimSpec>> variant_sets;
  std::vector<UsdAttribute> attributes;
  std::vector<UsdPrimSpec> children;
  std::map<std::string, size_t, std::less<>> attribute_index, child_index;

  const UsdAttribute* find(std::string_view attribute) const;
  const UsdPrimSpec* child(std::string_view child_name) const;
};

/// A layer of USD: one .usda file. Immutable. Thread safety: const members may be called from any thread.
class UsdLayer {
 public:
  /// Reads and parses a file, and keeps its text: values stay text until they are needed, and a program may
  /// change the file in the meantime. Throws Error (kInput) with line and column for mistakes of its syntax,
  /// for text that is nested deeper than 64 levels, and for more than a million prims and attributes. Names
  /// the command that converts a binary file.
  explicit UsdLayer(const std::filesystem::path& path);
  /// Parses a text that is in memory and outlives the layer. `path`: for messages.
  UsdLayer(const std::filesystem::path& path, std::string_view text);

  const std::filesystem::path& path() const { return path_; }
  std::string_view text() const { return text_; }
  std::string_view text(const UsdText& part) const { return text_.substr(part.begin, part.end - part.begin); }
  /// Returns the line and column of a place in the text.
  SourcePosition position(size_t place) const;
  [[noreturn]] void fail(size_t place, const std::string& message) const;

  const std::vector<UsdArc>& sublayers() const { return sublayers_; }
  const std::string& default_prim() const { return default_prim_; }
  bool is_z_up() const { return z_up_; }
  double meters_per_unit() const { return meters_per_unit_; }
  /// The root of all prims of this layer, without a name.
  const UsdPrimSpec& root() const { return root_; }

 private:
  friend class UsdaParser;
  void parse();
  void mark_lines() const;

  /// What comes before a part of the text.
  struct LineMark {
    size_t lines = 0, line_begin = 0;
  };

  std::filesystem::path path_;
  const std::string contents_;  // of the file
  std::string_view text_;
  std::vector<UsdArc> sublayers_;
  std::string default_prim_;
  bool z_up_ = false;
  double meters_per_unit_ = 0.01;
  UsdPrimSpec root_;
  mutable std::once_flag marked_;
  mutable std::vector<LineMark> marks_;  // set once
};

}  // namespace pelage
