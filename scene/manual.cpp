// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>

#include "base/nearest_name.h"
#include "scene/document.h"

namespace pelage {
namespace {

constexpr size_t kLineWidth = 100;

using Tables = std::vector<const SchemaInfo*>;

// Depth first, so that a block's section follows the one that mentions it.
void collect(const SchemaInfo& table, Tables& tables) {
  if (std::find(tables.begin(), tables.end(), &table) != tables.end()) return;
  tables.push_back(&table);
  for (const KeyInfo& key : table.keys()) {
    for (const SchemaInfo* block : key.blocks) collect(*block, tables);
  }
}

// Fields can be written in so many ways that one section lists them, and keys refer to that section.
constexpr std::string_view kFields = "fields";
bool is_field(const SchemaInfo* table) {
  return table->name().ends_with(" field") && !table->name().ends_with(" of a field");  // a part of one
}

// The sections that the blocks of a key are described in.
std::vector<std::string> sections_of(const KeyInfo& key) {
  std::vector<std::string> names;
  for (const SchemaInfo* block : key.blocks) {
    const std::string name = is_field(block) ? std::string(kFields) : block->name();
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

// Sections for a name: tables of that name, otherwise the blocks under keys of that name.
Tables find_sections(const Tables& all, const std::string& name) {
  Tables found;
  const auto add = [&](const SchemaInfo* table) {
    if (std::find(found.begin(), found.end(), table) == found.end()) found.push_back(table);
  };
  for (const SchemaInfo* table : all) {
    if (table->name() == name || (name == kFields && is_field(table))) add(table);
  }
  if (!found.empty()) return found;
  for (const SchemaInfo* table : all) {
    for (const KeyInfo& key : table->keys()) {
      if (key.name != name) continue;
      for (const SchemaInfo* block : key.blocks) add(block);
    }
  }
  return found;
}

std::vector<std::string> section_names(const Tables& all) {
  std::vector<std::string> names{std::string(kFields)};
  for (const SchemaInfo* table : all) {
    names.push_back(table->name());
    for (const KeyInfo& key : table->keys()) {
      if (!key.blocks.empty()) names.push_back(key.name);
    }
  }
  return names;
}

std::string join(const std::vector<std::string>& parts, const std::string& separator) {
  std::string text;
  for (const std::string& part : parts) {
    if (part.empty()) continue;
    text += (text.empty() ? "" : separator) + part;
  }
  return text;
}

std::string default_of(const KeyInfo& key) { return key.options.required ? "required" : key.default_text; }

// Wraps words of `text` to lines of at most kLineWidth characters that start with `indent`.
std::string wrap(const std::string& text, const std::string& indent) {
  std::string result, line;
  size_t start = 0;
  while (start < text.size()) {
    size_t end = text.find(' ', start);
    if (end == std::string::npos) end = text.size();
    const std::string word = text.substr(start, end - start);
    if (!line.empty() && indent.size() + line.size() + 1 + word.size() > kLineWidth) {
      result += indent + line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
    start = end + 1;
  }
  return line.empty() ? result : result + indent + line + "\n";
}

// Every line of `text` behind `indent`.
std::string indented(const std::string& text, const std::string& indent) {
  std::string result;
  for (size_t start = 0, end = 0; start < text.size(); start = end + 1) {
    end = std::min(text.find('\n', start), text.size());
    result += indent + text.substr(start, end - start) + "\n";
  }
  return result;
}

// "Formerly `a`." for a key that had another name.
std::string former_names(const KeyInfo& key) {
  std::string text;
  for (const std::string_view name : key.options.old_names) {
    if (!name.empty()) text += (text.empty() ? "`" : ", `") + std::string(name) + "`";
  }
  return text.empty() ? text : "Formerly " + text + ".";
}

std::string with_stop(std::string_view help) {
  return std::string(help) + (help.empty() || help.back() == '.' ? "" : ".");
}

std::string plain_section(const SchemaInfo& table) {
  size_t width = 0;
  for (const KeyInfo& key : table.keys()) width = std::max(width, key.name.size());
  std::string text = table.name() + "\n" + wrap(table.help(), "  ") + "\n";
  const std::string indent(width + 4, ' ');
  for (const KeyInfo& key : table.keys()) {
    std::vector<std::string> facts{key.type, range_text(key.options), std::string(key.options.unit)};
    const std::string shown = default_of(key);
    if (!shown.empty()) facts.push_back(key.options.required ? shown : "default " + shown);
    std::string entry = wrap(join(facts, ", "), indent);
    entry.replace(2, key.name.size(), key.name);
    const std::string former = former_names(key);
    text += entry + wrap(former.empty() ? std::string(key.options.help)
                                        : join({with_stop(key.options.help), former}, " "),
                         indent);
    const std::vector<std::string> sections = sections_of(key);
    if (!sections.empty()) text += wrap("see " + join(sections, ", "), indent);
  }
  if (!table.example().empty()) text += "\n  Example:\n" + indented(table.example(), "    ");
  return text;
}

std::string escape_cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|' || c == '<') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

// As GitHub derives it from a heading.
std::string anchor(std::string name) {
  std::replace(name.begin(), name.end(), ' ', '-');
  return "#" + name;
}

// Where tools/manual_pictures puts the picture of a section.
std::string picture_file(std::string name) {
  std::replace(name.begin(), name.end(), ' ', '_');
  return "images/manual/" + name + ".png";
}

std::string markdown_section(const SchemaInfo& table) {
  std::string text = "## " + table.name() + "\n\n" + table.help() + "\n\n";
  if (!table.picture().empty())
    text += "![" + table.picture() + "](" + picture_file(table.name()) + ")\n\n" + table.picture() + "\n\n";
  if (!table.example().empty()) text += "```yaml\n" + table.example() + "\n```\n\n";
  if (table.keys().empty()) return text;
  text += "| key | type | default | range | unit | |\n|---|---|---|---|---|---|\n";
  for (const KeyInfo& key : table.keys()) {
    std::vector<std::string> sections;
    for (const std::string& name : sections_of(key))
      sections.push_back("[" + name + "](" + anchor(name) + ")");
    const std::string see = sections.empty() ? "" : "See " + join(sections, ", ") + ".";
    text += "| `" + key.name + "` | " + escape_cell(key.type) + " | " + escape_cell(default_of(key)) + " | " +
            escape_cell(range_text(key.options)) + " | " + escape_cell(key.options.unit) + " | " +
            join({escape_cell(with_stop(key.options.help)), former_names(key), see}, " ") + " |\n";
  }
  return text + "\n";
}

// One line for each kind of field.
std::string fields_section(const Tables& fields, bool markdown) {
  const std::string help =
      "A number or a colour that may vary over the skin and along strands. Where a key is a field, write "
      "a number, a colour, or one of these blocks:";
  std::string text =
      markdown ? "## fields\n\n" + help + "\n\n| block | |\n|---|---|\n" : "fields\n" + wrap(help, "  ");
  for (const SchemaInfo* field : fields) {
    const std::string key = field->keys().front().name;
    const std::string first(field->help().substr(0, field->help().find(". ")));
    text += markdown ? "| [`" + key + "`](" + anchor(field->name()) + ") | " + escape_cell(with_stop(first)) +
                           " |\n"
                     : wrap(key + ": " + with_stop(first), "    ");
  }
  return markdown ? text + "\n" : text;
}

}  // namespace

std::string manual_text(const SchemaInfo& root, const std::string& section, bool markdown) {
  Tables all;
  collect(root, all);
  const Tables shown = section.empty() ? all : find_sections(all, section);
  if (shown.empty()) {
    throw Error(ErrorKind::kArguments,
                "the manual has no section " + quote(section) + suggest(section, section_names(all)));
  }
  Tables fields;
  std::copy_if(shown.begin(), shown.end(), std::back_inserter(fields), is_field);
  std::string text;
  for (const SchemaInfo* table : shown) {
    if (!text.empty() && !markdown) text += "\n";
    if (fields.size() > 1 && table == fields.front()) {
      text += fields_section(fields, markdown);
      if (!markdown) text += "\n";
    }
    text += markdown ? markdown_section(*table) : plain_section(*table);
  }
  return text;
}

}  // namespace pelage
