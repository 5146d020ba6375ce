// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "groom/sim/rod.h"

namespace pelage {

/// A plane that a node must not pass, in the space of the root: axes of its frame, from its position on.
struct CarriedPlane {
  V3d point{0};
  V3d normal{0};  ///< unit; 0 if the node touches nothing
  /// Returns the plane during a step in which the root moves from `from` to `to`.
  RodContact contact(const RodRoot& from, const RodRoot& to) const;
};

/// Up to kLanes clamped rods with equal numbers of segments, which are stepped side by side, one per lane of
/// vector instructions. Each gives the result of Rod::step() up to rounding; which rods lie in the other
/// lanes, and how many instructions take at once, changes no bit (law 1). Thread safety: none; use one
/// object per thread.
class RodPack {
 public:
  static constexpr size_t kLanes = 8;
  /// A node may touch so many planes at once.
  static constexpr size_t kMaxPlanes = 3;
  /// One number of each rod.
  struct alignas(64) Lanes {
    double lane[kLanes];
  };

  /// What acts on all rods of a pack alike.
  struct Step {
    V3d gravity{0};  ///< m / s^2
    double seconds = 0;
    int iterations = 2;    ///< of Newton's method, at most
    bool has_air = false;  ///< whether set_air() was called for all nodes
    /// Number of planes per node that set_plane() was called for.
    size_t planes = 0;
    /// Of each plane: RodContact::softness.
    std::array<double, kMaxPlanes> softness{};
  };

  /// Starts a pack of rods of `segments` segments.
  void reset(size_t segments);
  /// Puts a rod and its state into a lane. Lanes without a rod must get a copy of another lane's rod.
  void set_rod(size_t lane, const Rod& rod, const RodState& state);
  void set_air(size_t lane, size_t node, const V3d& velocity) { put(air_, 3 * node, lane, velocity); }
  void set_plane(size_t lane, size_t node, size_t which, const CarriedPlane& plane);
  /// Sets where the root is at the end of the next step.
  void set_root(size_t lane, const RodRoot& root);

  /// Advances all rods, as Rod::step() does.
  void step(const Step& step);
  /// Returns whether all steps of a lane had finite results.
  bool is_finite(size_t lane) const { return failed_.lane[lane] == 0; }
  void get_state(size_t lane, RodState& state) const;

 private:
  friend struct RodPackView;
  using Numbers = std::vector<Lanes>;
  static void put(Numbers& numbers, size_t first, size_t lane, const V3d& v) {
    numbers[first].lane[lane] = v.x;
    numbers[first + 1].lane[lane] = v.y;
    numbers[first + 2].lane[lane] = v.z;
  }
  static V3d get(const Numbers& numbers, size_t first, size_t lane) {
    return {numbers[first].lane[lane], numbers[first + 1].lane[lane], numbers[first + 2].lane[lane]};
  }

  size_t segments_ = 0;
  RodMaterial material_;
  Numbers masses_, weights_, lengths_, joint_lengths_, rest_darboux_;
  Numbers positions_, velocities_, frames_, air_, planes_;
  Numbers scratch_;
  std::array<Lanes, 7> root_{}, target_{};  // position and frame
  Lanes bend_{}, twist_{}, stretch_{}, length_{}, radius_{}, failed_{};
};

/// The numbers of some lanes of a pack, for its kernel.
struct RodPackView {
  RodPackView(RodPack& pack, size_t first_lane);
  size_t segments;
  double damping, drag, friction;
  const double *masses, *weights, *lengths, *joint_lengths, *rest_darboux, *air, *planes, *target;
  const double *bend, *twist, *stretch, *length, *radius;
  double *positions, *velocities, *frames, *root, *failed;
  double* scratch;  ///< scratch_size() numbers per lane, aligned
  static size_t scratch_size(size_t segments) { return 52 * segments + 48; }
};

}  // namespace pelage
