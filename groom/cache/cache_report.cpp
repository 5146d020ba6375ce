// SPDX-License-Identifier: Apache-2.0
#include "groom/cache/cache_report.h"

#include <algorithm>

#include <fmt/format.h>

namespace pelage {
namespace {

constexpr const char* kKind = "manifest";
constexpr size_t kLongest = 60;  // of a displayed value
constexpr const char* kState = "+";
constexpr size_t kStatesKept = 8;
constexpr std::chrono::hours kStateAge{24};

ContentHash key_of(const std::string& groom) { return ContentHasher().add("groom").add(groom).digest(); }

/// On one line, without field separators.
std::string plain(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  return text;
}

std::string shown(const std::string& text) {
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

// Hashes are meaningless to users.
bool is_contents(const std::string& key) {
  return key.starts_with("contents of ") || key == "mesh" || key == "program" || key == "seed";
}

std::string change_of(const std::string& key, const std::string* before, const std::string& now) {
  if (key == "program") return "the version of the program, its libraries or the processor changed";
  if (key == "mesh") return "the rest skin changed";
  if (now == "missing") return key.substr(key.find(' ') + 1 + 3) + " is missing";
  if (is_contents(key)) return key + " changed";
  return before ? fmt::format("{}: {} -> {}", key, shown(*before), shown(now))
                : fmt::format("{}: {}", key, shown(now));
}

std::string changes(const GroomStage& before, const GroomStage& now) {
  std::string text;
  const auto add = [&](const std::string& change) { text += (text.empty() ? "" : ", ") + change; };
  for (const auto& [key, value] : now.inputs) {
    const auto old = std::find_if(before.inputs.begin(), before.inputs.end(),
                                  [&, &name = key](const auto& input) { return input.first == name; });
    if (old == before.inputs.end()) {
      add(change_of(key, nullptr, value));
    } else if (old->second != value) {
      add(change_of(key, &old->second, value));
    }
  }
  return text.empty() ? "changed" : text;
}

std::string_view cut(std::string_view& text, char at) {
  const size_t end = std::min(text.find(at), text.size());
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return part;
}

}  // namespace

std::string GroomCacheReport::summary() const {
  if (fresh) return "fresh";
  for (const Stage& stage : stages) {
    if (!stage.fresh) return fmt::format("stale from {} ({})", stage.name, stage.reason);
  }
  return "stale (file missing or damaged)";
}

GroomManifest::GroomManifest(const GroomIdentity& identity, size_t count)
    : stages_(identity.stages().begin(), identity.stages().begin() + static_cast<std::ptrdiff_t>(count)) {
  for (GroomStage& stage : stages_) {
    for (auto& [key, value] : stage.inputs) key = plain(key), value = plain(value);
  }
}

std::string GroomManifest::text() const {
  std::string text;
  for (const GroomStage& stage : stages_) {
    text += fmt::format("{}\t{}\n", stage.name, to_string(stage.hash));
    for (const auto& [key, value] : stage.inputs) text += fmt::format("\t{}\t{}\n", key, value);
  }
  for (const State& state : states_)
    text += fmt::format("{}\t{}\t{}\n", kState, state.offsets, state.follicles);
  return text;
}

void GroomManifest::add_state(State now, const std::optional<GroomManifest>& before,
                              const ContentStore& store) {
  states_ = {std::move(now)};
  if (!before) return;
  std::vector<State> forgotten;
  for (const State& old : before->states_) {
    if (old == states_.front()) continue;
    const bool gone = states_.size() >= kStatesKept &&
                      (ContentStore::remove_unused(store.folder() / old.offsets, kStateAge).files > 0 ||
                       !std::filesystem::exists(store.folder() / old.offsets));
    (gone ? forgotten : states_).push_back(old);
  }
  // States may share their follicles.
  for (const State& old : forgotten) {
    const bool shared = std::any_of(states_.begin(), states_.end(),
                                    [&](const State& state) { return state.follicles == old.follicles; });
    if (!shared && !old.follicles.empty())
      ContentStore::remove_unused(store.folder() / old.follicles, kStateAge);
  }
}

std::filesystem::path GroomManifest::file(const ContentStore& store, const std::string& groom) {
  return store.file(kKind, key_of(groom));
}

std::optional<GroomManifest> GroomManifest::read(const ContentStore& store, const std::string& groom) {
  const auto file = store.open(kKind, key_of(groom), [](const std::string&) {});
  if (!file || file->section_count() != 1) return {};
  const auto bytes = file->section(0);
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  GroomManifest manifest;
  while (!text.empty()) {
    std::string_view line = cut(text, '\n');
    const std::string first(cut(line, '\t'));
    if (first == kState) {
      State& state = manifest.states_.emplace_back();
      // Names only: a path could lead out of the folder.
      state.offsets = std::filesystem::path(cut(line, '\t')).filename().string();
      state.follicles = std::filesystem::path(line).filename().string();
    } else if (!first.empty()) {
      GroomStage& stage = manifest.stages_.emplace_back();
      stage.name = first;
      stage.hash = parse_hash(line).value_or(ContentHash{});
    } else if (!manifest.stages_.empty()) {
      const std::string key(cut(line, '\t'));
      manifest.stages_.back().inputs.emplace_back(key, std::string(line));
    }
  }
  return manifest;
}

void GroomManifest::write(const ContentStore& store, const std::string& groom) const {
  const std::string bytes = text();
  ContentStore::Writer writer = store.writer(kKind, key_of(groom));
  writer.add(std::as_bytes(std::span(bytes.data(), bytes.size())));
  writer.commit([](const std::string&) {});
}

std::vector<GroomCacheReport::Stage> explain(const GroomManifest& now,
                                             const std::optional<GroomManifest>& before) {
  std::vector<GroomCacheReport::Stage> result;
  bool fresh = true;
  for (size_t i = 0; i < now.stages().size(); ++i) {
    const GroomStage& stage = now.stages()[i];
    const GroomStage* old = before && i < before->stages().size() ? &before->stages()[i] : nullptr;
    std::string reason;
    if (fresh && (!old || old->hash != stage.hash)) {
      fresh = false;
      reason = !old ? "new" : old->name != stage.name ? "replaces " + old->name : changes(*old, stage);
    } else if (!fresh) {
      // Reports the stage's own changes too: more than one stage may have been edited.
      const bool same = old && old->name == stage.name && old->inputs == stage.inputs;
      reason = same || !old || old->name != stage.name ? "follows" : changes(*old, stage);
    }
    result.push_back({stage.name, fresh, reason});
  }
  return result;
}

}  // namespace pelage
