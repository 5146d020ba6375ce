// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "base/ledger.h"
#include "base/value_readers.h"
#include "geom/closest_point.h"
#include "geom/limit_surface.h"
#include "geom/strands.h"
#include "geom/tessellation.h"
#include "groom/follicles.h"
#include "groom/operator_list.h"

namespace pelage {

class TextureLibrary;
class Workers;

/// `cache:` of a groom.
struct GroomCacheParams {
  std::string directory = "cache";
  std::string freeze;  ///< name of the last frozen operator
  static const Schema<GroomCacheParams>& schema();
};

/// One entry of `grooms:`.
struct GroomParams {
  NameReference skin;      ///< name of a skin; empty for an imported groom
  AssetPath strands_file;  ///< curves made elsewhere, instead of everything but `role` and `operators`
  std::optional<CurveBasis> basis;     ///< of strands_file
  std::optional<float> default_width;  ///< of strands_file
  StrandRole role = StrandRole::kUnder;
  std::optional<int64_t> strands;
  std::optional<Field> density;  ///< with strands: relative; without: strands per square unit
  int points = 8;
  int64_t seed = 0;
  OperatorList operators;
  int leaf_strands = 8000;
  std::optional<GroomCacheParams> cache;
  static const Schema<GroomParams>& schema();
};
template <>
struct EnumNames<CurveBasis> {
  static constexpr const char* names[] = {"linear", "pinned-b-spline", "b-spline", "catmull-rom"};
};

/// A skin in the pose of a frame: one limit surface, and one tree over the frame's tessellation, per motion
/// key.
struct PosedSkin {
  std::span<const LimitSurface> keys;
  std::span<const ClosestPointTree> trees;  ///< empty when no operator needs the skin's inside
  float scale = 1;  ///< uniform scale of the character, applied to strands about their roots
};

/// A coat on a skin: follicles and the operators that shape their strands.
///
/// Operators that read rest state only run on the rest surface; the result is carried to each pose by the
/// follicle frames (root + frame * offset * scale). From the first operator that reads live state on,
/// operators run on the posed strands of every motion key. Every strand is a pure function of the groom, its
/// id and the pose (law 1). Immutable. Thread safety: const members may be called from any thread.
class Groom {
 public:
  /// Places follicles and prepares the operators (clump centres, guides). `name` is for messages.
  /// Throws Error (kInput) for missing maps, guide files and combinations that make no sense.
  static std::shared_ptr<const Groom> create(const std::string& name, const GroomParams& params,
                                             std::shared_ptr<const LimitSurface> rest,
                                             TextureLibrary& textures, const Workers& workers,
                                             MemoryLedger& ledger);
  ~Groom();

  const FollicleTree& follicles() const;
  StrandRole role() const;
  bool needs_closest_point() const;

  /// All strands of a leaf in a pose, ids ascending, with the per-point attribute "color" (3 components) when
  /// an operator colours them. Only the first `count` of them when `count` is given (an LOD prefix).
  Strands grow(size_t leaf, const PosedSkin& pose, std::optional<size_t> count = {}) const;

  /// A box that holds every point +- radius that grow() can give: roots in the pose, longest strand, each
  /// operator's reach. No strand is grown.
  Box3f conservative_bound(size_t leaf, const PosedSkin& pose) const;

 private:
  struct Impl;
  explicit Groom(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace pelage
