// SPDX-License-Identifier: Apache-2.0
#include "geom/usd/usd_prim_index.h"

#include <algorithm>
#include <utility>

#include "base/file.h"
#include "base/visible_text.h"

namespace pelage {
namespace {

constexpr int kMaxHops = 256;
constexpr size_t kMaxNodes = 4096, kMaxAllNodes = 16'000'000;

/// What the layers of a stack state about the prim with a path.
std::vector<UsdOpinion> opinions_at(const std::shared_ptr<const UsdLayerStack>& stack,
                                    const std::string& path) {
  std::vector<UsdOpinion> found;
  for (const auto& layer : stack->layers) {
    const UsdPrimSpec* spec = &layer->root();
    for (size_t begin = 1; spec && begin < path.size();) {
      const size_t end = std::min(path.find('/', begin), path.size());
      spec = spec->child(path.substr(begin, end - begin));
      begin = end + 1;
    }
    if (spec) found.push_back({stack, layer.get(), spec});
  }
  return found;
}

/// What the sites of a tree state about a child. Leaves out sites without a statement.
UsdPrimNode descended(const UsdPrimNode& parent, std::string_view name) {
  UsdPrimNode node{parent.arc, parent.depth, parent.site, {}, {}, {}};
  for (const UsdOpinion& opinion : parent.specs) {
    if (const UsdPrimSpec* spec = opinion.spec->child(name))
      node.specs.push_back({opinion.stack, opinion.layer, spec});
  }
  for (const UsdPrimNode& child : parent.children) {
    UsdPrimNode below = descended(child, name);
    if (!below.specs.empty() || !below.children.empty()) node.children.push_back(std::move(below));
  }
  return node;
}

void collect_opinions(const UsdPrimNode& node, std::vector<UsdOpinion>& opinions,
                      std::vector<const UsdPrimNode*>& specialised) {
  opinions.insert(opinions.end(), node.specs.begin(), node.specs.end());
  for (const UsdPrimNode& child : node.children) {
    if (child.arc == UsdArcKind::kSpecialize) {
      specialised.push_back(&child);
    } else {
      collect_opinions(child, opinions, specialised);
    }
  }
}

/// Whether a path is that of a prim or of one of its ancestors.
bool contains(std::string_view ancestor, std::string_view path) {
  return path.starts_with(ancestor) && (path.size() == ancestor.size() || path[ancestor.size()] == '/');
}

}  // namespace

std::vector<UsdOpinion> usd_opinions(const UsdPrimNode& root) {
  std::vector<UsdOpinion> opinions;
  std::vector<const UsdPrimNode*> specialised;
  collect_opinions(root, opinions, specialised);
  for (size_t i = 0; i < specialised.size(); ++i) {
    const UsdPrimNode& node = *specialised[i];
    collect_opinions(node, opinions, specialised);
  }
  return opinions;
}

UsdPrimNode UsdPrimComposer::child(const UsdPrimNode& parent, std::string_view name, const std::string& path,
                                   int depth) {
  path_ = path;
  depth_ = depth;
  nodes_ = 0;
  has_variants_ = false;
  UsdPrimNode node = descended(parent, name);
  add_arcs(node);
  // Selections may come from everywhere, so variants follow when the other arcs are known.
  while (has_variants_ && add_variant(node, node)) {
  }
  return node;
}

/// Adds what the statements of a node and those below it refer to, but variants.
void UsdPrimComposer::add_arcs(UsdPrimNode& node) {
  for (UsdPrimNode& child : node.children) add_arcs(child);
  for (const UsdOpinion& from : node.specs) has_variants_ |= !from.spec->variant_sets.empty();
  const std::vector<UsdOpinion> specs = node.specs;
  for (const UsdOpinion& from : specs) {
    for (const std::string& path : from.spec->inherits)
      add_target(node, UsdArcKind::kInherit, from.stack, path, from, from.spec->place);
    for (const UsdArc& arc : from.spec->references) add_asset(node, UsdArcKind::kReference, from, arc);
    for (const UsdArc& arc : from.spec->payloads) add_asset(node, UsdArcKind::kPayload, from, arc);
    for (const std::string& path : from.spec->specializes)
      add_target(node, UsdArcKind::kSpecialize, from.stack, path, from, from.spec->place);
  }
}

/// Adds the strongest variant that is missing. Returns false if none is.
bool UsdPrimComposer::add_variant(UsdPrimNode& node, const UsdPrimNode& root) {
  for (const UsdOpinion& from : node.specs) {
    for (const auto& [set, unused] : from.spec->variant_sets) {
      if (!node.sets.insert(set).second) continue;
      const std::string* selected = nullptr;
      for (const UsdOpinion& other : usd_opinions(root)) {
        const auto found = other.spec->selections.find(set);
        if (!selected && found != other.spec->selections.end()) selected = &found->second;
      }
      if (!selected) {
        warnings_.add("variant sets without a selection are skipped", from.layer->position(from.spec->place));
        continue;
      }
      UsdPrimNode added{UsdArcKind::kVariant, depth_, node.site, {}, {}, {}};
      for (const UsdOpinion& one : node.specs) {
        const auto variants = one.spec->variant_sets.find(set);
        if (variants == one.spec->variant_sets.end()) continue;
        for (const UsdPrimSpec& variant : variants->second) {
          if (variant.name == *selected) added.specs.push_back({one.stack, one.layer, &variant});
        }
      }
      if (added.specs.empty()) continue;
      add_node(node, std::move(added));
      return true;
    }
  }
  return std::any_of(node.children.begin(), node.children.end(),
                     [&](UsdPrimNode& child) { return add_variant(child, root); });
}

void UsdPrimComposer::add_asset(UsdPrimNode& node, UsdArcKind kind, const UsdOpinion& from,
                                const UsdArc& arc) {
  Stack stack = from.stack;
  if (!arc.asset.empty()) {
    const std::filesystem::path path = from.layer->path().parent_path() / arc.asset;
    if (const std::string problem = file_problem(path); !problem.empty())
      from.layer->fail(arc.place, "'" + visible(path.string()) + "': " + problem);
    stack = open_(path);
  }
  std::string target = arc.path;
  if (target.empty()) target = "/" + stack->layers.front()->default_prim();
  if (target == "/") from.layer->fail(arc.place, "the file has no default prim; name one: @file@</prim>");
  add_target(node, kind, stack, target, from, arc.place);
}

void UsdPrimComposer::add_target(UsdPrimNode& node, UsdArcKind kind, const Stack& stack,
                                 const std::string& path, const UsdOpinion& from, size_t place) {
  if (!path.starts_with('/')) {
    warnings_.add("relative paths of prims are skipped", from.layer->position(place));
    return;
  }
  // Only a prim on the way here makes a cycle: other arcs may lead to the same prim.
  for (const UsdSite* site = node.site.get(); site; site = site->from.get()) {
    if (site->stack == stack && contains(path, site->path + path_.substr(site->length)))
      from.layer->fail(place, "<" + visible(path) + "> refers to itself");
  }
  if (node.site->hops == kMaxHops)
    from.layer->fail(place, "<" + visible(path) + "> is the end of more than 256 arcs");
  UsdPrimNode added{kind, depth_, nullptr, opinions_at(stack, path), {}, {}};
  if (added.specs.empty()) from.layer->fail(place, "there is no prim <" + visible(path) + ">");
  added.site =
      std::make_shared<const UsdSite>(UsdSite{stack, path, path_.size(), node.site->hops + 1, node.site});
  if (++nodes_ > kMaxNodes || ++all_nodes_ > kMaxAllNodes)
    from.layer->fail(place, "<" + visible(path_) + "> refers to too many prims");
  add_node(node, std::move(added));
}

/// Adds a node with all its arcs behind the stronger ones: by their kind; those of a prim itself before those
/// of its ancestors; in the order of the file.
void UsdPrimComposer::add_node(UsdPrimNode& node, UsdPrimNode added) {
  add_arcs(added);
  const auto weaker = std::find_if(node.children.begin(), node.children.end(), [&](const UsdPrimNode& other) {
    return other.arc != added.arc ? other.arc > added.arc : other.depth < added.depth;
  });
  node.children.insert(weaker, std::move(added));
}

}  // namespace pelage
