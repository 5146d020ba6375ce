// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Imath/ImathQuat.h>

#include "base/vector.h"
#include "groom/sim/band_matrix.h"

namespace pelage {

/// Physical properties of a rod of circular cross-section. SI units.
struct RodMaterial {
  double density = 1300;        ///< kg / m^3, > 0
  double youngs_modulus = 4e9;  ///< Pa, >= 0
  double poisson_ratio = 0.37;
  double radius = 35e-6;  ///< m, > 0
  double damping = 0;     ///< s: bending resists its rate of change by this many times its stiffness
  double drag = 0;        ///< Pa s: force per length and velocity relative to the air
  double friction = 0;    ///< Coulomb's coefficient at contacts
};

/// Place and orientation of the clamped end of a rod.
struct RodRoot {
  V3d position{0};
  Imath::Quatd frame;
};

/// State of a rod at one time. Positions in metres, velocities in metres per second.
struct RodState {
  std::vector<V3d> positions;        ///< of the nodes, root first
  std::vector<V3d> velocities;       ///< of the nodes
  std::vector<Imath::Quatd> frames;  ///< material frames of the segments; the z axis lies along the segment
  RodRoot root;                      ///< of a clamped rod
};

/// A plane that a node must not pass.
struct RodContact {
  V3d normal{0};      ///< unit; 0 if the node touches nothing
  double offset = 0;  ///< min of dot(normal, position)
  V3d motion{0};      ///< movement of the surface during the step
  /// Squared angular frequency (1 / s^2) of a plane that is a spring without friction; 0: a hard plane.
  double softness = 0;
};

/// What acts on a rod during one step.
struct RodForces {
  V3d gravity{0};                        ///< m / s^2
  std::span<const V3d> air;              ///< velocity of the air at each node; empty: still air
  std::span<const RodContact> contacts;  ///< as many for each node, node by node; or empty
};

/// A discrete elastic rod: a chain of segments with a material frame each, whose third axis is always the
/// direction of the segment, as in [Bergou08]. Bending and twist are measured by the discrete Darboux vector
/// of [Kugelstadt16], 2 Im(conj(q0) q1), at each joint between two segments. Segments resist stretch. Each
/// joint resists deviation from its rest Darboux vector.
///
/// A step is implicit Euler, solved by a few Newton iterations on all nodes and twist angles together. The
/// matrix is the Gauss-Newton approximation of the Hessian, so it is positive definite, and its band is
/// narrow, so a solution takes time linear in the number of nodes. Forces are gradients of an energy that
/// does not change when the whole rod moves: momentum is kept. Deviations from the papers: no position based
/// iteration, because it converges slowly for stiff rods of many segments; the joint at the clamp is half as
/// long as the others; stiffness is multiplied by 1 + 1 / n^2 for n segments, which makes the small
/// deflection of a cantilever under its weight exact for every n.
///
/// Immutable. Thread safety: const members may be called from any thread.
class Rod {
 public:
  /// Memory for step(), to be reused.
  struct Workspace {
    BandMatrix matrix;
    std::vector<V3d> expected, start;  // of the nodes: where inertia takes them; positions before the step
    std::vector<V3d> start_darboux;
  };

  /// Makes a rod that is at rest where its nodes are `points` (at least 2, in metres, no two neighbours
  /// equal). `clamp`: frame of the root; empty for a rod that floats freely.
  Rod(std::span<const V3d> points, const RodMaterial& material, const std::optional<RodRoot>& clamp);

  size_t segment_count() const { return lengths_.size(); }
  double length() const { return length_; }
  bool is_clamped() const { return is_clamped_; }
  /// Returns the state at rest, without velocity.
  const RodState& rest() const { return rest_; }
  /// Sets the same Darboux vector at every joint but the one at the clamp: curvatures about the first two
  /// material axes and twist, in radians per metre.
  void set_curvature(const V3d& darboux);
  /// Changes the rest shape so that the rod hangs in equilibrium under gravity as it was made: tension and
  /// moments are summed from the tip to the root ([Hsu22] solves this for general meshes; a chain that is
  /// clamped at one end needs one sweep). Only for clamped rods.
  void balance(const V3d& gravity);

  /// Advances a state by `seconds`. The clamped end moves to `root` and is there at the end of the step.
  /// Makes at most `iterations` Newton iterations, fewer if the first ones hardly turn a segment.
  /// Returns false, and leaves the state undefined, if the step has no finite result.
  bool step(const RodRoot& root, const RodForces& forces, double seconds, int iterations, RodState& state,
            Workspace& workspace) const;

  /// Kinetic, elastic and potential energy in joules.
  double energy(const RodState& state, const V3d& gravity) const;
  V3d momentum(const RodState& state) const;
  V3d angular_momentum(const RodState& state) const;
  /// Returns the largest relative deviation of a segment from its rest length.
  double stretch(const RodState& state) const;

 private:
  friend class RodPack;
  struct Assembly;
  size_t first_joint() const { return is_clamped_ ? 0 : 1; }
  /// Frames before and behind joint `i`: segment i - 1, or the clamp, and segment i.
  const Imath::Quatd& before(const RodState& state, size_t i) const {
    return i > 0 ? state.frames[i - 1] : state.root.frame;
  }
  V3d darboux(const RodState& state, size_t i) const;
  void start_step(const RodRoot& root, const RodForces& forces, double seconds, RodState& state,
                  Workspace& workspace) const;
  void add_nodes(Assembly& a) const;
  void add_stretch(Assembly& a) const;
  void add_joint(size_t i, Assembly& a) const;
  /// Adds the solution. Returns the squared largest angle by which it turns a segment; nothing if not finite.
  std::optional<double> apply(RodState& state, Workspace& workspace) const;

  bool is_clamped_;
  double length_ = 0;
  RodMaterial material_;
  std::vector<double> masses_;                 // of nodes
  std::vector<double> weights_;                // length that belongs to each node
  std::vector<double> lengths_;                // of segments at rest
  std::vector<V3d> rest_darboux_;              // one per segment: of the joint before it
  std::vector<double> joint_lengths_;          // one per segment
  double bend_ = 0, twist_ = 0, stretch_ = 0;  // stiffness of a joint and of a segment of length 1
  RodState rest_;
};

/// Rotates a vector by a unit quaternion.
inline V3d turned(const Imath::Quatd& q, const V3d& v) {
  const V3d t = 2.0 * q.v.cross(v);
  return v + q.r * t + q.v.cross(t);
}
/// Returns the smallest rotation between two unit vectors; half a turn about any perpendicular if they are
/// opposite.
Imath::Quatd smallest_turn(const V3d& from, const V3d& to);

}  // namespace pelage
