// SPDX-License-Identifier: Apache-2.0
// Tested in tests/groom/groom_test.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/schema.h"
#include "base/vector.h"
#include "geom/strands.h"

namespace pelage {

class LimitSurface;
class Operator;
class TextureLibrary;
struct Job;
struct StrandBatch;

/// Properties of all strands before or after an operator, for bounds. Scene units, before the scale of a
/// character. They apply to control points: curves stay within their hull.
struct StrandReach {
  float length = 1;                        ///< max arc length (of the control polygon)
  float distance = 1;                      ///< max distance of a point from its root
  float radius = 0;                        ///< max radius
  float lean = std::numbers::pi_v<float>;  ///< max angle of a segment to the normal of its root
  int segments = 7;                        ///< max number of segments of a control polygon

  /// Properties after points were moved independently by up to `displacement` with fixed roots: neighbours
  /// may move apart, and segments may point anywhere.
  StrandReach displaced(float displacement) const {
    StrandReach after = *this;
    after.distance += displacement;
    after.length += 2.0f * displacement * static_cast<float>(segments);
    if (displacement > 0) after.lean = std::numbers::pi_v<float>;
    return after;
  }
};

/// Which data of the roots on the rest skin an operator reads.
enum class RestUse { kNone, kPositions, kFrames };

/// Inputs of prepare(), before strands are grown. Rest state only.
struct PrepareContext {
  const LimitSurface* rest = nullptr;  ///< null for imported strands without a skin
  TextureLibrary& textures;
  const Job& job;
  std::span<const std::unique_ptr<Operator>> preceding;  ///< the operators before this one, already prepared
  uint64_t seed = 0;  ///< seed of this operator: depends on the groom's seed, differs between equal operators
  int points = 8;     ///< number of points of a grown strand
  SourcePosition position = {};  ///< position of the operator in the scene file, for errors
  std::string owner = {};        ///< name for messages: "groom 'coat'"
};

/// One step of a groom: moves the points of strands, or sets their attributes.
///
/// Contract: pure and deterministic per strand. The result for a strand depends on the points, the id and the
/// root of this strand, on the operator's parameters, and on the data that prepare() computed from rest
/// state. It never depends on the other strands of the batch. Roots never move. Thread safety: apply() may
/// run on many batches at once.
class Operator {
 public:
  virtual ~Operator() = default;
  /// Name in the scene file: "clump".
  virtual std::string_view name() const = 0;
  /// Every parameter that prepare() and apply() depend on.
  virtual std::vector<ParameterText> parameters() const = 0;
  /// Whether the operator uses rest state only. Its result is then valid in every pose and may be frozen.
  /// Otherwise the operator receives posed strands.
  virtual bool reads_rest_only() const { return true; }
  /// Whether apply() uses the posed skin (StrandBatch::skin).
  virtual bool needs_closest_point() const { return false; }
  /// Frequency of the colours that apply() writes; empty if apply() writes no colours.
  virtual std::optional<AttributeClass> colors() const { return {}; }
  /// Random factor that apply() applies to the colour of a strand, for the seed passed to prepare(), and its
  /// mean over all strands.
  struct Brightness {
    float value = 1, mean = 1;
  };
  virtual Brightness brightness(uint64_t /*seed*/, uint64_t /*strand_id*/) const { return {}; }
  /// Whether apply() ignores the colours that strands had before.
  virtual bool replaces_colors() const { return false; }
  /// Whether the widths written by apply() are one profile along the strands, times a number per strand.
  virtual bool has_one_width_profile() const { return true; }
  /// Whether apply() accesses only ids, texture coordinates, rest positions, clump numbers, radii and colours
  /// of a batch: then it can run on strands whose shape is not known yet.
  virtual bool attributes_only() const { return false; }
  /// Members of StrandBatch::rest that apply() reads.
  virtual RestUse rest_use() const { return RestUse::kFrames; }
  /// Whether prepare() runs the operators before this one.
  virtual bool runs_preceding() const { return false; }
  /// Reads maps and files, and gathers data about the whole coat (clump centres, guides). Called once.
  /// Charges retained memory to the ledger. Throws Error: kInput, kMemory before allocating memory that does
  /// not fit, kStopped when the job is stopped.
  virtual void prepare(const PrepareContext&) {}
  /// Number of strands to grow at a point of the rest skin, relative to the density of the groom.
  virtual float coverage(const V3f& /*rest_position*/, const V3f& /*normal*/) const { return 1; }
  /// Whether coverage() differs from 1 anywhere.
  virtual bool restricts_coverage() const { return false; }
  virtual void apply(StrandBatch& batch) const = 0;
  /// Upper bound of the distance by which apply() moves any point of a strand with the properties `before`.
  /// The bound is at most 1.5 times the actual displacement of the worst strand.
  virtual float displacement_bound(const StrandReach& before) const = 0;
  /// Properties after apply().
  virtual StrandReach reach_after(const StrandReach& before) const = 0;
};

}  // namespace pelage
