// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/vector.h"
#include "geom/interchange/read_warnings.h"
#include "geom/usd/usd_layer.h"
#include "geom/usd/usd_prim_index.h"
#include "geom/usd/usd_source.h"

namespace pelage {

/// An attribute with a value.
struct UsdValue {
  const UsdLayer* layer = nullptr;
  const UsdAttribute* attribute = nullptr;
  UsdText text;  ///< the earliest time sample, or else the default value
};

/// A prim with everything that its layers, references, payloads and selected variants state about it.
class UsdPrim {
 public:
  std::string path;                  ///< such as /scene/rat
  std::string type;                  ///< such as Mesh; may be empty
  std::vector<UsdOpinion> opinions;  ///< strongest first, not empty
  M44f to_world;                     ///< from the space of the prim, for row vectors

  std::optional<UsdValue> find(std::string_view attribute) const;
  /// Returns the token of an attribute, or `other` if it has none.
  std::string token(std::string_view attribute, const std::string& other) const;
  /// Returns the interpolation that is stated for an attribute; empty if none is.
  std::string interpolation(std::string_view attribute) const;
  /// Returns the names of all attributes, without repetitions, in order.
  std::vector<std::string> attribute_names() const;
  SourcePosition position() const { return opinions.front().layer->position(opinions.front().spec->place); }
  [[noreturn]] void fail(const std::string& message) const;
};

/// A scene of USD, composed from a layer and the layers that it names: sublayers, references, payloads,
/// inherited prims, and variants that are selected. Layers are opened when they are needed, and closed soon
/// afterwards. For use by one thread.
class UsdStage {
 public:
  /// Called before a file is read, with the bytes of text of all open layers, this file included. May throw.
  using Reserve = std::function<void(int64_t text_bytes)>;

  /// Adds a warning to `warnings` for everything that is skipped. Throws Error (kInput) as UsdLayer does.
  UsdStage(const UsdSource& source, ReadWarnings& warnings, Reserve reserve = {});

  UsdStage(const UsdStage&) = delete;
  UsdStage& operator=(const UsdStage&) = delete;

  const UsdLayer& root_layer() const { return *root_->layers.front(); }
  /// Visits the defined prims in the order of the file, without those that are inactive, invisible, or for
  /// purposes other than rendering. Their positions are turned so that y is up. Throws Error (kInput) when a
  /// file that is needed cannot be read, or when prims refer to themselves, become more than a million, or
  /// are nested deeper than 512 levels.
  void visit(const std::function<void(const UsdPrim&)>& use);

 private:
  using Stack = std::shared_ptr<const UsdLayerStack>;

  Stack open(const std::filesystem::path& path);
  std::shared_ptr<const UsdLayer> open_layer(const std::filesystem::path& path, const std::string& key);
  Stack with_sublayers(std::shared_ptr<const UsdLayer> layer, const std::string& key);
  void add_sublayers(const UsdLayer& layer, UsdLayerStack& stack, std::vector<std::string>& ancestors);
  void visit_children(const UsdPrim& parent, const UsdPrimNode& node, int depth,
                      const std::function<void(const UsdPrim&)>& use);
  bool is_shown(const UsdPrim& prim);

  ReadWarnings& warnings_;
  const Reserve reserve_;
  Stack root_;
  std::map<std::string, std::weak_ptr<const UsdLayerStack>> open_;
  std::map<std::string, std::weak_ptr<const UsdLayer>> layers_;
  std::deque<Stack> recent_;
  UsdPrimComposer composer_;
  size_t prims_ = 0;
  M44f up_;  // turns the up axis of the file to y
};

/// Returns the matrix of a prim's xformOps, for row vectors. Sets `resets` if the prim ignores the transform
/// of its parent. Throws Error (kInput) for malformed values.
M44f usd_local_transform(const UsdPrim& prim, bool& resets, ReadWarnings& warnings);

}  // namespace pelage
