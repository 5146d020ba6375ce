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

/// What is known of every strand before or after an operator, for bounds. Scene units, before the scale of a
/// character. All of it is about control points: curves stay within their hull.
struct StrandReach {
  float length = 1;                        ///< longest arc (of the control polygon)
  float distance = 1;                      ///< no point lies further than this from its root
  float radius = 0;                        ///< widest
  float lean = std::numbers::pi_v<float>;  ///< largest angle of any segment to the normal of its root
  int segments = 7;                        ///< most segments of a control polygon

  /// After points moved by up to `displacement`, each on its own, while roots stayed: neighbours may move
  /// apart, and segments may turn any way.
  StrandReach displaced(float displacement) const {
    StrandReach after = *this;
    after.distance += displacement;
    after.length += 2.0f * displacement * static_cast<float>(segments);
    if (displacement > 0) after.lean = std::numbers::pi_v<float>;
    return after;
  }
};

/// How much of where strands stand on the rest skin something reads.
enum class RestUse { kNone, kPositions, kFrames };

/// What an operator may learn from before strands are grown. Rest state only.
struct PrepareContext {
  const LimitSurface* rest = nullptr;  ///< null for imported strands that grow on no skin
  TextureLibrary& textures;
  const Job& job;
  std::span<const std::unique_ptr<Operator>> preceding;  ///< prepared already
  uint64_t seed = 0;  ///< of this operator: changes when the groom's does, differs between equal operators
  int points = 8;     ///< of a grown strand
  SourcePosition position = {};  ///< of the operator in the scene file, for errors
  std::string owner = {};        ///< for messages: "groom 'coat'"
};

/// One step of a groom: moves the points of strands, or sets their attributes.
///
/// Contract: pure and deterministic by strand id: what happens to a strand depends on its own points, id and
/// root, the operator's parameters and what prepare() learned from rest state, never on which other strands
/// are in the batch. Roots never move. Thread safety: apply() may run on many batches at once.
class Operator {
 public:
  virtual ~Operator() = default;
  /// As in the scene file: "clump".
  virtual std::string_view name() const = 0;
  /// Every parameter that prepare() and apply() depend on.
  virtual std::vector<ParameterText> parameters() const = 0;
  /// Rest state only: the offsets serve every pose and may be frozen. Otherwise the operator sees posed
  /// strands.
  virtual bool reads_rest_only() const { return true; }
  /// Whether apply() asks for the posed skin (StrandBatch::skin).
  virtual bool needs_closest_point() const { return false; }
  /// How often the colours that apply() writes change; nothing when it writes none.
  virtual std::optional<AttributeClass> colors() const { return {}; }
  /// What apply() multiplies the colour of a strand by at random, given the seed that prepare() was or would
  /// be given, and the mean of that over all strands.
  struct Brightness {
    float value = 1, mean = 1;
  };
  virtual Brightness brightness(uint64_t /*seed*/, uint64_t /*strand_id*/) const { return {}; }
  /// Whether colours that strands had before do not matter any more.
  virtual bool replaces_colors() const { return false; }
  /// Whether the widths that apply() gives are one profile along the strands, times a number of each strand.
  virtual bool has_one_width_profile() const { return true; }
  /// Whether apply() reads and writes nothing of a batch but ids, texture coordinates, rest positions, clump
  /// numbers, radii and colours: then it can run on strands whose shape is not known yet.
  virtual bool attributes_only() const { return false; }
  /// What apply() reads of StrandBatch::rest.
  virtual RestUse rest_use() const { return RestUse::kFrames; }
  /// Whether prepare() runs the operators before this one.
  virtual bool runs_preceding() const { return false; }
  /// Reads maps and files, gathers what it needs of the whole coat (clump centres, guides). Called once.
  /// Charges what it keeps to the ledger. Throws Error (kInput), Error (kMemory) before it makes what there
  /// is no room for, Error (kStopped).
  virtual void prepare(const PrepareContext&) {}
  /// How many strands shall grow at a point of the rest skin, relative to the density that the groom asks
  /// for.
  virtual float coverage(const V3f& /*rest_position*/, const V3f& /*normal*/) const { return 1; }
  /// Whether coverage() differs from 1 anywhere.
  virtual bool restricts_coverage() const { return false; }
  virtual void apply(StrandBatch& batch) const = 0;
  /// Bound on how far apply() moves any point of a strand that `before` bounds: at most 1.5 times what it
  /// really does to the worst strand.
  virtual float displacement_bound(const StrandReach& before) const = 0;
  /// What holds after apply().
  virtual StrandReach reach_after(const StrandReach& before) const = 0;
};

}  // namespace pelage
