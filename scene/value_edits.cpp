// SPDX-License-Identifier: Apache-2.0
#include "scene/value_edits.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "base/file.h"
#include "scene/document_hash.h"
#include "scene/yaml_reader.h"

namespace pelage {
namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

std::string number_text(double number) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, static_cast<float>(number)).ptr;
  return {text, end};
}

/// A key as YAML.
std::string key_text(const std::string& key) {
  const bool plain = std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  if (plain && !key.empty() && key[0] != '-') return key;
  std::string text = "'";
  for (const char c : key) text += c == '\'' ? "''" : std::string(1, c);
  return text + "'";
}

std::string joined(const std::vector<std::string>& path, size_t count) {
  std::string text = path[0];
  for (size_t i = 1; i < count; ++i) text += "." + path[i];
  return text;
}

std::string joined(const std::vector<std::string>& path) { return joined(path, path.size()); }

[[noreturn]] void refuse(const SourcePosition& position, const std::string& message) {
  throw Error(ErrorKind::kInput, position, message);
}

Value read_text(const std::string& text, const std::string& file) {
  DocumentLimits limits;
  Problems problems;
  std::optional<Value> root = read_yaml(text, file, {}, limits, problems);
  problems.throw_if_any();
  return std::move(*root);
}

/// A text, and the tree of its values, which is changed along with it.
class EditedText {
 public:
  EditedText(std::string text, const std::string& file)
      : text_(std::move(text)), file_(file), root_(read_text(text_, file)) {}

  void apply(const ValueEdit& edit);
  const std::string& text() const { return text_; }

 private:
  void replace(const ValueEdit& edit, Value& value);
  void remove(const ValueEdit& edit, Value& block);
  void add(const ValueEdit& edit, Value& block);
  void begin_block(const ValueEdit& edit);
  size_t byte_of(const SourcePosition& position) const;
  // Whether an unquoted scalar is at its position as it was read.
  bool is_plain(const Value& value) const {
    return value.is_scalar() && !value.quoted() && !value.text().empty() &&
           text_.compare(byte_of(value.position()), value.text().size(), value.text()) == 0;
  }
  /// Sets the text, and reads the tree again. Throws unless it is equal to the changed tree.
  void set_text(std::string text) {
    text_ = std::move(text);
    const Value wanted = std::move(root_);
    const auto refuse_change = [this] {
      refuse({file_, 0, 0}, "cannot be changed without changing other values; edit the file by hand");
    };
    try {
      root_ = read_text(text_, file_);
    } catch (const Error&) {  // about a text that no one has seen
      refuse_change();
    }
    if (document_hash(root_) != document_hash(wanted)) refuse_change();
  }
  void splice(size_t at, size_t length, const std::string& text) {
    std::string changed = text_;
    set_text(changed.replace(at, length, text));
  }

  std::string text_;
  const std::string& file_;
  Value root_;
};

size_t EditedText::byte_of(const SourcePosition& position) const {
  size_t at = text_.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  for (int line = 1; line < position.line; ++line) at = text_.find('\n', at) + 1;
  const auto is_continuation = [&](size_t i) {
    return (static_cast<unsigned char>(text_[i]) & 0xc0) == 0x80;
  };
  for (int column = 1; column < position.column && at < text_.size(); ++column) {
    do ++at;
    while (at < text_.size() && is_continuation(at));
  }
  return at;
}

void EditedText::apply(const ValueEdit& edit) {
  Value* block = &root_;
  if (edit.path.size() == 2 && !edit.block.empty() && !root_.find(edit.path[0])) {
    begin_block(edit);
    return;
  }
  for (size_t i = 0; i + 1 < edit.path.size(); ++i) {
    block = block->find(edit.path[i]);
    if (!block || !block->is_map() || block->entries().empty())
      refuse({file_, 0, 0}, "has no block `" + joined(edit.path, i + 1) + "`");
  }
  Value* value = block->find(edit.path.back());
  if (edit.removed) {
    remove(edit, *block);
  } else if (value && !edit.block.empty()) {
    refuse(value->position(), "`" + joined(edit.path) + "` exists already");
  } else if (value) {
    replace(edit, *value);
  } else {
    add(edit, *block);
  }
}

void EditedText::replace(const ValueEdit& edit, Value& value) {
  const std::string text = numbers_text(edit.numbers);
  if (is_plain(value)) {
    const size_t at = byte_of(value.position()), length = value.text().size();
    value = edit.numbers.size() == 1 ? Value::scalar({}, text) : read_text(text, file_);
    splice(at, length, text);
    return;
  }
  const bool fits = value.is_list() && value.items().size() == edit.numbers.size() &&
                    std::all_of(value.items().begin(), value.items().end(),
                                [this](const Value& item) { return is_plain(item); });
  if (!fits)
    refuse(value.position(), "`" + joined(edit.path) + "` is not " +
                                 (edit.numbers.size() == 1 ? "a plain number" : "a plain list of numbers") +
                                 " here; edit it by hand: " + text);
  // From the last item, so that the bytes of the others stay where they are.
  std::string changed = text_;
  for (size_t i = value.items().size(); i-- > 0;) {
    Value& item = value.items()[i];
    const std::string number = number_text(edit.numbers[i]);
    changed.replace(byte_of(item.position()), item.text().size(), number);
    item = Value::scalar({}, number);
  }
  set_text(std::move(changed));
}

/// Returns the end of a value in brackets that begins at a byte: the comma or bracket behind it.
size_t end_in_brackets(const std::string& text, size_t at) {
  int depth = 0;
  for (char quote = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (quote != 0) {
      if (c == '\\' && quote == '"')
        ++at;
      else if (c == quote)
        quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '{' || c == '[') {
      ++depth;
    } else if (c == '}' || c == ']' || c == ',') {
      if (depth == 0) return at;
      if (c != ',') --depth;
    }
  }
  return at;
}

/// Returns the end of an entry of whole lines whose first line is at a byte, and whose key is in a column:
/// the first line that is not deeper, or the comments and empty lines in front of it. Brackets may close in
/// the column of the key.
size_t end_of_lines(const std::string& text, size_t at, size_t column) {
  size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
  for (size_t line = end; line < text.size();) {
    const size_t next = std::min(text.find('\n', line), text.size() - 1) + 1;
    const size_t first = std::min(text.find_first_not_of(" \r\n", line), next);
    const bool is_empty = first >= next || text[first] == '#';
    const bool closes = !is_empty && (text[first] == '}' || text[first] == ']');
    if (!is_empty && !closes && first - line <= column) break;
    line = next;
    if (!is_empty) end = next;
  }
  return end;
}

/// Removes the bytes of a key and its value; set_text() finds out if they were others.
void EditedText::remove(const ValueEdit& edit, Value& block) {
  std::vector<Value::Entry>& entries = block.entries();
  const auto entry = std::find_if(entries.begin(), entries.end(),
                                  [&](const Value::Entry& e) { return e.key == edit.path.back(); });
  if (entry == entries.end()) refuse(block.position(), "has no `" + joined(edit.path) + "`");
  if (entries.size() == 1) {
    if (edit.path.size() == 1)
      refuse(entry->key_position, "`" + joined(edit.path) + "` is the last one here; remove it by hand");
    apply({{edit.path.begin(), edit.path.end() - 1}, {}, {}, true});
    return;
  }
  size_t begin = byte_of(entry->key_position), end = 0;
  if (text_[byte_of(block.position())] == '{') {
    end = end_in_brackets(text_, begin);
    if (end < text_.size() && text_[end] == ',') {
      end = std::min(text_.find_first_not_of(" ", end + 1), text_.size());
    } else {
      begin = text_.rfind(',', begin);
      if (begin == std::string::npos) refuse(entry->key_position, "cannot be removed; edit the file by hand");
    }
  } else {
    const auto column = static_cast<size_t>(entry->key_position.column - 1);
    begin -= std::min(begin, column);
    end = end_of_lines(text_, begin, column);
  }
  entries.erase(entry);
  splice(begin, end - begin, "");
}

/// Adds a block together with the block of the document around it.
void EditedText::begin_block(const ValueEdit& edit) {
  if (!root_.is_map() || root_.entries().empty() || text_[byte_of(root_.position())] == '{')
    refuse({file_, 0, 0}, "has no block `" + edit.path[0] + "`");
  const std::string line_end = text_.find("\r\n") == std::string::npos ? "\n" : "\r\n";
  const std::string entry = key_text(edit.path[1]) + ": " + edit.block;
  const std::string text = key_text(edit.path[0]) + ":" + line_end + "  " + entry + line_end;
  root_.entries().push_back({edit.path[0], {}, read_text(entry, file_)});
  splice(text_.size(), 0, (text_.ends_with('\n') ? "" : line_end) + text);
}

void EditedText::add(const ValueEdit& edit, Value& block) {
  std::vector<Value::Entry>& entries = block.entries();
  const std::string new_value = edit.block.empty() ? numbers_text(edit.numbers) : edit.block;
  const std::string text = key_text(edit.path.back()) + ": " + new_value;
  const size_t bracket = byte_of(block.position());
  const bool in_brackets = text_[bracket] == '{';
  const auto last = edit.block.empty()
                        ? std::find_if(entries.rbegin(), entries.rend(),
                                       [this](const Value::Entry& entry) { return is_plain(entry.value); })
                        : entries.rend();
  const auto column = static_cast<size_t>(entries.front().key_position.column - 1);
  const std::string line_end = text_.find("\r\n") == std::string::npos ? "\n" : "\r\n";
  const std::string separator = in_brackets ? ", " : line_end + std::string(column, ' ');
  size_t at = 0;
  std::string inserted = separator + text;
  auto place = entries.begin();
  if (last != entries.rend()) {
    place = last.base();
    at = byte_of(last->value.position()) + last->value.text().size();
    if (!in_brackets) at = std::min(text_.find('\n', at), text_.size());
    if (!in_brackets && text_[at - 1] == '\r') --at;
  } else if (in_brackets) {
    // A comment stays with the first key if it is on a line between the bracket and the key.
    const size_t first = byte_of(entries.front().key_position);
    const bool same_line = std::min(text_.find('\n', bracket), text_.size()) > first;
    at = same_line ? first : bracket + 1;
    inserted = text + (same_line ? ", " : ",");
  } else {
    place = entries.end();
    const size_t key = byte_of(entries.back().key_position);
    at = end_of_lines(text_, key - std::min(key, column), column);
    if (text_[at - 1] == '\n') inserted = separator.substr(line_end.size()) + text + line_end;
  }
  Value value = edit.numbers.size() == 1 ? Value::scalar({}, new_value) : read_text(new_value, file_);
  entries.insert(place, {edit.path.back(), {}, std::move(value)});
  splice(at, 0, inserted);
}

/// Throws if `--set` determines a value, or a part of it.
void check_overrides(const std::vector<Override>& overrides, const ValueEdit& edit) {
  const std::string path = joined(edit.path);
  for (const Override& override : overrides) {
    const bool same =
        override.key == path || override.key.starts_with(path + ".") || path.starts_with(override.key + ".");
    if (same)
      refuse({}, "`" + path + "` is set by --set " + override.key + "=" + override.value +
                     ", which takes precedence over the file");
  }
}

/// Throws if an included file has the value, or the block that would hold it.
void check_includes(const std::filesystem::path& path, const Value& merged, const ValueEdit& edit) {
  const Value* value = &merged;
  for (size_t i = 0; i < edit.path.size() && value; ++i) {
    value = value->find(edit.path[i]);
    const bool is_last = i + 1 == edit.path.size();
    // A block of several files has the position that it has in one of them.
    if (value && (is_last || !value->is_map()) && value->position().file != path.string())
      refuse(value->position(),
             "`" + joined(edit.path) + "` is in this file, which the scene includes; edit it there");
  }
}

}  // namespace

std::string numbers_text(const std::vector<double>& numbers) {
  if (numbers.size() == 1) return number_text(numbers[0]);
  std::string text = "[";
  for (const double number : numbers) text += (text.size() > 1 ? ", " : "") + number_text(number);
  return text + "]";
}

std::string values_text(const std::vector<ValueEdit>& edits) {
  std::string text;
  std::vector<std::string> open;  // names of the blocks around the last line
  for (const ValueEdit& edit : edits) {
    size_t same = 0;
    while (same < open.size() && same + 1 < edit.path.size() && open[same] == edit.path[same]) ++same;
    for (size_t i = same; i < edit.path.size(); ++i) {
      const bool is_last = i + 1 == edit.path.size();
      const std::string value = edit.block.empty() ? numbers_text(edit.numbers) : edit.block;
      text += std::string(2 * i, ' ');
      if (is_last && edit.removed)
        text += "# removed: " + key_text(edit.path[i]) + "\n";
      else
        text += key_text(edit.path[i]) + ":" + (is_last ? " " + value : "") + "\n";
    }
    open.assign(edit.path.begin(), edit.path.end() - 1);
  }
  return text;
}

std::string with_values(const std::string& text, const std::string& file,
                        const std::vector<ValueEdit>& edits) {
  EditedText edited(text, file);
  for (const ValueEdit& edit : edits) edited.apply(edit);
  return edited.text();
}

void write_values(const std::filesystem::path& path, const std::vector<Override>& overrides,
                  const std::vector<ValueEdit>& edits) {
  const std::string text = read_file(path);
  const Value merged = load_document(path);
  for (const ValueEdit& edit : edits) {
    check_overrides(overrides, edit);
    check_includes(path, merged, edit);
  }
  const std::string changed = with_values(text, path.string(), edits);
  AtomicFile file(path);
  file.write(changed);
  if (!file.commit_over(text))
    throw Error(ErrorKind::kFailed, path.string() + ": changed at the same time; try again");
}

}  // namespace pelage
