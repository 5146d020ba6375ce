// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "groom/sim/dynamics_params.h"
#include "groom/sim/rod_pack.h"
#include "groom/sim/skin_moment.h"
#include "groom/strands/guide_turns.h"

namespace pelage {

struct Job;

/// A guide as it was groomed.
struct GuideShape {
  std::vector<V3d> points;  ///< from the root on, in metres, along the axes of the root's frame
  double radius = 0;        ///< in metres

  /// Whether every segment has a direction. A strand of no length, or with coinciding points, has none.
  bool has_directions() const;
};

/// Simulates the guides of a coat. Each guide is a rod of its own, clamped to the skin, so the result does
/// not depend on threads or on the guides that are stepped side by side with it. A guide without a finite
/// motion follows the skin rigidly.
class GuideSimulation {
 public:
  /// The guides start as groomed. All have the same number of points. `start` is needed only for the call.
  GuideSimulation(const DynamicsParams& params, std::vector<GuideShape> shapes, const SkinMoment& start);

  size_t guide_count() const { return shapes_.size(); }
  size_t segment_count() const { return segments_; }

  /// Moves the skin to `to` within `seconds`, in `steps` equal steps. Contacts with the skin are looked for
  /// where each guide would be if it followed rigidly, which is on the right side of a thin skin.
  void advance(const SkinMoment& to, const Wind& wind, double seconds, int steps, const Job& job);
  /// How far the guides are turned away from their groomed shape.
  GuideTurns turns() const;
  /// Number of guides that followed rigidly in the last call of advance().
  size_t rigid_count() const;

  /// The state in single precision: state_size() numbers.
  std::vector<float> state() const;
  size_t state_size() const { return guide_count() * (segments_ * 10 + 6); }
  /// Continues from a state, on the skin at its time. A run that does this with state() after each frame
  /// gives the same result as one that was interrupted.
  void set_state(std::span<const float> state, const SkinMoment& at);

 private:
  /// Where the skin is below a node.
  struct Below {
    SkinPlace place;      // no direction: the skin is too far away to be met
    V3d from{0};          // where the skin was looked for
    double distance = 0;  // of this place from the skin, at least; exact if there is a direction
    bool is_near() const { return place.outward != V3d(0); }
    bool is_inside() const { return place.height < 0; }
  };
  struct Scratch;
  void follow_rigidly(size_t guide, const RodRoot& root, double seconds);
  void find_skin(size_t guide, const SkinMoment& to, double seconds, std::span<Below> below) const;
  void set_planes(size_t guide, const SkinMoment& to, double seconds, std::span<const Below> below,
                  size_t lane, Scratch& scratch) const;
  /// Moves up to RodPack::kLanes guides that are not always rigid. `retries`: how often those that fail are
  /// moved again in more steps.
  void move(std::span<const size_t> guides, const SkinMoment& to, const Wind& wind, double seconds, int steps,
            Scratch& scratch, int retries);
  void push_outside(size_t guide, const SkinMoment& at, std::span<const Below> below,
                    std::span<const CarriedPlane> others);

  const DynamicsParams params_;
  size_t segments_ = 0;
  std::vector<GuideShape> shapes_;
  std::vector<Rod> rods_;                          // empty rods are not made: `always_rigid_`
  std::vector<std::vector<Imath::Quatd>> frames_;  // of the segments as groomed, in the space of the root
  std::vector<std::vector<double>> heights_;       // of each node above the skin as groomed, in metres
  std::vector<std::vector<double>> clearance_;     // min height of each node, in metres
  std::vector<RodState> states_;
  std::vector<uint8_t> always_rigid_, rigid_;
};

}  // namespace pelage
