// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/check.h"
#include "base/error.h"
#include "base/value.h"

namespace pelage {

// Validation of the scene file. Each kind of block has a `Params` struct and one table of its keys:
//
//   struct CurlParams {
//     Field radius{0.05f};
//     float turns = 2;
//     static const Schema<CurlParams>& schema();
//   };
//
//   const Schema<CurlParams>& CurlParams::schema() {
//     static const Schema<CurlParams> table = [] {
//       Schema<CurlParams> s("curl", "Winds each strand into a helix about itself.");
//       s.key("radius", &CurlParams::radius, {.unit = "scene units", .help = "Of the helix", .min = 0});
//       s.key("turns", &CurlParams::turns, {.help = "Turns from root to tip"});
//       return s;
//     }();
//     return table;
//   }
//
// The table validates documents, fills the struct and prints the manual. An unknown key is reported with the
// nearest known key. A default-constructed Params holds the defaults. Each member is read by the ValueReader
// of its type. base/value_readers.h has ValueReaders for numbers, strings, vectors, paths, enumerations,
// lists and maps; other folders add more.

/// A key or a value of a key that an earlier release had. Texts are literals.
struct Removed {
  std::string_view name;    ///< of the key, or the value
  std::string_view advice;  ///< the end of "was removed: ..."
  /// Value of a removed key that scenes may still set, because Pelage always does what it meant; "": none.
  std::string_view harmless = {};
};

/// Constraints on a key's value, and its description in the manual. Texts are literals.
struct KeyOptions {
  std::string_view unit = {};
  std::string_view help = {};
  bool required = false;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool above_min = false;              ///< whether values must be greater than min, not equal to it
  std::string_view default_text = {};  ///< shown instead of the printed default, e.g. "see render"
  std::array<std::string_view, 2> old_names = {};  ///< names of this key in earlier releases, or ""
  Removed removed = {};                            ///< value of an enumeration in earlier releases
  bool written = false;  ///< whether the value is a folder in which Pelage writes files
};

class SchemaInfo;

/// Called with a block of a document and the table that reads this block.
using BlockVisitor = std::function<void(Value&, const SchemaInfo&)>;

/// One key of a table, as the manual describes it.
struct KeyInfo {
  std::string name;
  std::string type;
  std::string default_text;
  KeyOptions options;
  std::vector<const SchemaInfo*> blocks;  ///< tables of the blocks that a value of this key may contain
  /// Calls the visitor for each block directly under a value of this key; for none if the value is malformed.
  void (*visit_blocks)(Value&, const BlockVisitor&);

  bool has_old_name(std::string_view old_name) const;
};

/// One parameter as text: a key such as "levels[0].amount", and a value such as "{map: fur/amount.png,
/// channel: r}". `files` are the files whose contents are part of the value.
struct ParameterText {
  /// An image that is looked up by texture coordinates, and the position in the scene that names the image.
  struct Map {
    std::filesystem::path file;
    SourcePosition position;
  };

  std::string key;
  std::string text;
  std::vector<std::filesystem::path> files = {};
  std::vector<Map> maps = {};  ///< maps among the entries of `files`
};

/// Returns the range of allowed values: "0 .. 1", "> 0", or "" when there are no limits.
std::string range_text(const KeyOptions& options);

namespace detail {
struct ValueType;
}

/// A table of keys without the types of the struct's members. This is all that the manual needs.
class SchemaInfo {
 public:
  SchemaInfo(std::string name, std::string help) : name_(std::move(name)), help_(std::move(help)) {}
  const std::string& name() const { return name_; }
  const std::string& help() const { return help_; }
  const std::vector<KeyInfo>& keys() const { return keys_; }
  std::vector<std::string> key_names() const;
  /// Returns the key whose present name is `name`, or nullptr.
  const KeyInfo* find(std::string_view name) const;
  /// Returns the key of which `old_name` is a former name, or nullptr.
  const KeyInfo* find_renamed(std::string_view old_name) const;
  /// Adds a key that this table no longer has. A scene that sets it is told so.
  void remove(const Removed& key) { removed_.push_back(key); }
  const std::vector<Removed>& removed() const { return removed_; }

  /// Excerpt of a scene file that uses this block, with all enclosing keys. The manual prints it; a test
  /// parses it.
  const std::string& example() const { return example_; }
  void set_example(std::string yaml) { example_ = std::move(yaml); }
  /// Caption of the block's picture in the manual, or "" when there is no picture.
  const std::string& picture() const { return picture_; }
  void set_picture(std::string caption) { picture_ = std::move(caption); }

 protected:
  /// Adds a key whose values are `offset` bytes behind the start of the params struct.
  void add_key(std::string_view name, const detail::ValueType& type, size_t offset, const void* default_value,
               const KeyOptions& options);
  std::vector<ParameterText> describe_members(const void* params, const std::string& prefix) const;
  bool read_members(const Value& value, void* params, Problems& problems, std::string_view skip) const;

 private:
  struct Member {
    const detail::ValueType* type;
    size_t offset;
  };
  std::string name_;
  std::string help_;
  std::string example_;
  std::string picture_;
  std::vector<KeyInfo> keys_;
  std::vector<Member> members_;  ///< one per key
  std::vector<Removed> removed_;
};

/// Reads a T from a Value. Specialisations provide
///   // Returns false and adds a problem when the value is not a T.
///   static bool read(const Value&, const KeyOptions&, T& out, Problems&);
///   // Returns the type for the manual and for messages.
///   static std::string type_name();
///   // Returns the value as a scene file would write it.
///   static std::string print(const T&);
/// and optionally
///   // Returns the tables of the blocks that a T may contain.
///   static std::vector<const SchemaInfo*> blocks();
///   // Visits these blocks in a value. The value may be malformed.
///   static void visit_blocks(Value&, const BlockVisitor&);
///   // Adds the files whose contents are part of the value.
///   static void add_files(const T&, std::vector<std::filesystem::path>&);
///   // Adds the images that the value looks up by texture coordinates.
///   static void add_maps(const T&, std::vector<ParameterText::Map>&);
///   // Describes a value completely as parameters; needed if print() does not describe it completely.
///   static void describe(const T&, const std::string& key, std::vector<ParameterText>& out);
template <class T, class Enable = void>
struct ValueReader;

namespace detail {
template <class T>
std::vector<const SchemaInfo*> blocks_of() {
  if constexpr (requires { ValueReader<T>::blocks(); }) {
    return ValueReader<T>::blocks();
  } else {
    return {};
  }
}
template <class T>
void visit_blocks(Value& value, const BlockVisitor& visit) {
  if constexpr (requires { ValueReader<T>::visit_blocks(value, visit); })
    ValueReader<T>::visit_blocks(value, visit);
}
template <class T>
void describe_value(const T& value, const std::string& key, std::vector<ParameterText>& out) {
  if constexpr (requires { ValueReader<T>::describe(value, key, out); }) {
    ValueReader<T>::describe(value, key, out);
  } else {
    ParameterText one{key, ValueReader<T>::print(value), {}};
    PELAGE_CHECK(one.text != "{}");  // print() of a map or a variant does not describe its contents
    if constexpr (requires { ValueReader<T>::add_files(value, one.files); })
      ValueReader<T>::add_files(value, one.files);
    if constexpr (requires { ValueReader<T>::add_maps(value, one.maps); })
      ValueReader<T>::add_maps(value, one.maps);
    out.push_back(std::move(one));
  }
}

/// The functions of ValueReader<T> for a T behind a pointer. A table reads all members through these, so that
/// each type is compiled once, not once per key.
struct ValueType {
  bool (*read)(const Value&, const KeyOptions&, void* out, Problems&);
  std::string (*type_name)();
  std::string (*print)(const void*);
  void (*describe)(const void*, const std::string& key, std::vector<ParameterText>& out);
  std::vector<const SchemaInfo*> (*blocks)();
  void (*visit_blocks)(Value&, const BlockVisitor&);
};
template <class T>
inline constexpr ValueType kValueType{
    [](const Value& value, const KeyOptions& options, void* out, Problems& problems) {
      return ValueReader<T>::read(value, options, *static_cast<T*>(out), problems);
    },
    [] { return ValueReader<T>::type_name(); },
    [](const void* value) { return ValueReader<T>::print(*static_cast<const T*>(value)); },
    [](const void* value, const std::string& key, std::vector<ParameterText>& out) {
      describe_value(*static_cast<const T*>(value), key, out);
    },
    blocks_of<T>,
    visit_blocks<T>};
}  // namespace detail

/// The table of keys of a params struct P.
template <class P>
class Schema : public SchemaInfo {
 public:
  using SchemaInfo::SchemaInfo;

  /// Adds the key `name`, which sets `member`. Returns this table.
  template <class T>
  Schema& key(std::string_view name, T P::*member, const KeyOptions& options) {
    const P& defaults = default_params();
    const T* value = &(defaults.*member);
    add_key(name, detail::kValueType<T>,
            reinterpret_cast<const char*>(value) - reinterpret_cast<const char*>(&defaults), value, options);
    return *this;
  }

  /// Returns all parameters as text, in the order of the table. Different structs have different texts.
  std::vector<ParameterText> describe(const P& params, const std::string& prefix = {}) const {
    return describe_members(&params, prefix);
  }

  /// Fills `out` from a map. Adds a problem for every unknown key, every missing required key and every
  /// malformed value. Ignores the key `skip`, which another table reads, such as the `type` of a light.
  /// Returns whether it added no problem.
  bool read(const Value& value, P& out, Problems& problems, std::string_view skip = {}) const {
    return read_members(value, &out, problems, skip);
  }

 private:
  static const P& default_params() {
    static const P params = P();
    return params;
  }
};

/// Reads a struct P that has a table of keys (P::schema()). With this reader, a key's value can be a block.
template <class P>
struct ValueReader<P, std::void_t<decltype(P::schema())>> {
  static bool read(const Value& value, const KeyOptions&, P& out, Problems& problems) {
    return P::schema().read(value, out, problems);
  }
  static std::string type_name() { return "block " + P::schema().name(); }
  static std::string print(const P&) { return "{}"; }
  static void describe(const P& params, const std::string& key, std::vector<ParameterText>& out) {
    for (ParameterText& text : P::schema().describe(params, key + ".")) out.push_back(std::move(text));
  }
  static std::vector<const SchemaInfo*> blocks() { return {&P::schema()}; }
  static void visit_blocks(Value& value, const BlockVisitor& visit) { visit(value, P::schema()); }
};

}  // namespace pelage
