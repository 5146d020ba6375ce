// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/schema.h"
#include "base/vector.h"

// ValueReaders for the basic types of scene files. See base/schema.h.

namespace pelage {

/// Parses a finite decimal number: 12, -0.5, 1e6, 1_000. Returns an empty value for any other text.
std::optional<double> parse_number(std::string_view text);
/// Parses a number of bytes with an optional suffix K, M, G or T (powers of 1024), which may be followed by B
/// or iB: 512M, 1.5GB. Returns an empty value for any other text.
std::optional<uint64_t> parse_bytes(std::string_view text);

/// A file that a scene names, or data of the host in its place, and the position of this name, for errors
/// about the file. A relative path starts at the folder of the file that contains the name or, for names on
/// the command line, at the current folder.
struct AssetPath {
  std::filesystem::path path;  ///< of a file, or the name of `data`
  SourcePosition position;
  std::shared_ptr<const HostData> data = nullptr;  ///< null: a file
  bool empty() const { return path.empty(); }
};

/// The name of another item of the scene, such as a material, and the position where this name is used, for
/// error messages.
struct NameReference {
  std::string name;
  SourcePosition position;
};

/// A number of bytes, which a scene writes as 512M or 4G (powers of 1024).
struct ByteSize {
  uint64_t bytes = 0;
};

/// A map from names that the user chooses to values, in the order of the file.
template <class T>
struct Named {
  struct Item {
    std::string name;
    SourcePosition position;
    T value;
  };
  std::vector<Item> items;

  /// Returns the item with this name, or nullptr.
  const Item* find(std::string_view name) const {
    for (const Item& item : items) {
      if (item.name == name) return &item;
    }
    return nullptr;
  }
  std::vector<std::string> names() const {
    std::vector<std::string> result;
    for (const Item& item : items) result.push_back(item.name);
    return result;
  }
};

/// Names of an enumeration's values in the scene file (kebab-case), ordered by value from 0. Specialise
/// EnumNames for each enumeration:
///   template <>
///   struct EnumNames<Filter> {
///     static constexpr const char* names[] = {"box", "blackman-harris"};
///   };
template <class E>
struct EnumNames;

template <>
struct ValueReader<double> {
  static bool read(const Value&, const KeyOptions&, double& out, Problems&);
  static std::string type_name() { return "number"; }
  static std::string print(const double& v);
};
template <>
struct ValueReader<float> {
  static bool read(const Value&, const KeyOptions&, float& out, Problems&);
  static std::string type_name() { return "number"; }
  static std::string print(const float& v);
};
/// Reads whole numbers. Accepts `1e6` and `1_000`, but not `1.5`.
template <>
struct ValueReader<int64_t> {
  static bool read(const Value&, const KeyOptions&, int64_t& out, Problems&);
  static std::string type_name() { return "integer"; }
  static std::string print(const int64_t& v);
};
template <>
struct ValueReader<int> {
  static bool read(const Value&, const KeyOptions&, int& out, Problems&);
  static std::string type_name() { return "integer"; }
  static std::string print(const int& v);
};
template <>
struct ValueReader<bool> {
  static bool read(const Value&, const KeyOptions&, bool& out, Problems&);
  static std::string type_name() { return "true or false"; }
  static std::string print(const bool& v);
};
template <>
struct ValueReader<std::string> {
  static bool read(const Value&, const KeyOptions&, std::string& out, Problems&);
  static std::string type_name() { return "text"; }
  static std::string print(const std::string& v);
};
template <>
struct ValueReader<AssetPath> {
  static bool read(const Value&, const KeyOptions&, AssetPath& out, Problems&);
  static std::string type_name() { return "file"; }
  static std::string print(const AssetPath& v);
  static void add_files(const AssetPath& v, std::vector<std::filesystem::path>& files) {
    if (!v.empty() && !v.data) files.push_back(v.path);
  }
};
template <>
struct ValueReader<NameReference> {
  static bool read(const Value&, const KeyOptions&, NameReference& out, Problems&);
  static std::string type_name() { return "name"; }
  static std::string print(const NameReference& v) { return v.name.empty() ? "none" : v.name; }
};
template <>
struct ValueReader<ByteSize> {
  static bool read(const Value&, const KeyOptions&, ByteSize& out, Problems&);
  static std::string type_name() { return "bytes"; }
  static std::string print(const ByteSize& v);
};
template <>
struct ValueReader<V2f> {
  static bool read(const Value&, const KeyOptions&, V2f& out, Problems&);
  static std::string type_name() { return "2 numbers"; }
  static std::string print(const V2f& v);
};
template <>
struct ValueReader<V3f> {
  static bool read(const Value&, const KeyOptions&, V3f& out, Problems&);
  static std::string type_name() { return "3 numbers"; }
  static std::string print(const V3f& v);
};
/// Reads three numbers, or one number for all three channels.
template <>
struct ValueReader<Rgb> {
  static bool read(const Value&, const KeyOptions&, Rgb& out, Problems&);
  static std::string type_name() { return "colour"; }
  static std::string print(const Rgb& v);
};

namespace detail {
bool read_enum(const Value&, std::span<const char* const> names, const KeyOptions&, int& out, Problems&);
std::string enum_type_name(std::span<const char* const> names);
/// Returns the value of `key`, which selects the kind of a block. If this value is missing or not one of
/// `kinds`, returns nullptr and adds a problem.
const Value* find_type(const Value& block, const char* key, std::span<const std::string> kinds, Problems&);
}  // namespace detail

template <class E>
struct ValueReader<E, std::enable_if_t<std::is_enum_v<E>>> {
  static bool read(const Value& value, const KeyOptions& options, E& out, Problems& problems) {
    int index = 0;
    if (!detail::read_enum(value, EnumNames<E>::names, options, index, problems)) return false;
    out = static_cast<E>(index);
    return true;
  }
  static std::string type_name() { return detail::enum_type_name(EnumNames<E>::names); }
  static std::string print(const E& v) { return EnumNames<E>::names[static_cast<int>(v)]; }
};

template <class T>
struct ValueReader<std::optional<T>> {
  /// Reads null as an empty value. Thus `--set camera.lens=null` removes the value that the file sets.
  static bool read(const Value& value, const KeyOptions& options, std::optional<T>& out, Problems& problems) {
    if (value.is_null()) {
      out.reset();
      return true;
    }
    T inner{};
    if (!ValueReader<T>::read(value, options, inner, problems)) return false;
    out = std::move(inner);
    return true;
  }
  static std::string type_name() { return ValueReader<T>::type_name(); }
  static std::string print(const std::optional<T>& v) { return v ? ValueReader<T>::print(*v) : "none"; }
  static void describe(const std::optional<T>& v, const std::string& key, std::vector<ParameterText>& out) {
    if (v) {
      detail::describe_value(*v, key, out);
    } else {
      out.push_back({key, "none", {}});
    }
  }
  static std::vector<const SchemaInfo*> blocks() { return detail::blocks_of<T>(); }
  static void visit_blocks(Value& value, const BlockVisitor& visit) {
    if (!value.is_null()) detail::visit_blocks<T>(value, visit);
  }
};

template <class T>
struct ValueReader<std::vector<T>> {
  static bool read(const Value& value, const KeyOptions& options, std::vector<T>& out, Problems& problems) {
    if (!value.is_list()) {
      problems.add(value.position(), "expected " + type_name() + ", got " + value.describe());
      return false;
    }
    std::vector<T> items(value.items().size());
    bool good = true;
    for (size_t i = 0; i < items.size(); ++i) {
      good &= ValueReader<T>::read(value.items()[i], options, items[i], problems);
    }
    if (good) out = std::move(items);
    return good;
  }
  static std::string type_name() { return "list of " + ValueReader<T>::type_name(); }
  static std::string print(const std::vector<T>& v) {
    std::string text = "[";
    for (size_t i = 0; i < v.size(); ++i) text += (i ? ", " : "") + ValueReader<T>::print(v[i]);
    return text + "]";
  }
  static void describe(const std::vector<T>& v, const std::string& key, std::vector<ParameterText>& out) {
    out.push_back({key, std::to_string(v.size()), {}});
    for (size_t i = 0; i < v.size(); ++i)
      detail::describe_value(v[i], key + "[" + std::to_string(i) + "]", out);
  }
  static std::vector<const SchemaInfo*> blocks() { return detail::blocks_of<T>(); }
  static void visit_blocks(Value& value, const BlockVisitor& visit) {
    for (Value& item : value.items()) detail::visit_blocks<T>(item, visit);
  }
};

template <class T>
struct ValueReader<Named<T>> {
  static bool read(const Value& value, const KeyOptions& options, Named<T>& out, Problems& problems) {
    if (!value.is_map()) {
      problems.add(value.position(), "expected " + type_name() + ", got " + value.describe());
      return false;
    }
    bool good = true;
    Named<T> result;
    for (const Value::Entry& entry : value.entries()) {
      result.items.push_back({entry.key, entry.key_position, T{}});
      good &= ValueReader<T>::read(entry.value, options, result.items.back().value, problems);
    }
    out = std::move(result);
    return good;
  }
  static std::string type_name() { return "map of names to " + ValueReader<T>::type_name(); }
  static std::string print(const Named<T>&) { return "{}"; }
  static std::vector<const SchemaInfo*> blocks() { return detail::blocks_of<T>(); }
  static void visit_blocks(Value& value, const BlockVisitor& visit) {
    for (Value::Entry& entry : value.entries()) detail::visit_blocks<T>(entry.value, visit);
  }
};

/// Reads a block of one of several kinds. One key of the block names its kind. Each P has, besides schema(),
///   static constexpr const char* kTypeKey = "type";     // this key; all Ps must have the same one
///   static constexpr const char* kTypeName = "sphere";  // the value of this key for P
template <class... Ps>
struct ValueReader<std::variant<Ps...>> {
  using Variant = std::variant<Ps...>;
  static bool read(const Value& value, const KeyOptions&, Variant& out, Problems& problems) {
    const std::vector<std::string> kinds{Ps::kTypeName...};
    const char* key = std::variant_alternative_t<0, Variant>::kTypeKey;
    const Value* type = detail::find_type(value, key, kinds, problems);
    if (!type) return false;
    bool good = false;
    ((type->text() == Ps::kTypeName ? void(good = read_as<Ps>(value, key, out, problems)) : void(0)), ...);
    return good;
  }
  static std::string type_name() {
    std::string names;
    ((names += (names.empty() ? "" : " | ") + std::string(Ps::kTypeName)), ...);
    return "block with " + std::string(std::variant_alternative_t<0, Variant>::kTypeKey) + ": " + names;
  }
  static std::string print(const Variant&) { return "{}"; }
  static std::vector<const SchemaInfo*> blocks() { return {&Ps::schema()...}; }
  static void visit_blocks(Value& value, const BlockVisitor& visit) {
    const Value* type = value.find(std::variant_alternative_t<0, Variant>::kTypeKey);
    if (type) ((type->text() == Ps::kTypeName ? visit(value, Ps::schema()) : void(0)), ...);
  }

 private:
  template <class P>
  static bool read_as(const Value& value, const char* key, Variant& out, Problems& problems) {
    P params;
    if (!P::schema().read(value, params, problems, key)) return false;
    out = std::move(params);
    return true;
  }
};

}  // namespace pelage
