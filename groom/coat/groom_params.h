// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "base/value_readers.h"
#include "geom/io/file_transform.h"
#include "geom/strands.h"
#include "groom/coat/attachment.h"
#include "groom/follicles/follicles.h"
#include "groom/operators/operator_list.h"
#include "groom/sim/dynamics_params.h"
#include "groom/strands/curve_basis_names.h"
#include "image/field.h"

namespace pelage {

/// `cache:` of a groom.
struct GroomCacheParams {
  AssetPath directory{"cache", {}};
  /// Name of the last frozen operator; if several operators have this name, the last of them counts.
  NameReference freeze;
  static const Schema<GroomCacheParams>& schema();
};

/// One entry of `grooms:`.
struct GroomParams {
  /// Only for the schema: expand_presets() replaces the name by keys before grooms are read
  /// (world/presets.h).
  NameReference preset;
  float preset_density = 1;
  NameReference skin;                  ///< name of a skin; empty for strands of a file without a skin
  AssetPath strands_file;              ///< file with the strands; empty: strands grow from follicles
  std::optional<CurveBasis> basis;     ///< for strands_file: curve basis, if the file does not state it
  std::optional<float> default_width;  ///< for strands_file: width, if the file has no widths
  std::optional<FileTransformParams> transform;  ///< for strands_file: from its space to the rest space
  Attachment attach = Attachment::kAuto;         ///< for strands_file: whether its strands follow the skin
  StrandRole role = StrandRole::kUnder;
  std::optional<int64_t> strands;
  /// Relative if `strands` is given; otherwise, number of strands per square scene unit.
  std::optional<Field> density;
  int points = 8;
  int64_t seed = 0;
  OperatorList operators;
  std::optional<int> leaf_strands;
  std::optional<GroomCacheParams> cache;
  std::optional<DynamicsParams> dynamics;

  static constexpr int kMaxLeafStrands = 8000;  ///< default of leaf_strands
  /// From the space of strands_file to the rest space of the skin.
  M44f to_rest() const { return transform ? transform->matrix() : M44f(); }
  int leaf_size() const { return leaf_strands.value_or(kMaxLeafStrands); }
  static const Schema<GroomParams>& schema();
};

/// Checks `cache.freeze`. Returns the problem if it names no operator of the groom, or if this operator or
/// one before it reads more than rest state. Otherwise returns nothing.
std::optional<Problem> check_freeze(const GroomParams& params);
/// Checks whether a groom can have its `dynamics`. Returns the problem, or nothing.
std::optional<Problem> check_dynamics(const GroomParams& params);

}  // namespace pelage
