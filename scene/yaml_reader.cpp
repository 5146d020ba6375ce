// SPDX-License-Identifier: Apache-2.0
#include "scene/yaml_reader.h"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <unordered_map>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include "base/nearest_name.h"
#include "scene/source_text.h"

namespace pelage {
namespace {

// Deeper than any scene needs, and far below the limits of yaml-cpp's own recursion.
constexpr size_t kDeepest = 64;

// Thrown to leave yaml-cpp once the reason has been reported.
struct Stop {};

// Builds values from the events of yaml-cpp's parser, which reports aliases instead of following them.
class ValueBuilder final : public YAML::EventHandler {
 public:
  ValueBuilder(SourceText& source, const std::optional<SourcePosition>& fixed, DocumentLimits& limits,
               Problems& problems)
      : source_(source), fixed_(fixed), limits_(limits), problems_(problems) {}

  Value take_root() { return std::move(root_); }

  SourcePosition at(const YAML::Mark& mark) {
    return fixed_ ? *fixed_ : source_.position(mark.line, mark.column);
  }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (documents_++ == 0) return;
    problems_.add(at(mark), "text after the end of the document");
    throw Stop{};
  }
  void OnDocumentEnd() override {}

  void OnAnchor(const YAML::Mark& mark, const std::string& name) override {
    problems_.add(at(mark),
                  "anchors are not supported (" + quote("&" + name) + "); share values with 'include:'");
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    problems_.add(at(mark), "aliases are not supported; share values with 'include:'");
    Value nothing;
    nothing.set_position(at(mark));
    place(std::move(nothing));
  }

  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override {
    Value null;
    // For a missing value, yaml-cpp's mark is the position of the next token, often on the next line.
    const bool after_key = !open_.empty() && open_.back().has_key;
    null.set_position(after_key ? open_.back().key_position : before(mark));
    place(std::move(null));
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                const std::string& text) override {
    check_tag(mark, tag);
    check_closed(mark);
    place(Value::scalar(at(mark), text, tag == "!"));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    open(mark, tag, false);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    open(mark, tag, true);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    bool is_map = false;
    SourcePosition position;
    std::vector<Value> items;
    std::vector<Value::Entry> entries;
    std::unordered_map<std::string, int> lines;  // of the keys so far
    bool has_key = false;
    bool key_refused = false;
    std::string key;
    SourcePosition key_position;
  };

  void check_tag(const YAML::Mark& mark, const std::string& tag) {
    if (tag.empty() || tag == "?" || tag == "!") return;
    problems_.add(at(mark), "tags are not supported (" + quote(tag) + ")");
  }

  // yaml-cpp accepts the end of the file as a closing quote.
  void check_closed(const YAML::Mark& mark) {
    const std::string& text = source_.text();
    auto i = static_cast<size_t>(std::clamp<long>(mark.pos, 0, static_cast<long>(text.size())));
    const char quote_mark = i < text.size() ? text[i] : ' ';
    if (quote_mark != '"' && quote_mark != '\'') return;
    for (++i; i < text.size(); ++i) {
      if (quote_mark == '"' && text[i] == '\\') {
        ++i;
      } else if (text[i] == quote_mark) {
        if (quote_mark == '"' || text.compare(i + 1, 1, "'") != 0) return;
        ++i;
      }
    }
    problems_.add(at(mark), "unterminated quoted text");
    throw Stop{};
  }

  // End of the text before the mark, excluding blanks.
  SourcePosition before(const YAML::Mark& mark) {
    if (fixed_) return *fixed_;
    const std::string& text = source_.text();
    auto end = static_cast<size_t>(std::clamp<long>(mark.pos, 0, static_cast<long>(text.size())));
    const std::string_view there = std::string_view(text).substr(end, 1);
    if (there == "~" || there == "n" || there == "N") return at(mark);
    while (end > 0 && std::isspace(static_cast<unsigned char>(text[end - 1]))) --end;
    return end == 0 ? at(mark) : source_.position_of_byte(end - 1);
  }

  void open(const YAML::Mark& mark, const std::string& tag, bool is_map) {
    check_tag(mark, tag);
    if (open_.size() == kDeepest) {
      problems_.add(at(mark), "values are nested more than " + std::to_string(kDeepest) + " deep");
      throw Stop{};
    }
    open_.emplace_back();
    open_.back().is_map = is_map;
    open_.back().position = at(mark);
  }

  void close() {
    Open done = std::move(open_.back());
    open_.pop_back();
    place(done.is_map ? Value::map(std::move(done.position), std::move(done.entries))
                      : Value::list(std::move(done.position), std::move(done.items)));
  }

  void place(Value value) {
    if (limits_.values == 0) {
      problems_.add(value.position(), "the scene contains too many values");
      throw Stop{};
    }
    --limits_.values;
    if (open_.empty()) {
      root_ = std::move(value);
    } else if (!open_.back().is_map) {
      open_.back().items.push_back(std::move(value));
    } else if (!open_.back().has_key) {
      place_key(open_.back(), value);
    } else {
      Open& map = open_.back();
      if (!map.key_refused) map.entries.push_back({std::move(map.key), map.key_position, std::move(value)});
      map.has_key = false;
    }
  }

  void place_key(Open& map, const Value& key) {
    map.has_key = true;
    map.key_refused = true;
    map.key = key.text();
    map.key_position = key.position();
    if (!key.is_scalar() || key.text().empty()) {
      problems_.add(key.position(), "expected a key, got " + key.describe());
    } else if (key.text() == "<<" && !key.quoted()) {
      problems_.add(key.position(), "merge keys are not supported; share values with 'include:'");
    } else if (const auto [first, is_new] = map.lines.try_emplace(key.text(), key.position().line); !is_new) {
      std::string message = "duplicate key " + quote(key.text());
      if (!fixed_) message += ", first on line " + std::to_string(first->second);
      problems_.add(key.position(), std::move(message));
    } else {
      map.key_refused = false;
    }
  }

  SourceText& source_;
  const std::optional<SourcePosition>& fixed_;
  DocumentLimits& limits_;
  Problems& problems_;
  std::vector<Open> open_;
  Value root_;
  int documents_ = 0;
};

// Replaces yaml-cpp's obscure messages by hints at the likely mistake.
std::string explain(const std::string& message) {
  struct Wording {
    const char* theirs;
    const char* ours;
  };
  const Wording kWordings[] = {
      {YAML::ErrorMsg::MAP_VALUE, "unexpected ':'; check the indentation and quotes"},
      {YAML::ErrorMsg::MAP_KEY, "unexpected key; check the indentation"},
      {YAML::ErrorMsg::BLOCK_ENTRY, "unexpected '-'; check the indentation"},
      {YAML::ErrorMsg::END_OF_MAP, "the block is incomplete; check the indentation and the ':' of each key"},
      {YAML::ErrorMsg::END_OF_SEQ, "the list is incomplete; check the indentation and the '-' of each item"},
      {YAML::ErrorMsg::END_OF_MAP_FLOW, "expected ',' or '}'"},
      {YAML::ErrorMsg::END_OF_SEQ_FLOW, "expected ',' or ']'"},
      {YAML::ErrorMsg::FLOW_END, "closing bracket without an opening one"},
      {YAML::ErrorMsg::EOF_IN_SCALAR, "unterminated quoted text"},
      {YAML::ErrorMsg::DOC_IN_SCALAR, "unterminated quoted text"},
      {YAML::ErrorMsg::TAB_IN_INDENTATION, "tab in the indentation; use spaces"},
      {YAML::ErrorMsg::UNKNOWN_TOKEN, "a value cannot begin with this character; put the text in quotes"},
      {YAML::ErrorMsg::BAD_FILE, "values are nested too deep"},
  };
  for (const Wording& wording : kWordings) {
    if (message == wording.theirs) return "malformed YAML: " + std::string(wording.ours);
  }
  if (message.starts_with(YAML::ErrorMsg::UNKNOWN_ANCHOR))
    return "aliases are not supported; share values with 'include:'";
  std::string line = quote(message);
  return "malformed YAML: " + line.substr(1, line.size() - 2);
}

}  // namespace

std::optional<Value> read_yaml(std::string text, const std::string& file,
                               const std::optional<SourcePosition>& fixed, DocumentLimits& limits,
                               Problems& problems) {
  const SourcePosition whole = fixed.value_or(SourcePosition{file, 0, 0});
  if (text.size() > limits.bytes) {
    problems.add(whole, "the scene is larger than " + std::to_string(DocumentLimits{}.bytes >> 20) + " MiB");
    return std::nullopt;
  }
  limits.bytes -= text.size();
  SourceText source(std::move(text), file);
  if (const std::optional<Problem> mistake = source.mistake()) {
    problems.add(fixed.value_or(mistake->position), mistake->message);
    return std::nullopt;
  }

  ValueBuilder builder(source, fixed, limits, problems);
  try {
    std::istringstream stream(source.text());
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
    return builder.take_root();
  } catch (const Stop&) {
  } catch (const YAML::Exception& error) {
    if (error.mark.is_null()) {
      problems.add(whole, explain(error.msg));
    } else {
      const std::string_view line = source.line(error.mark.line);
      const bool has_tab = line.substr(0, line.find_first_not_of(" \t")).find('\t') != std::string_view::npos;
      problems.add(builder.at(error.mark), explain(has_tab ? YAML::ErrorMsg::TAB_IN_INDENTATION : error.msg));
    }
  }
  return std::nullopt;
}

}  // namespace pelage
