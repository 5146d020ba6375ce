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

/// Tables of the distribution of light that the medulla of a fibre scatters, by inclination and h of the
/// incoming light. They have the azimuthal and longitudinal profiles of [Yan15, section 4.3], with separate
/// longitudinal profiles for light that leaves at the front and light that leaves at the back. They are
/// computed by tracing paths through the whole fibre, so light that total reflection keeps inside is included
/// correctly. The tables are a function of the optics and the number of paths only. Thread safety: immutable.
class MedullaTables {
 public:
  static constexpr int kInclinations = 12, kOffsets = 12;  ///< numbers of nodes of |theta_o| and |h|
  static constexpr int kAzimuths = 72, kSines = 40;        ///< numbers of cells of phi and sin(theta_i)
  static constexpr int kPaths = 40000;                     ///< number of paths traced for each node

  /// Raised whenever the same optics give different tables.
  /// tests/render/frame/stored_versions_test.cpp fails when tables change and the version does not.
  static constexpr uint32_t kVersion = 1;

  /// Computes the tables, which takes seconds. Throws Error (kStopped) when the job is stopped.
  static std::shared_ptr<const MedullaTables> make(const YanOptics& optics, const Job& job,
                                                   int paths = kPaths);
  /// Computes the tables without progress reports. The computation cannot be stopped.
  static std::shared_ptr<const MedullaTables> make(const YanOptics& optics, const Workers& workers,
                                                   int paths = kPaths);
  /// Loads the tables from `store`, or computes them and stores them there. If the file is damaged, warns the
  /// user and computes the tables again.
  static std::shared_ptr<const MedullaTables> find_or_make(const YanOptics& optics, const ContentStore& store,
                                                           const Job& job, int paths = kPaths);

  /// A node of the tables: cumulative distributions of the scattered light, and its path lengths. The light
  /// comes from theta_o >= 0 and h >= 0; the other signs follow by symmetry.
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

/// The lobe of scattered light for one inclination and one h. It is a mixture of the four table nodes around
/// this inclination and h. Keeps a reference to the tables.
class TabulatedScatter {
 public:
  TabulatedScatter(const MedullaTables& tables, float sin_theta_o, float h);

  float density(const FibreAngles& a) const;
  SampledAngles sample(const V3f& u) const;
  PathLengths lengths() const;

 private:
  std::array<const MedullaTables::Node*, 4> nodes_;
  std::array<float, 4> weights_;
  float inclination_sign_, offset_sign_;
};

}  // namespace pelage
