// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "base/content_store.h"
#include "base/job.h"
#include "base/parallel.h"
#include "render/fibre/medulla_bsdf.h"
#include "render/fibre/path_lengths.h"
#include "render/material/yan_params.h"

namespace pelage {

/// How light that the medulla of a fibre scatters leaves the fibre, by inclination and h of the incoming
/// light: the azimuthal and longitudinal profiles of [Yan15, section 4.3], the latter apart for light that
/// leaves in front and behind. Found by tracing the whole fibre, so that light which total reflection keeps
/// inside for a while is where it belongs. A function of the optics and the number of paths alone.
/// Thread safety: immutable.
class MedullaTables {
 public:
  static constexpr int kInclinations = 12, kOffsets = 12;  ///< nodes of |theta_o| and |h|
  static constexpr int kAzimuths = 72, kSines = 40;        ///< cells of phi and of sin(theta_i)
  static constexpr int kPaths = 40000;                     ///< from each node

  /// Takes seconds; throws Error (kStopped) as Job does.
  static std::shared_ptr<const MedullaTables> make(const YanOptics& optics, const Job& job,
                                                   int paths = kPaths);
  /// The same to its end, unseen.
  static std::shared_ptr<const MedullaTables> make(const YanOptics& optics, const Workers& workers,
                                                   int paths = kPaths);
  /// From `store`, or made and stored there; the user is warned of a damaged file, and it is made again.
  static std::shared_ptr<const MedullaTables> find_or_make(const YanOptics& optics, const ContentStore& store,
                                                           const Job& job, int paths = kPaths);

  /// Cumulative distributions of one node, and the lengths that its light has travelled. Light comes from
  /// above the normal plane (theta_o >= 0) at h >= 0.
  struct Node {
    std::array<float, kAzimuths + 1> azimuth;           ///< over phi from -pi to pi
    std::array<std::array<float, kSines + 1>, 2> sine;  ///< over sin(theta_i) from -1 to 1: front, behind
    PathLengths lengths;
  };
  const Node& node(int inclination, int offset) const { return nodes_[inclination * kOffsets + offset]; }
  std::span<const Node> nodes() const { return nodes_; }

 private:
  std::vector<Node> nodes_;
};

/// The lobe of scattered light at one point: the mixture of four nodes about it. Refers to the tables.
class TabulatedScatter {
 public:
  TabulatedScatter(const MedullaTables& tables, float sin_theta_o, float h);

  float density(const FibreAngles& a) const;
  DrawnAngles draw(const V3f& u) const;
  PathLengths lengths() const;

 private:
  std::array<const MedullaTables::Node*, 4> nodes_;
  std::array<float, 4> weights_;
  float inclination_sign_, offset_sign_;
};

}  // namespace pelage
