// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "geom/interchange/read_warnings.h"
#include "geom/usd/usd_layer.h"

namespace pelage {

/// A layer with its sublayers, strongest first.
struct UsdLayerStack {
  std::vector<std::shared_ptr<const UsdLayer>> layers;
};

/// What one layer states about a composed prim.
struct UsdOpinion {
  std::shared_ptr<const UsdLayerStack> stack;
  const UsdLayer* layer = nullptr;
  const UsdPrimSpec* spec = nullptr;
};

/// How the opinions of a node reach its prim, strongest first.
enum class UsdArcKind { kRoot, kInherit, kVariant, kReference, kPayload, kSpecialize };

/// Where opinions were found: the path that an arc leads to, and the way there. The children of a prim
/// descend from the same site.
struct UsdSite {
  std::shared_ptr<const UsdLayerStack> stack;
  std::string path;
  size_t length = 0;  ///< of the path of the composed prim that has the arc
  int hops = 0;
  std::shared_ptr<const UsdSite> from;  ///< null: the root layers
};

/// The opinions of one site about a prim, and the arcs that they state.
struct UsdPrimNode {
  UsdArcKind arc = UsdArcKind::kRoot;
  int depth = 0;  ///< of the prim that states the arc
  std::shared_ptr<const UsdSite> site;
  std::vector<UsdOpinion> specs;
  std::vector<UsdPrimNode> children;        ///< strongest first
  std::set<std::string, std::less<>> sets;  ///< variant sets that were looked at
};

/// Returns the opinions of a tree in the order of their strength: of each node its own, then those of its
/// inherited prims, variants, references and payloads, each completely before the next. Specialised prims are
/// weaker than everything else.
std::vector<UsdOpinion> usd_opinions(const UsdPrimNode& root);

/// Builds the trees of opinions of prims.
class UsdPrimComposer {
 public:
  using Stack = std::shared_ptr<const UsdLayerStack>;
  using Open = std::function<Stack(const std::filesystem::path& path)>;

  /// `open`: opens a file that exists.
  UsdPrimComposer(Open open, ReadWarnings& warnings) : open_(std::move(open)), warnings_(warnings) {}

  /// Returns the node of a child: what the sites of its parent state about it, and the arcs of these
  /// statements. `path`, `depth`: of the composed child. Throws Error (kInput) when prims refer to themselves
  /// or to prims that do not exist.
  UsdPrimNode child(const UsdPrimNode& parent, std::string_view name, const std::string& path, int depth);

 private:
  void add_arcs(UsdPrimNode& node);
  bool add_variant(UsdPrimNode& node, const UsdPrimNode& root);
  void add_asset(UsdPrimNode& node, UsdArcKind kind, const UsdOpinion& from, const UsdArc& arc);
  void add_target(UsdPrimNode& node, UsdArcKind kind, const Stack& stack, const std::string& path,
                  const UsdOpinion& from, size_t place);
  void add_node(UsdPrimNode& node, UsdPrimNode added);

  const Open open_;
  ReadWarnings& warnings_;
  std::string path_;  // of the prim at work
  int depth_ = 0;
  size_t nodes_ = 0, all_nodes_ = 0;
  bool has_variants_ = false;
};

}  // namespace pelage
