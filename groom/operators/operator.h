// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/schema.h"
#include "base/vector.h"
#include "geom/strands.h"
#include "image/field.h"
#include "image/field_skin.h"

namespace pelage {

class LimitSurface;
class Operator;
class OperatorScripts;
class PartLines;
struct Job;
struct StrandBatch;

/// Bounds that hold for all strands before or after an operator. In scene units, before the scale of a
/// character. They hold for control points, and therefore also for curves, which stay within the convex hull
/// of their control points.
struct StrandReach {
  float length = 1;    ///< max arc length of a strand's control polygon
  float distance = 1;  ///< max distance of a point from its root
  float radius = 0;    ///< max radius
  /// Max angle between a segment and the normal at its strand's root, radians.
  float lean = std::numbers::pi_v<float>;
  int segments = 7;  ///< max number of segments of a control polygon

  /// Returns bounds after every point except the root has moved by up to `displacement`, each in its own
  /// direction. Two neighbouring points may move apart, and segments may get any direction.
  StrandReach displaced(float displacement) const {
    StrandReach after = *this;
    after.distance += displacement;
    after.length += 2.0f * displacement * static_cast<float>(segments);
    if (displacement > 0) after.lean = std::numbers::pi_v<float>;
    return after;
  }
};

/// Data of the roots on the rest skin that an operator reads.
enum class RestUse { kNone, kPositions, kFrames };

/// Returns what a field with this dependence reads.
inline RestUse rest_use(const FieldDependence& needs) {
  return needs.normal ? RestUse::kFrames : needs.rest ? RestUse::kPositions : RestUse::kNone;
}

/// What an operator is and what it needs, as the growth of a coat sees it. Depends on its parameters only.
struct OperatorTraits {
  std::string_view name = {};  ///< in the scene file: "clump"
  /// Raised whenever apply(), prepare() or coverage() gives other results than before (see groom_identity.h).
  int version = 1;
  /// Whether the operator uses rest state only. If so, its result is valid in every pose and may be frozen.
  /// If not, the operator receives posed strands.
  bool reads_rest_only = true;
  /// Whether apply() uses the posed skin (StrandBatch::skin).
  bool needs_closest_point = false;
  /// Frequency of the colours that apply() writes. Empty if apply() writes no colours.
  std::optional<AttributeClass> colors = {};
  /// Whether apply() ignores the colours that strands had before.
  bool replaces_colors = false;
  /// Whether apply() colours only a part of the strands or of their points.
  bool colors_partly = false;
  /// Whether apply() gives all strands the same width profile, times one factor per strand.
  bool has_one_width_profile = true;
  /// Whether apply() reads and writes no other data of a batch than ids, texture coordinates, rest positions,
  /// clump numbers, radii and colours. If so, it can run on strands whose shape is not known yet.
  bool attributes_only = false;
  /// The members of StrandBatch::rest that apply() reads.
  RestUse rest_use = RestUse::kFrames;
  /// Whether prepare() runs the operators before this one. These must then be prepared first.
  bool runs_preceding = false;
  /// Whether coverage() differs from 1 anywhere.
  bool restricts_coverage = false;
  /// Whether part() returns a line after prepare().
  bool parts_hair = false;
  /// Whether misses() may be true.
  bool may_miss = false;
  /// Whether prepare() needs PrepareContext::scripts.
  bool runs_script = false;
};

/// Inputs of prepare(), which runs before strands are grown. Rest state only.
struct PrepareContext {
  const LimitSurface* rest = nullptr;  ///< null for imported strands without a skin
  FieldSources textures;               ///< what fields are loaded from
  const Job& job;
  std::span<const std::unique_ptr<Operator>> preceding;  ///< the operators before this one, already prepared
  /// Seed of this operator; depends on the groom's seed and differs between operators of the same name.
  uint64_t seed = 0;
  int points = 8;                ///< number of points of a strand that is not imported
  SourcePosition position = {};  ///< position of the operator in the scene file, for error messages
  std::string owner = {};        ///< owner of the operator, for messages: "groom 'coat'"
  /// The lines of all operators of the groom that part hair, before and after this one.
  std::vector<std::shared_ptr<const PartLines>> parts = {};
  const OperatorScripts* scripts = nullptr;  ///< null: the user has not allowed scripts
};

/// One step of a groom: moves the points of strands, or sets their attributes.
///
/// Contract: pure and deterministic per strand. The result for a strand depends only on the points, the id
/// and the root of this strand, on the operator's parameters, and on data that prepare() computed from rest
/// state. It never depends on other strands of the batch. Roots never move. Thread safety: apply() may run on
/// several batches at once.
class Operator {
 public:
  virtual ~Operator() = default;
  virtual OperatorTraits traits() const = 0;
  /// Name and value of every parameter that influences prepare() or apply().
  virtual std::vector<ParameterText> parameters() const = 0;
  /// A random factor on the colour of a strand: its value for this strand, and its mean over all strands.
  struct Brightness {
    float value = 1, mean = 1;
  };
  /// Returns the factor by which apply() multiplies the colour of a strand. `seed`: the seed that prepare()
  /// received.
  virtual Brightness brightness(uint64_t /*seed*/, uint64_t /*strand_id*/) const { return {}; }
  /// Reads maps and files, and gathers data about the whole coat, such as clump centres and guides. Called
  /// once. Charges memory that it keeps to the ledger. Throws Error: kInput for unusable files, kMemory
  /// before allocating memory that does not fit, kStopped when the job is stopped.
  virtual void prepare(const PrepareContext&) {}
  /// Returns the factor on the density of the groom at a point of the rest skin. `root` has no attributes.
  virtual float coverage(const FieldPoint& /*root*/) const { return 1; }
  /// Returns lines across which no operator of the groom mixes strands; null if there are none.
  virtual std::shared_ptr<const PartLines> part() const { return nullptr; }
  /// Returns whether the operator finds nothing that could shape a strand at this root of the rest skin.
  virtual bool misses(const FieldPoint& /*root*/) const { return false; }
  virtual void apply(StrandBatch& batch) const = 0;
  /// Returns the bounds of strands after apply(). `before`: their bounds before it. The max distance is at
  /// most 1.5 times the distance of the point that is actually the farthest.
  virtual StrandReach reach_after(const StrandReach& before) const = 0;
};

/// An operator whose keys in the scene file are described by `P`, a struct with a Schema.
template <class P>
class OperatorOf : public Operator {
 public:
  using Params = P;
  explicit OperatorOf(P params) : params_(std::move(params)) {}
  std::vector<ParameterText> parameters() const override { return P::schema().describe(params_); }

 protected:
  P params_;
};

}  // namespace pelage
