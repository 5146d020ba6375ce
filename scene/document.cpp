// SPDX-License-Identifier: Apache-2.0
// Tested in tests/scene/include_test.cpp.
#include "scene/document.h"

#include <algorithm>
#include <system_error>
#include <unordered_map>

#include "base/file.h"
#include "scene/overrides.h"
#include "scene/yaml_reader.h"

namespace pelage {
namespace {

constexpr const char* kIncludeKey = "include";

void merge_into(Value& base, Value over);

// Entries of `over` win; what only `base` has stays, in its place.
void merge_maps(Value& base, Value& over) {
  std::unordered_map<std::string, size_t> places;
  for (size_t i = 0; i < base.entries().size(); ++i) places.emplace(base.entries()[i].key, i);
  for (Value::Entry& entry : over.entries()) {
    const auto place = places.find(entry.key);
    if (place == places.end()) {
      base.entries().push_back(std::move(entry));
    } else {
      Value::Entry& old = base.entries()[place->second];
      old.key_position = entry.key_position;
      merge_into(old.value, std::move(entry.value));
    }
  }
  base.set_position(over.position());
}

void merge_into(Value& base, Value over) {
  if (base.is_map() && over.is_map()) {
    merge_maps(base, over);
  } else {
    base = std::move(over);
  }
}

// Reads a file and what it includes, keeping track of what is being read (cycles) and has been read (limits).
class Loader {
 public:
  explicit Loader(Problems& problems) : problems_(problems) {}

  Value load(const std::filesystem::path& path, const SourcePosition& named_at) {
    if (limits_.files <= 0) {
      if (limits_.files-- == 0) {
        problems_.add(named_at,
                      "more than " + std::to_string(DocumentLimits{}.files) + " files are included");
      }
      return Value::map({}, {});
    }
    --limits_.files;
    std::string text;
    try {
      text = read_file(path, DocumentLimits{}.bytes);
    } catch (const Error& error) {
      if (named_at.file.empty()) throw;  // the scene itself
      problems_.add(named_at, error.what());
      has_holes_ = true;
      return Value::map({}, {});
    }
    std::error_code ignored;
    std::filesystem::path identity = std::filesystem::weakly_canonical(path, ignored);
    if (std::find(reading_.begin(), reading_.end(), identity) != reading_.end()) {
      problems_.add(named_at, "the file includes itself: " + path.string());
      return Value::map({}, {});
    }
    reading_.push_back(std::move(identity));
    Value value = parse(std::move(text), path.string());
    reading_.pop_back();
    return value;
  }

  Value parse(std::string text, const std::string& name) {
    std::optional<Value> root = read_yaml(std::move(text), name, {}, limits_, problems_);
    if (root && root->is_map()) return with_includes(std::move(*root));
    if (root && !root->is_null()) {
      problems_.add(root->position(), "expected a scene, a block of keys, got " + root->describe());
    }
    has_holes_ |= !root || !root->is_null();
    return Value::map({name, 1, 1}, {});
  }

  void apply(const Override& override, Value& document) {
    apply_override(override, document, limits_, problems_);
  }

  /// Whether some file could not be read, so that what seems to be missing may stand there.
  bool has_holes() const { return has_holes_; }

 private:
  Value with_includes(Value root) {
    std::vector<Value::Entry>& entries = root.entries();
    const auto include =
        std::find_if(entries.begin(), entries.end(), [](const auto& e) { return e.key == kIncludeKey; });
    if (include == entries.end()) return root;
    const Value files = std::move(include->value);
    entries.erase(include);

    Value merged = Value::map(root.position(), {});
    if (files.is_list()) {
      for (const Value& file : files.items()) merge_into(merged, load_included(file));
    } else {
      merge_into(merged, load_included(files));
    }
    merge_into(merged, std::move(root));
    return merged;
  }

  Value load_included(const Value& file) {
    if (!file.is_scalar() || file.text().empty() || file.text().find('\0') != std::string::npos) {
      problems_.add(file.position(), "expected the name of a file to include, got " + file.describe());
      return Value::map({}, {});
    }
    const std::filesystem::path folder = std::filesystem::path(file.position().file).parent_path();
    return load((folder / file.text()).lexically_normal(), file.position());
  }

  Problems& problems_;
  DocumentLimits limits_;
  bool has_holes_ = false;
  std::vector<std::filesystem::path> reading_;
};

}  // namespace

Override parse_override(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw Error(ErrorKind::kArguments, "--set " + text + ": expected a key and a value, a.b.c=value");
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

std::optional<Value> load_document(const std::filesystem::path& path, const std::vector<Override>& overrides,
                                   Problems& problems) {
  Loader loader(problems);
  Value document = loader.load(path, {});
  if (loader.has_holes()) return std::nullopt;
  for (const Override& override : overrides) loader.apply(override, document);
  return document;
}

Value load_document(const std::filesystem::path& path, const std::vector<Override>& overrides) {
  Problems problems;
  std::optional<Value> document = load_document(path, overrides, problems);
  problems.throw_if_any();
  return std::move(*document);
}

Value parse_document(const std::string& text, const std::string& name) {
  Problems problems;
  Loader loader(problems);
  Value document = loader.parse(text, name);
  problems.throw_if_any();
  return document;
}

}  // namespace pelage
