// SPDX-License-Identifier: Apache-2.0
#include <set>

#include <gtest/gtest.h>

#include "base/file.h"
#include "world/regions.h"
#include "world/scene_schema.h"

namespace pelage {
namespace {

// docs/MANUAL.md must be what the program prints; tools/write_manual updates it.
TEST(ManualDocument, IsUpToDate) {
  const std::string document = read_file(PELAGE_SOURCE_DIR "/docs/MANUAL.md");
  std::string manual = manual_text(SceneDescription::schema(), {}, true);
  while (manual.ends_with('\n')) manual.pop_back();
  EXPECT_NE(document.find(manual), std::string::npos) << "run tools/write_manual";
}

void collect(const SchemaInfo& table, std::set<const SchemaInfo*>& tables) {
  if (!tables.insert(&table).second) return;
  for (const KeyInfo& key : table.keys()) {
    for (const SchemaInfo* block : key.blocks) collect(*block, tables);
  }
}

// The tables of all blocks of a document.
void visit(Value& block, const SchemaInfo& table, std::set<const SchemaInfo*>& visited) {
  visited.insert(&table);
  for (Value::Entry& entry : block.entries()) {
    if (const KeyInfo* key = table.find(entry.key)) {
      key->visit_blocks(entry.value,
                        [&](Value& inner, const SchemaInfo& its_table) { visit(inner, its_table, visited); });
    }
  }
}

// Every section has an example that is part of a scene file, is read without a mistake and uses the block.
TEST(ManualDocument, EveryExampleIsRead) {
  const SchemaInfo& root = SceneDescription::schema();
  std::set<const SchemaInfo*> tables;
  collect(root, tables);
  EXPECT_GE(tables.size(), 50u);
  for (const SchemaInfo* table : tables) {
    SCOPED_TRACE(table->name());
    std::string text = table->example();
    ASSERT_FALSE(text.empty());
    // Includes are put aside: the files that an example names need not exist.
    if (const size_t include = text.find("include:"); include != std::string::npos)
      text.erase(include, text.find('\n', include) + 1 - include);
    if (!text.starts_with("pelage:")) text = "pelage: 1\n" + text;
    Value document = parse_document(text, "example");
    SceneDescription scene;
    Problems problems;
    std::set<const SchemaInfo*> visited;
    visit(document, root, visited);
    expand_regions(document, problems);
    SceneDescription::schema().read(document, scene, problems);
    for (const Problem& problem : problems.list())
      ADD_FAILURE() << to_string(problem.position) << ": " << problem.message;
    EXPECT_TRUE(visited.contains(table));
  }
}

// A key of today with the name of another one's past would take its values.
TEST(ManualDocument, OldNamesAreNoKeys) {
  std::set<const SchemaInfo*> tables;
  collect(SceneDescription::schema(), tables);
  for (const SchemaInfo* table : tables) {
    for (const KeyInfo& key : table->keys()) {
      for (const std::string_view old_name : key.options.old_names) {
        if (old_name.empty()) continue;
        EXPECT_EQ(table->find(old_name), nullptr) << table->name() << "." << old_name;
        EXPECT_EQ(table->find_renamed(old_name), &key) << table->name() << "." << old_name;
      }
    }
  }
}

}  // namespace
}  // namespace pelage
