// SPDX-License-Identifier: Apache-2.0
// One step of a rod: implicit Euler by Newton's method (groom/sim/rod.h).
#include <array>

#include "groom/sim/rod.h"
#include "groom/sim/rod_numbers.h"

namespace pelage {

using Imath::Quatd;
using namespace rod_numbers;

namespace {

// Unknowns: x, y, z of node i are 4 i .. 4 i + 2; the twist of segment i is 4 i + 3.
size_t unknowns_of_node(size_t i) { return 4 * i; }
size_t unknown_of_twist(size_t segment) { return 4 * segment + 3; }

V3d third_axis(const Quatd& frame) {
  const double x = frame.v.x, y = frame.v.y, z = frame.v.z, w = frame.r;
  return {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)};
}

}  // namespace

/// The linear system of one Newton iteration, and what its terms share.
struct Rod::Assembly {
  const RodState& state;
  const RodForces& forces;
  double seconds;
  Workspace& work;

  double inertia(double mass) const { return mass / (seconds * seconds); }
  /// Adds s * I + t * u u^T to the block of two nodes.
  void add_block(size_t row, size_t column, double s, double t, const V3d& u) {
    for (unsigned i = 0; i < 3; ++i) {
      for (unsigned j = 0; j < (row == column ? i + 1 : 3); ++j)
        work.matrix.at(row + i, column + j) += t * u[i] * u[j] + (i == j ? s : 0.0);
    }
  }
  void add_force(size_t row, const V3d& force) {
    for (unsigned i = 0; i < 3; ++i) work.matrix.right(row + i) += force[i];
  }
};

void Rod::start_step(const RodRoot& root, const RodForces& forces, double seconds, RodState& state,
                     Workspace& work) const {
  const size_t nodes = state.positions.size();
  work.start = state.positions;
  work.expected.resize(nodes);
  work.start_darboux.resize(segment_count());
  for (size_t i = first_joint(); i < segment_count(); ++i) work.start_darboux[i] = darboux(state, i);
  for (size_t i = 0; i < nodes; ++i)
    work.expected[i] =
        state.positions[i] + state.velocities[i] * seconds + forces.gravity * (seconds * seconds);
  if (!is_clamped_) return;
  // Newton starts where the root would take a rigid rod: its inner forces are then the forces of the last
  // step.
  const Quatd turn = root.frame * ~state.root.frame;
  for (V3d& position : state.positions)
    position = root.position + turned(turn, position - state.root.position);
  for (Quatd& frame : state.frames) frame = (turn * frame).normalize();
  state.root = root;
  // A root that jumps leaves a rod behind by no more than its length has a meaning for.
  const double farthest = 2 * length_;
  for (size_t i = 0; i < nodes; ++i) {
    V3d lag = work.expected[i] - state.positions[i];
    const double distance = lag.length();
    if (distance > farthest) work.expected[i] = state.positions[i] + lag * (farthest / distance);
  }
}

void Rod::add_nodes(Assembly& a) const {
  const double h = a.seconds;
  for (size_t i = is_clamped_ ? 1 : 0; i < masses_.size(); ++i) {
    const V3d& x = a.state.positions[i];
    const double inertia = a.inertia(masses_[i]), drag = material_.drag * weights_[i] / h;
    const V3d air = a.forces.air.empty() ? V3d(0) : a.forces.air[i];
    V3d force = inertia * (a.work.expected[i] - x) - drag * (x - a.work.start[i] - h * air);
    a.add_block(unknowns_of_node(i), unknowns_of_node(i), inertia + drag, 0, V3d(0));
    const size_t planes = a.forces.contacts.size() / masses_.size();
    for (const RodContact& contact : a.forces.contacts.subspan(i * planes, planes)) {
      const double gap = contact.normal.dot(x) - contact.offset;
      if (!(gap < 0) || !(contact.normal.length2() > 0)) continue;
      double stiffness = masses_[i] * contact.softness, rub = 0;
      V3d slip(0);
      if (!(contact.softness > 0)) {
        stiffness = kContactStiffness * inertia;
        slip = x - a.work.start[i] - contact.motion;
        slip -= contact.normal * contact.normal.dot(slip);
        const double most = material_.friction * stiffness * -gap;
        if (most > 0) rub = std::min(stiffness, most / std::max(slip.length(), 1e-12 * length_));
      }
      force -= contact.normal * (stiffness * gap) + slip * rub;
      a.add_block(unknowns_of_node(i), unknowns_of_node(i), rub, stiffness - rub, contact.normal);
    }
    a.add_force(unknowns_of_node(i), force);
  }
  // Twist has no inertia of its own; this little keeps the matrix regular.
  for (size_t i = 0; i < segment_count(); ++i) {
    const double arm = std::max(material_.radius, 0.01 * lengths_[i]);
    a.work.matrix.at(unknown_of_twist(i), unknown_of_twist(i)) += a.inertia(masses_[i + 1]) * arm * arm / 2;
  }
}

void Rod::add_stretch(Assembly& a) const {
  for (size_t i = 0; i < segment_count(); ++i) {
    const V3d edge = a.state.positions[i + 1] - a.state.positions[i];
    const double now = edge.length();
    const V3d along = edge / now;
    const double stiffness = std::min(stretch_ / lengths_[i], kStiffestRod * a.inertia(masses_[i + 1]));
    const double across = std::max(0.0, stiffness * (1 - lengths_[i] / now));
    const V3d force = along * (stiffness * (now - lengths_[i]));
    const bool root_moves = i > 0 || !is_clamped_;
    a.add_block(unknowns_of_node(i + 1), unknowns_of_node(i + 1), across, stiffness - across, along);
    a.add_force(unknowns_of_node(i + 1), -force);
    if (!root_moves) continue;
    a.add_block(unknowns_of_node(i), unknowns_of_node(i), across, stiffness - across, along);
    a.add_block(unknowns_of_node(i + 1), unknowns_of_node(i), -across, across - stiffness, along);
    a.add_force(unknowns_of_node(i), force);
  }
}

void Rod::add_joint(size_t i, Assembly& a) const {
  const RodState& state = a.state;
  const Quatd& q0 = before(state, i);
  const V3d now = darboux(state, i), half = now / 2;
  const double s = std::sqrt(std::max(0.0, 1 - half.dot(half)));
  // Change of the Darboux vector: W (w1 - w0), where w0 and w1 are small rotations of the two frames and
  // W = (s I - [half]x) R0^T.
  const V3d axes[3] = {turned(q0, V3d(1, 0, 0)), turned(q0, V3d(0, 1, 0)), turned(q0, V3d(0, 0, 1))};
  const V3d w[3] = {axes[0] * s + axes[1] * half.z - axes[2] * half.y,
                    axes[1] * s - axes[0] * half.z + axes[2] * half.x,
                    axes[2] * s + axes[0] * half.y - axes[1] * half.x};
  const double length = joint_lengths_[i];
  const double limit = kStiffestRod * a.inertia(masses_[i + 1]) * lengths_[i] * lengths_[i];
  const double rate = material_.damping / a.seconds;
  const V3d behind = state.positions[i + 1] - state.positions[i];
  const V3d lever1 = behind / behind.length2(), d1 = third_axis(state.frames[i]);
  V3d lever0(0), d0(0);
  if (i > 0) {
    const V3d edge = state.positions[i] - state.positions[i - 1];
    lever0 = edge / edge.length2();
    d0 = third_axis(q0);
  }
  const size_t base = i > 0 ? unknowns_of_node(i - 1) : 0;
  // Without a segment before the joint, its four columns are missing.
  const size_t skip = i > 0 ? 0 : 4;
  std::array<std::array<double, 11>, 3> rows;
  V3d matrix;
  for (unsigned r = 0; r < 3; ++r) {
    const double stiffness = std::min((r < 2 ? bend_ : twist_) / length, limit);
    const V3d at1 = w[r].cross(lever1), at0 = i > 0 ? w[r].cross(lever0) : V3d(0), middle = -at1 - at0;
    rows[r] = {at0.x, at0.y, at0.z, i > 0 ? -w[r].dot(d0) : 0.0, middle.x, middle.y, middle.z, w[r].dot(d1),
               at1.x, at1.y, at1.z};
    // The clamped node does not move.
    if (is_clamped_ && i < 2) std::fill_n(rows[r].begin() + (i == 0 ? 4 : 0), 3, 0.0);
    const double bent = now[r] - rest_darboux_[i][r] + rate * (now[r] - a.work.start_darboux[i][r]);
    matrix[r] = stiffness * (1 + rate);
    for (size_t c = skip; c < 11; ++c) a.work.matrix.right(base + c - skip) -= stiffness * bent * rows[r][c];
  }
  for (size_t c = skip; c < 11; ++c) {
    BandMatrix::Column& column = a.work.matrix.column(base + c - skip);
    const double u0 = matrix[0] * rows[0][c], u1 = matrix[1] * rows[1][c], u2 = matrix[2] * rows[2][c];
    for (size_t k = c; k < 11; ++k) column[k - c] += u0 * rows[0][k] + u1 * rows[1][k] + u2 * rows[2][k];
  }
}

std::optional<double> Rod::apply(RodState& state, Workspace& work) const {
  const auto moved = [&](size_t i) {
    return V3d(work.matrix.right(unknowns_of_node(i)), work.matrix.right(unknowns_of_node(i) + 1),
               work.matrix.right(unknowns_of_node(i) + 2));
  };
  // Newton's direction is right for rotations of less than a radian.
  double most = 0;
  for (size_t i = 0; i < segment_count(); ++i) {
    const V3d edge = state.positions[i + 1] - state.positions[i];
    const V3d change = (i == 0 && is_clamped_ ? V3d(0) : -moved(i)) + moved(i + 1);
    most = std::max(most, change.length2() / edge.length2());
  }
  if (!std::isfinite(most)) return {};
  const double part = most > 1 ? 1 / std::sqrt(most) : 1;
  for (size_t i = is_clamped_ ? 1 : 0; i < state.positions.size(); ++i) state.positions[i] += moved(i) * part;
  for (size_t i = 0; i < segment_count(); ++i) {
    const V3d edge = state.positions[i + 1] - state.positions[i];
    const double length = edge.length();
    if (!(length > 0)) return {};
    const V3d along = edge / length;
    const double half =
        std::clamp(work.matrix.right(unknown_of_twist(i)) * part / 2, -kMaxHalfTwist, kMaxHalfTwist);
    const Quatd turn(1, along * half);  // by twice the arc tangent of `half`: Newton's method allows it
    state.frames[i] =
        (turn * smallest_turn(third_axis(state.frames[i]), along) * state.frames[i]).normalize();
  }
  return most;
}

bool Rod::step(const RodRoot& root, const RodForces& forces, double seconds, int iterations, RodState& state,
               Workspace& work) const {
  start_step(root, forces, seconds, state, work);
  Assembly a{state, forces, seconds, work};
  for (int k = 0; k < iterations; ++k) {
    work.matrix.reset(4 * segment_count() + 3);
    if (is_clamped_) {
      for (size_t i = 0; i < 3; ++i) work.matrix.at(i, i) = 1;
    }
    add_nodes(a);
    add_stretch(a);
    for (size_t i = first_joint(); i < segment_count(); ++i) add_joint(i, a);
    if (!work.matrix.solve()) return false;
    const std::optional<double> turned2 = apply(state, work);
    if (!turned2) return false;
    if (*turned2 < kConverged * kConverged) break;
  }
  for (size_t i = 0; i < state.positions.size(); ++i)
    state.velocities[i] = (state.positions[i] - work.start[i]) / seconds;
  return true;
}

}  // namespace pelage
