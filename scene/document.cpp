// SPDX-License-Identifier: Apache-2.0
#include "scene/document.h"

#include <algorithm>
#include <system_error>

#include "base/file.h"
#include "scene/overrides.h"
#include "scene/renamed_keys.h"
#include "scene/yaml_reader.h"

namespace pelage {
namespace {

constexpr const char* kIncludeKey = "include";

// Reads a file and its includes; keeps track of files being read (cycles) and of the total (limits).
class Loader {
 public:
  Loader(Problems& problems, RenamedKeys* renamed) : problems_(problems), renamed_(renamed) {}

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
      text = read_text_file(path, DocumentLimits{}.bytes);
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
    if (root && root->is_map()) return complete(std::move(*root));
    if (root && !root->is_null()) {
      problems_.add(root->position(), "expected a scene, which is a block of keys, got " + root->describe());
    }
    has_holes_ |= !root || !root->is_null();
    return Value::map({name, 1, 1}, {});
  }

  Value complete(Value root) {
    if (renamed_) rename_old_keys(root, *renamed_, problems_);
    return with_includes(std::move(root));
  }

  void apply(const Override& override, Value& document) {
    apply_override(override, document, limits_, problems_, renamed_);
    if (renamed_) rename_old_keys(document, *renamed_, problems_);
  }

  /// Whether some file could not be read, which might contain keys that seem to be missing.
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
  RenamedKeys* renamed_;
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
                                   Problems& problems, RenamedKeys* renamed) {
  Loader loader(problems, renamed);
  Value document = loader.load(path, {});
  if (loader.has_holes()) return std::nullopt;
  for (const Override& override : overrides) loader.apply(override, document);
  return document;
}

std::optional<Value> complete_document(Value document, const std::vector<Override>& overrides,
                                       Problems& problems, RenamedKeys* renamed) {
  if (!document.is_map()) {
    problems.add(document.position(),
                 "expected a scene, which is a block of keys, got " + document.describe());
    return std::nullopt;
  }
  Loader loader(problems, renamed);
  document = loader.complete(std::move(document));
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
  Loader loader(problems, nullptr);
  Value document = loader.parse(text, name);
  problems.throw_if_any();
  return document;
}

}  // namespace pelage
